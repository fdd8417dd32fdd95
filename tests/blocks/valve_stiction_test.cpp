// The sticking valve: a play with a jump, after Choudhury's flow chart.
#include "blocks/valve_stiction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "blocks/backlash.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

std::vector<double> stems(double stick, double jump, const std::vector<double>& commands, double start = 0.0) {
  Stepper<ValveStiction> valve(1.0, {.STICK = stick, .JUMP = jump, .START = start});
  std::vector<double> result;
  for (const double command : commands) {
    result.push_back(valve({.XIN = command}).XOUT);
  }
  return result;
}

/// Up and down by steps of 1/64, with rests of some samples on the way.
std::vector<double> ramps() {
  std::vector<double> commands{0.0};
  for (int k = 1; k < 3000; ++k) {
    const bool rests = k % 97 > 90;
    commands.push_back(commands.back() + (rests ? 0.0 : (k / 400) % 2 == 0 ? 0.015625 : -0.015625));
  }
  return commands;
}

/// Choudhury, Thornhill and Shah 2005, figure 8: the stem is stuck from where the command turned or stopped (xss), and
/// slips once the command is S away from there after a turn, J after a stop.
class FlowChart {
 public:
  FlowChart(double stick, double jump, double command, double stem)
      : stick_(stick), jump_(jump), command_(command), stem_(stem) {}

  double operator()(double command) {
    const int way = command > command_ ? 1 : command < command_ ? -1 : 0;
    if (!stuck_ && way != way_) {
      stuck_ = true;
      stuck_at_ = command_;
      stopped_way_ = way_;
    }
    if (stuck_ && way != 0) {
      const double needed = way == stopped_way_ ? jump_ : stick_;
      if (std::abs(command - stuck_at_) >= needed && (command > stuck_at_) == (way > 0)) {
        stuck_ = false;
      }
    }
    if (!stuck_) {
      stem_ = command - way * (stick_ - jump_) / 2.0;
      way_ = way;
    }
    command_ = command;
    return stem_;
  }

  void moves(int way) { way_ = way, stuck_ = false; }

 private:
  double stick_;
  double jump_;
  double command_;
  double stem_;
  double stuck_at_ = 0.0;
  int way_ = 0;
  int stopped_way_ = 0;
  bool stuck_ = false;
};

TEST(ValveStiction, IsChoudhurysFlowChart) {
  const std::vector<double> commands = ramps();
  for (const auto& [stick, jump] : {std::pair{1.0, 0.25}, {1.0, 1.0}, {0.5, 1.0}, {2.0, 0.125}}) {
    const std::vector<double> found = stems(stick, jump, commands);
    std::size_t k = 1;
    while (found[k] == found[k - 1]) {
      ++k;
    }
    FlowChart chart(stick, jump, commands[k], found[k]);  // from the first slip, which the start alone decides
    chart.moves(1);
    int held = 0;
    for (++k; k < commands.size(); ++k) {
      ASSERT_NEAR(found[k], chart(commands[k]), 1e-12) << "S " << stick << ", J " << jump << ", step " << k;
      held += found[k] == found[k - 1] ? 1 : 0;
    }
    EXPECT_GT(held, 300);
    EXPECT_LT(held, 2700);
  }
}

TEST(ValveStiction, WithoutAJumpIsAPlay) {
  RandomIo random(5, 1.0);
  Stepper<ValveStiction> valve(1.0, {.STICK = 0.8, .JUMP = 0.0, .START = 0.5});
  Stepper<Backlash> play(1.0, {});
  play.params.WIDTH = 0.8;
  play.params.START = 0.5;
  double command = 0.0;
  for (int k = 0; k < 5000; ++k) {
    command += random.unit() - 0.5;
    // A play begins with its output at the input, a stem where START says.
    EXPECT_NEAR(valve({.XIN = command}).XOUT, play({.XIN = command}).XOUT + 0.2, 1e-10) << k;
  }
}

TEST(ValveStiction, SlipsByItsJump) {
  for (const double jump : {0.25, 1.0, 1.5}) {
    const std::vector<double> found = stems(1.0, jump, ramps());
    double largest = 0.0;
    for (std::size_t k = 1; k < found.size(); ++k) {
      largest = std::max(largest, std::abs(found[k] - found[k - 1]));
    }
    EXPECT_NEAR(largest, jump, 1e-12);
  }
}

TEST(ValveStiction, AtTheEdgeOfItsBandASmallestStepMovesIt) {
  EXPECT_EQ(stems(1.0, 0.5, {4.0, 4.0}, 0.0), (std::vector{4.0, 4.0}));
  EXPECT_EQ(stems(1.0, 0.5, {4.0, 4.01}, -0.5)[1], 4.0 - 0.5 * 0.75);
  EXPECT_EQ(stems(1.0, 0.5, {4.0, 4.01}, -1.0)[1], 4.01 - 0.25) << "it lies 0.75 below, and follows 0.25 below";
  EXPECT_EQ(stems(1.0, 0.5, {4.0, 3.99}, 1.0)[1], 3.99 + 0.25);
}

}  // namespace
}  // namespace hysteron::testing
