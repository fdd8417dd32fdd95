// Which effects are there: sets of laws, held against each other by what they predict of blocks that no fit has seen.
//
// What is compared is ln of the energy that a set leaves on the blocks held out, each block by a fit without it, of the
// energy that the calibrated diagram leaves there. The probability of a set, and of a family of effects, is how often
// it is the best under weights that are drawn for the blocks (Rubin's Bayesian bootstrap) and under an error that all
// blocks have in common, since no formula is quite the machine's. Each time counts as much as siblings of the machine
// say of the set, where there are any.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/evidence/law_findings.hpp"
#include "diagnosis/prior.hpp"
#include "diagnosis/rules.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

struct EvidenceOptions {
  std::vector<std::string> effects{};  ///< identifiers; empty: all
  std::vector<std::string> columns{};  ///< of the records that the diagram does not use
  unsigned threads = 2;
  std::uint64_t seed = 1;
  Prior prior{};
};

/// The sets of laws of a record, to be weighed again where one of them has been refuted.
class Weighing {
 public:
  /// Of a diagram as calibrated, with residuals and sensitivities. The task and the explanation have to outlive it.
  Weighing(const Task& task, const std::string& top, const Explanation& calibrated, const EvidenceOptions& options);
  Weighing(const Weighing&) = delete;
  Weighing& operator=(const Weighing&) = delete;
  ~Weighing();

  /// In how many ways the sets are held against each other: first where what is missing can be seen, last at the
  /// measured outputs. At least one.
  [[nodiscard]] std::size_t views() const;

  /// Of all sets of a view that are not struck out; empty where none is left.
  [[nodiscard]] Evidence told(const Rules& rules = {}, std::size_t view = 0);

  /// The gap by kinds, where what is missing can be seen; else of a measured output, by its name.
  [[nodiscard]] std::optional<GapBudget> budget(std::size_t view, const std::string& output) const;

  /// The most probable set of what was told last of a view is none.
  void strike_out_first(std::size_t view);

 private:
  struct Sets;
  std::uint64_t seed_;
  unsigned threads_;
  Prior prior_;
  std::unique_ptr<Sets> sets_;
};

/// What it closes, by how probable it is: what closes next to nothing is no cause, however surely it is there.
[[nodiscard]] double weight_of_family(const FamilyFinding& one);

/// Whether its first family is to be told.
[[nodiscard]] bool is_worth_telling(const Evidence& evidence, Rules& rules);

}  // namespace hysteron::diagnosis
