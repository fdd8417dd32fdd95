// What each of some effects closes beside the others.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace hysteron::diagnosis {

/// The share of each of `count` players in what they close together, in the mean over all orders in which they may come
/// (L. S. Shapley, A value for n-person games, 1953). `closed` gives what some of them close by the bits of those that
/// are there; it is asked once for each choice but none. Who predicts worse with a player than without leaves him out:
/// so some close what the best of them close, no share is negative, and all together are what the best choice closes.
[[nodiscard]] std::vector<double> shapley_shares(std::size_t count, const std::function<double(std::size_t)>& closed);

}  // namespace hysteron::diagnosis
