// A closed loop over a test signal, and what a small signal leaves in it: both with exact derivatives by the unknowns.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tuning/free_parameters.hpp"
#include "tuning/goal/loop_cut.hpp"
#include "tuning/machine_dual.hpp"
#include "tuning/simulation.hpp"

namespace hysteron {

/// Of the peak of h, below which it has died away.
inline constexpr double died_away = 1e-7;
/// How long h is watched at the most: twenty times the test.
[[nodiscard]] inline std::size_t steps_watched(const Drive& drive) {
  return std::max<std::size_t>(20 * drive.steps, 2000);
}

/// A loop with one plant in it.
struct LoopPlant {
  std::string name{};  ///< of its parameter file
  Program program{};
  Wire output{};                 ///< y
  std::optional<Wire> effort{};  ///< u
  std::optional<LoopCut> cut{};  ///< where margins are wanted
};

struct LoopResponse {
  Signal output{};  ///< y, over all steps
  Signal effort{};  ///< u
  /// h(k), the response behind the cut to 1 put in at k = 0, once the test signal has ended and stands: S(z) = Σ h·z⁻ᵏ.
  /// Empty without a cut.
  Signal impulse{};
  Eigen::MatrixXd output_by{};  ///< ∂y/∂x, by step and unknown; empty where no derivatives were asked for
  Eigen::MatrixXd effort_by{};
  Eigen::MatrixXd impulse_by{};
};

enum class LoopState : std::uint8_t {
  Settles,
  NotFinite,  ///< a value of the test run is no finite number
  Unstable,   ///< what was put in grows, or stands
  TooSlow,    ///< what was put in dies away, but not within twenty times the test's duration
};

/// What the response of a loop without a value is said to do.
[[nodiscard]] constexpr std::string_view what_it_does(LoopState state) {
  switch (state) {
    case LoopState::Settles:
      return "settles";
    case LoopState::NotFinite:
      return "has no finite response";
    case LoopState::Unstable:
      return "does not settle";
    case LoopState::TooSlow:
      return "settles too slowly for the length of the test";
  }
  return {};
}

/// Runs one loop again and again. h is half the difference of two runs with ±ε, ε a millionth of the largest |v|: exact
/// for a linear loop, of second order in ε for a smooth one; its derivatives are those of the two runs, by dual
/// numbers.
class LoopRun {
 public:
  /// `drive` has one input less than the plant's program where that is cut. Both outlive the runs.
  LoopRun(const LoopPlant& plant, const Drive& drive, const std::vector<FreeParameter>& parameters);

  LoopState respond(const Eigen::VectorXd& x, bool with_derivatives, LoopResponse& response);

 private:
  template <class S>
  bool take_test(Machine<S>& machine, const Eigen::VectorXd& x, std::span<const Eigen::Index> columns,
                 LoopResponse& response);
  /// Behind the test: h over `steps`, or, of 0, until it has died away.
  template <class S>
  LoopState take_impulse(Machine<S>& machine, std::span<const Eigen::Index> columns, std::size_t steps,
                         LoopResponse& response);

  const LoopPlant& plant_;
  const Drive& drive_;
  const std::vector<FreeParameter>& parameters_;
  double largest_ = 0.0;  ///< |v| of the last test
  Machines machines_;
};

}  // namespace hysteron
