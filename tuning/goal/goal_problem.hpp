// From a diagram with a closed loop, a parameter file with [goal], and plants, to the problem that goal_search.hpp
// solves.
//
//   minimise over θ   worst or mean over the plants of   J = mean over t of ((y − y_wished)/size)² + (w·du/dt)²
//   subject to        the limits of [goal.limits], in every plant
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "records/record.hpp"
#include "tuning/free_parameters.hpp"
#include "tuning/goal/loop_run.hpp"
#include "tuning/goal/wished_response.hpp"

namespace hysteron {

enum class LimitKind : std::uint8_t { Effort, Rate, Overshoot, Gain, Phase, Sensitivity };

struct LimitText {
  LimitKind kind;
  parameters::GoalLimitKey key;  ///< in [goal.limits]
  std::string_view name;         ///< in reports
  std::string_view unit;         ///< empty: that of the effort
  bool is_least;                 ///< the value may not be below the limit; else not above
};

inline constexpr std::array limit_texts{
    LimitText{LimitKind::Effort, parameters::goal_limit_keys[0], "largest effort", "", false},
    LimitText{LimitKind::Rate, parameters::goal_limit_keys[1], "largest rate of the effort", "", false},
    LimitText{LimitKind::Overshoot, parameters::goal_limit_keys[2], "overshoot", "%", false},
    LimitText{LimitKind::Gain, parameters::goal_limit_keys[3], "gain margin", "dB", true},
    LimitText{LimitKind::Phase, parameters::goal_limit_keys[4], "phase margin", "deg", true},
    LimitText{LimitKind::Sensitivity, parameters::goal_limit_keys[5], "largest sensitivity Ms", "1", false}};

constexpr const LimitText& text_of(LimitKind kind) {
  return limit_texts[static_cast<std::size_t>(kind)];
}

struct GoalLimit {
  LimitKind kind = LimitKind::Effort;
  double limit = 0.0;
  Place place{};
};

struct GoalProblem {
  parameters::GoalSettings settings{};
  std::vector<LoopPlant> plants{};          ///< one at least
  std::vector<FreeParameter> parameters{};  ///< what is tuned
  Drive drive{};                            ///< the test signal, and what the other inputs stand at
  std::size_t input = 0;                    ///< the one that the test signal drives
  std::size_t output = 0;                   ///< the one that has to respond
  std::string effort{};                     ///< its name; empty: none is stated
  std::string effort_unit{};                ///< empty where the wires give none
  std::size_t begin = 0;                    ///< the step from which on the response counts
  std::size_t end = 0;                      ///< the step behind the last whose error counts; limits count to the end
  double size = 1.0;                        ///< of the step, or the range of the wish
  std::optional<WishedResponse> model{};    ///< none: the wish is a column
  Signal wished{};                          ///< over all steps
  std::vector<GoalLimit> limits{};          ///< in the order of limit_texts
  std::vector<std::string> notes{};         ///< what was done to the wished column, without capital and point
  Diagnostics found{};                      ///< warnings about it

  [[nodiscard]] const Graph& graph() const { return plants.front().program.graph; }
  /// " with heavy.toml"; nothing of the only plant.
  [[nodiscard]] std::string with_plant(std::size_t plant) const {
    return plants.size() > 1 ? " with " + plants[plant].name : std::string();
  }
  [[nodiscard]] double weight() const { return settings.effort_weight ? settings.effort_weight->value : 0.0; }
};

/// The parameter file of a plant: beside the file that names it, wherever the command is run.
[[nodiscard]] std::string file_of_plant(const std::string& goal_file, const std::string& plant);

/// The problem of a file that has [goal]. `program` is compiled with keep_names; a record is taken where the signal is
/// one. Throws InputError with everything found: HY530, HY531, HY534, HY603, HY606, HY708, HY716, and what the
/// parameter files of the plants report.
[[nodiscard]] GoalProblem goal_problem(const Program& program, const parameters::ParameterFile& file,
                                       std::span<const records::Record> records);

}  // namespace hysteron
