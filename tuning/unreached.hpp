// The part of a diagram that unknowns do not reach: its signals are kept from one rollout and played into the others.
//
// An effect that is tried behind a plant leaves the plant's signals as they were. Only the nodes behind what has
// changed run again; what they read of the others comes in as further inputs, with the bits that it had.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "codegen/compile.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::detail {

/// The nodes that each unknown of a problem reaches: a parameter, or a state at the starts of records.
class Reach {
 public:
  explicit Reach(const OutputErrorProblem& problem);

  // Columns are those of the unknowns: parameters first, then the initial states, start by start.

  /// Whether an unknown reaches none of these nodes.
  [[nodiscard]] bool leaves(Eigen::Index column, const std::vector<bool>& nodes) const;
  /// The nodes that none of these columns reaches.
  [[nodiscard]] std::vector<bool> unreached(const std::vector<Eigen::Index>& columns) const;
  [[nodiscard]] bool has_fmu() const { return has_fmu_; }

 private:
  [[nodiscard]] const std::vector<bool>& of(Eigen::Index column) const;

  std::size_t parameters_ = 0;
  std::size_t nodes_ = 0;
  bool has_fmu_ = false;
  std::vector<std::vector<bool>> reached_{};  ///< by parameter, then by initial state
};

/// A program in which some nodes do not run.
struct WithoutNodes {
  Program program{};
  std::vector<Wire> given{};    ///< of the whole program: what its further inputs are given
  std::size_t first_input = 0;  ///< of the further inputs
};

/// The program without the nodes that are `still`, which read nothing of the others.
[[nodiscard]] WithoutNodes without_nodes(const Program& program, const std::vector<bool>& still);

}  // namespace hysteron::detail
