// An edge with a sum on it, whose other input is an input of the diagram: the place of a missing signal.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/effects/candidates.hpp"

namespace hysteron::diagnosis {

struct SummedEdge {
  Edge edge{};
  std::string text{};
  std::shared_ptr<const Program> program{};
  std::string input{};     ///< of the diagram: what is added, 0 by default
  std::string instance{};  ///< the sum
  Wire before{};           ///< the signal that it is added to
};

/// Nothing where the diagram refuses it. The edge lies in the top block.
[[nodiscard]] std::optional<SummedEdge> with_sum(const std::string& text, const Edge& edge, const std::string& top,
                                                 const Variant& variant);

/// An edge that all that drives the diagram passes on its way to the measured outputs, which follow it through states,
/// and the edges from which every
/// way leads over it: what is missing on any of these can be seen on that one.
struct Bottleneck {
  SummedEdge edge{};
  std::vector<SummedEdge> behind_it{};  ///< with both sums; that edge itself is not among them
};

/// Of those that all loops lead over, the one where forces are summed: before the first integral, behind all gains.
/// Nothing where the diagram has none.
[[nodiscard]] std::optional<Bottleneck> bottleneck_of(const Task& task, const std::string& top, const Variant& variant,
                                                      const std::vector<std::string>& driven, unsigned threads);

}  // namespace hysteron::diagnosis
