// A goal's problem at a point: cost, limits, figures, with their derivatives. Internal to goal_search.cpp and its test.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "tuning/goal/goal_problem.hpp"
#include "tuning/goal/margins.hpp"

namespace hysteron {

/// What is said of a loop, by the test signal and by its margins.
struct LoopFigures {
  double error = 0.0;          ///< √J, a share of the size of the step
  double overshoot = 0.0;      ///< percent; not a number where the signal is no step, and so are the two times
  double rise_time = 0.0;      ///< s, 10 to 90 % of the step; not a number where the response does not get there
  double settling_time = 0.0;  ///< s, to 2 %; not a number where the response is not settled when the test ends
  double effort = 0.0;         ///< largest |u|; not a number where no effort is stated
  double rate = 0.0;           ///< largest |du/dt|
  std::optional<LoopMargins> margins{};
};

/// A place where a limit counts: a step, a frequency, or the crossing that is worst by now.
struct LimitPlace {
  std::size_t limit = 0;
  std::size_t plant = 0;
  std::size_t step = 0;
  double frequency = 0.0;
  double sign = 1.0;
};

/// How far a value is over its limit, as a share of the limit; below 0 where it is kept. Of Ms, by logarithms.
[[nodiscard]] double excess_over(LimitKind kind, double value, double limit);

class GoalModel {
 public:
  explicit GoalModel(const GoalProblem& problem);

  /// Runs every loop. The state of the first that does not settle, else Settles.
  LoopState evaluate(const Eigen::VectorXd& x, bool with_derivatives);
  /// The loop that the last point ended at, where it is one that does not settle.
  [[nodiscard]] std::size_t failed_plant() const { return failed_plant_; }

  // Of the last point:
  [[nodiscard]] double cost(std::size_t plant) const { return plants_[plant]->cost; }
  [[nodiscard]] const Eigen::VectorXd& cost_by(std::size_t plant) const { return plants_[plant]->cost_by; }
  /// The worst or the mean of the plants.
  [[nodiscard]] double cost() const;
  [[nodiscard]] LoopFigures figures(std::size_t plant);
  [[nodiscard]] const LoopResponse& response(std::size_t plant) const { return plants_[plant]->response; }
  /// Null without a cut. Worked out where it is asked for: a search without limits of margins needs none.
  [[nodiscard]] const Sensitivity* sensitivity(std::size_t plant);
  /// The value that a limit is held against, in a plant.
  [[nodiscard]] double value_of(std::size_t limit, std::size_t plant) const;
  /// The largest excess of all limits in all plants; −1 where there are none.
  [[nodiscard]] double largest_excess() const;
  /// The places of a limit in a plant that are nearest to it or beyond it: local maxima from `least` excess on.
  [[nodiscard]] std::vector<LimitPlace> places(std::size_t limit, std::size_t plant, double least) const;
  /// The excess at a place, with its derivatives.
  [[nodiscard]] Margin excess(const LimitPlace& place) const;

 private:
  struct PlantPoint {
    explicit PlantPoint(LoopRun own) : run(std::move(own)) {}
    LoopRun run;
    LoopResponse response{};
    std::optional<Sensitivity> sensitivity{};  ///< where a limit, or somebody, asks for it
    std::optional<LoopMargins> margins{};      ///< where a limit asks for them
    double cost = 0.0;
    Eigen::VectorXd cost_by{};
  };
  void take_cost(PlantPoint& point, bool with_derivatives) const;
  /// What a limit on the test is held against at a step, with its sign and without.
  [[nodiscard]] double at_step(LimitKind kind, const LoopResponse& response, std::size_t step) const;
  [[nodiscard]] double size_at(LimitKind kind, const LoopResponse& response, std::size_t step) const;
  [[nodiscard]] double largest_in_test(LimitKind kind, const LoopResponse& response) const;

  const GoalProblem& problem_;
  std::vector<std::unique_ptr<PlantPoint>> plants_{};
  std::size_t failed_plant_ = 0;
};

}  // namespace hysteron
