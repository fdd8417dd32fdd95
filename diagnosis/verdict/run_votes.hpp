// Which of several explanations is right: what runs of the whole diagram with each of them leave at the measured
// outputs.
//
// The missing signal, the outputs to first order and the search propose sets of effects each in its own way, and what
// they promise has no common scale: noise has another part in each, and a model to first order is none of the machine.
// What all sets have in common is the diagram with their effects in it, fitted to whole records. There they are held
// against each other as laws are in evidence.hpp: by the ln of the energy that is left by blocks, under weights that
// are drawn for the blocks and an error that a formula has in all blocks alike.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/prior.hpp"
#include "diagnosis/rules.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// A set of effects in the diagram.
struct RunSet {
  VectorXd residuals{};                 ///< of all outputs, over the whole records
  std::vector<std::string> families{};  ///< of the effects, sorted, each once
  std::size_t effects = 0;
  std::size_t displaced = 0;   ///< of these, converters between two parts of the machine
  bool is_own_choice = false;  ///< chosen by its run, among thousands, where another was found without it
};

/// How often each set is the best, and how much that counts: to a sum of 1.
[[nodiscard]] std::vector<double> votes_of_runs(const Task& task, std::span<const RunSet> sets, std::uint64_t seed,
                                                const Prior& prior, const Rules& rules);

}  // namespace hysteron::diagnosis
