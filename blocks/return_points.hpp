// The turning points that a hysteresis with return-point memory remembers, and when a loop closes and wipes them out.
//
// A branch begins at a turning point B. Below it lie the starts of the branches that were interrupted, S_1 … S_n, and
// below these the skeleton curve, if the motion began there. When the branch reaches S_n, the loop between S_n and B is
// closed: both are wiped out and the branch is resumed that began at S_(n−1) (Madelung's rules).
#pragma once

#include "blocks/description.hpp"

namespace hysteron {

inline constexpr std::size_t return_points = 8;

/// The branch that a sample lies on: where it began, how many starts lie below, and on what they lie.
template <class S>
struct ResumedBranch {
  S x;
  S y;
  Bool<S> skeleton;  ///< the skeleton curve itself
  Bool<S> virgin;    ///< the skeleton curve lies below all starts
  Int<S> count;      ///< starts below
  Bool<S> closed;    ///< a loop has closed in this sample
};

template <class S>
using ReturnPoints = Array<S, return_points>;

/// The starts below the present branch, with one that this sample has interrupted and that is not yet on the stack.
template <class S>
struct InterruptedStarts {
  const ReturnPoints<S>& x;
  const ReturnPoints<S>& y;
  Bool<S> pushed;
  Int<S> place;
  S pushed_x;
  S pushed_y;

  [[nodiscard]] S x_at(const Int<S>& index) const { return select(pushed && index == place, pushed_x, at(x, index)); }
  [[nodiscard]] S y_at(const Int<S>& index) const { return select(pushed && index == place, pushed_y, at(y, index)); }
};

/// Closes loops until the branch does not reach the start below it: at most half of them all, and the skeleton.
template <class S>
ResumedBranch<S> close_loops(const InterruptedStarts<S>& starts, ResumedBranch<S> branch, const S& origin_x,
                             const S& origin_y, const S& input, const Bool<S>& downwards) {
  for (std::size_t i = 0; i <= return_points / 2; ++i) {
    const Bool<S> none = branch.count < Int<S>(1);
    const S start = starts.x_at(branch.count - Int<S>(1));
    const S beyond_start = select(downwards, start - input, input - start);
    const S beyond_origin = select(downwards, origin_x - input, input - origin_x) - abs(branch.x - origin_x);
    const Bool<S> closes =
        !branch.skeleton && select(none, branch.virgin && beyond_origin >= S(0.0), beyond_start >= S(0.0));
    const Bool<S> resumes = closes && branch.count > Int<S>(1);
    const Bool<S> to_skeleton = closes && branch.count < Int<S>(2) && branch.virgin;
    const Int<S> resumed = branch.count - Int<S>(2);
    branch.x = select(to_skeleton, origin_x, select(resumes, starts.x_at(resumed), branch.x));
    branch.y = select(to_skeleton, origin_y, select(resumes, starts.y_at(resumed), branch.y));
    branch.skeleton = branch.skeleton || to_skeleton;
    branch.closed = branch.closed || resumes || to_skeleton;
    branch.count = select(closes, max(resumed, Int<S>(0)), branch.count);
  }
  return branch;
}

}  // namespace hysteron
