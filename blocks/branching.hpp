// Branching points: where a signal reverses. The one place that decides it, for HY_BRANCH and for both hysteresis
// blocks.
#pragma once

#include "blocks/description.hpp"

namespace hysteron {

/// What one sample says about the course of a signal.
template <class S>
struct Course {
  Bool<S> turned;    ///< a reversal is declared: the extreme that was held is a branching point
  Bool<S> advanced;  ///< the sample is the new extreme
  Int<S> heading;    ///< −1, 0 (no motion yet) or 1
};

/// Follows a signal by one sample.
///
/// While it heads upwards its largest value is held as the extreme, while downwards its smallest. The signal turns
/// when it has come back from the extreme by more than `dead_band`; so a plateau is no reversal, and jitter within
/// the dead band is none either. Heading 0 leaves for ±1 once the signal is more than the dead band away.
template <class S>
Course<S> follow(const S& signal, const Int<S>& heading, const S& extreme, const S& dead_band) {
  const Bool<S> upwards = heading > Int<S>(0);
  const Bool<S> downwards = heading < Int<S>(0);
  const Bool<S> above = signal - extreme > dead_band;
  const Bool<S> below = extreme - signal > dead_band;
  const Bool<S> turned = (upwards && below) || (downwards && above);
  const Bool<S> departed = !upwards && !downwards && (above || below);
  const Bool<S> extended = (upwards && signal > extreme) || (downwards && signal < extreme);
  return {.turned = turned,
          .advanced = turned || departed || extended,
          .heading = select(turned || departed, select(above, Int<S>(1), Int<S>(-1)), heading)};
}

/// The memory of a hysteresis that remembers its last branching point: where that was, and the extreme reached
/// since, both as (input, output). Before the first branching point it stands at the origin of the skeleton curve.
template <class S>
struct BranchMemory {
  Int<S> HEADING;
  S EXTREME_X;
  S EXTREME_Y;
  S BRANCH_X;
  S BRANCH_Y;
  Bool<S> SKELETON;
  using Self = BranchMemory;
  static constexpr auto fields() {
    return Fields{HY_FIELD(HEADING).otherwise(0.0).means("direction of the input: -1, 0 or 1"),
                  HY_FIELD(EXTREME_X).in("'x").otherwise(0.0).means("extreme of the input on this branch"),
                  HY_FIELD(EXTREME_Y).in("'y").otherwise(0.0).means("output at that extreme"),
                  HY_FIELD(BRANCH_X).in("'x").otherwise(0.0).means("input at the last branching point"),
                  HY_FIELD(BRANCH_Y).in("'y").otherwise(0.0).means("output at the last branching point"),
                  HY_FIELD(SKELETON).otherwise(1.0).means("before the first branching point")};
  }
};

/// The memory at the start: on the skeleton curve through the origin (heading 0), or on a branch that began there.
template <class S>
BranchMemory<S> begin_branch(const Int<S>& heading, const S& origin_x, const S& origin_y) {
  return {.HEADING = heading,
          .EXTREME_X = origin_x,
          .EXTREME_Y = origin_y,
          .BRANCH_X = origin_x,
          .BRANCH_Y = origin_y,
          .SKELETON = heading == Int<S>(0)};
}

template <class S>
BranchMemory<S> select_memory(const Bool<S>& condition, const BranchMemory<S>& a, const BranchMemory<S>& b) {
  return {.HEADING = select(condition, a.HEADING, b.HEADING),
          .EXTREME_X = select(condition, a.EXTREME_X, b.EXTREME_X),
          .EXTREME_Y = select(condition, a.EXTREME_Y, b.EXTREME_Y),
          .BRANCH_X = select(condition, a.BRANCH_X, b.BRANCH_X),
          .BRANCH_Y = select(condition, a.BRANCH_Y, b.BRANCH_Y),
          .SKELETON = select(condition, a.SKELETON, b.SKELETON)};
}

/// The branch on which a sample lies.
template <class S>
struct BranchOfSample {
  Course<S> course;
  S x;  ///< input at its branching point
  S y;  ///< output there
  Bool<S> skeleton;
};

template <class S>
BranchOfSample<S> find_branch(const BranchMemory<S>& memory, const S& input, const S& dead_band) {
  const Course<S> course = follow<S>(input, memory.HEADING, memory.EXTREME_X, dead_band);
  return {.course = course,
          .x = select(course.turned, memory.EXTREME_X, memory.BRANCH_X),
          .y = select(course.turned, memory.EXTREME_Y, memory.BRANCH_Y),
          .skeleton = memory.SKELETON && !course.turned};
}

/// The memory after a sample.
template <class S>
BranchMemory<S> remember(const BranchMemory<S>& memory, const BranchOfSample<S>& branch, const S& input,
                         const S& output) {
  return {.HEADING = branch.course.heading,
          .EXTREME_X = select(branch.course.advanced, input, memory.EXTREME_X),
          .EXTREME_Y = select(branch.course.advanced, output, memory.EXTREME_Y),
          .BRANCH_X = branch.x,
          .BRANCH_Y = branch.y,
          .SKELETON = branch.skeleton};
}

}  // namespace hysteron
