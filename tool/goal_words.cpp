#include "tool/goal_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/numbers.hpp"
#include "support/utf8.hpp"
#include "tool/tune_words.hpp"

namespace hysteron::tool {
namespace {

std::string value_text(double value, const std::string& unit, std::string_view otherwise) {
  return std::isfinite(value) ? fmt::format("{:.4g}{}", value, unit_behind(unit)) : std::string(otherwise);
}

std::string limit_unit(const GoalProblem& problem, LimitKind kind) {
  std::string unit(text_of(kind).unit);
  if (kind == LimitKind::Effort) {
    unit = problem.effort_unit;
  } else if (kind == LimitKind::Rate && !problem.effort_unit.empty()) {
    unit = problem.effort_unit + "/s";
  }
  return unit;
}

/// `without`: what is said of a loop without figures.
std::vector<std::string> figure_row(const GoalProblem& problem, const std::string& name,
                                    const std::optional<LoopFigures>& figures, std::string_view without,
                                    bool has_margins) {
  const bool is_step = problem.settings.signal == parameters::GoalSettings::Signal::Step;
  std::vector<std::string> row{name};
  row.push_back(figures ? fmt::format("{:.3g} %", 100.0 * figures->error) : std::string(without));
  const auto add = [&](double value, const std::string& unit, std::string_view otherwise) {
    row.push_back(figures ? value_text(value, unit, otherwise) : "");
  };
  const LoopFigures known = figures.value_or(LoopFigures{});
  if (is_step) {
    add(known.overshoot, "%", "");
    add(known.rise_time, "s", "beyond the test");
    add(known.settling_time, "s", "beyond the test");
  }
  if (!problem.effort.empty()) {
    add(known.effort, limit_unit(problem, LimitKind::Effort), "");
    add(known.rate, limit_unit(problem, LimitKind::Rate), "");
  }
  if (has_margins) {
    const LoopMargins margins = known.margins.value_or(LoopMargins{});
    add(margins.gain.value, "dB", "unlimited");
    add(margins.phase.value, "deg", "unlimited");
    add(margins.sensitivity.value, "", "");
  }
  return row;
}

}  // namespace

std::string goal_sentence(const GoalProblem& problem) {
  const Port& input = problem.graph().inputs[problem.input];
  const Port& output = problem.graph().outputs[problem.output];
  const Signal& test = problem.drive.inputs[problem.input];
  std::string signal = "as in the record";
  if (problem.settings.signal == parameters::GoalSettings::Signal::Step) {
    signal = fmt::format("a step from {:.4g} to {:.4g}{}", test.front(), test.back(), unit_behind(input.unit));
  } else if (problem.settings.signal == parameters::GoalSettings::Signal::Ramp) {
    const double size = problem.settings.size ? problem.settings.size->value : 1.0;
    signal = fmt::format("a ramp of {:.4g} {}/s", size, input.unit.empty() ? "1" : input.unit);
  }
  std::string wish = fmt::format("the column {}", problem.settings.wished ? problem.settings.wished->text : "");
  if (problem.model) {
    wish =
        fmt::format("a response of order {} that settles in {:.4g} s", problem.model->order, problem.model->settling);
  }
  return fmt::format("{} follows {}, {}, as {}.", output.name, input.name, signal, wish);
}

TextTable tuned_table(const GoalProblem& problem, const GoalResult& result) {
  TextTable table{.heads = {"parameter", "value", "at the start", "unit", ""}};
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    table.rows.push_back({free.name, fmt::format("{:.6g}", result.x[static_cast<Eigen::Index>(j)]),
                          fmt::format("{:.6g}", free.start), free.unit,
                          result.at_bound[j] == AtBound::Lower   ? "on its lower bound"
                          : result.at_bound[j] == AtBound::Upper ? "on its upper bound"
                                                                 : ""});
  }
  return table;
}

TextTable figure_table(const GoalProblem& problem, const GoalResult& result) {
  const bool has_margins = result.plants.front().after.margins.has_value();
  TextTable table{.heads = {"plant", "error"}};
  if (problem.settings.signal == parameters::GoalSettings::Signal::Step) {
    table.heads.insert(table.heads.end(), {"overshoot", "rise time", "settling time"});
  }
  if (!problem.effort.empty()) {
    table.heads.insert(table.heads.end(), {"largest effort", "largest rate"});
  }
  if (has_margins) {
    table.heads.insert(table.heads.end(), {"gain margin", "phase margin", "Ms"});
  }
  for (std::size_t plant = 0; plant < result.plants.size(); ++plant) {
    const PlantResult& one = result.plants[plant];
    table.rows.push_back(figure_row(problem, one.name, one.after, "", has_margins));
    table.rows.push_back(figure_row(problem, "  at the start", one.before,
                                    plant == result.start_plant ? what_it_does(result.start_state) : "not tried",
                                    has_margins));
  }
  return table;
}

TextTable limit_table(const GoalProblem& problem, const GoalResult& result) {
  TextTable table{.heads = {"limit", "asked for", "plant", "is", ""}};
  for (const LimitResult& limit : result.limits) {
    const GoalLimit& one = problem.limits[limit.limit];
    const std::string unit = limit_unit(problem, one.kind);
    table.rows.push_back(
        {std::string(text_of(one.kind).name),
         fmt::format("{} {:.4g}{}", text_of(one.kind).is_least ? "≥" : "≤", one.limit, unit_behind(unit)),
         problem.plants[limit.plant].name, value_text(limit.value, unit, "unlimited"),
         !limit.is_kept    ? "BROKEN"
         : limit.is_active ? "at its limit"
                           : "kept"});
  }
  return table;
}

std::vector<std::string> goal_remarks(const GoalProblem& problem, const GoalResult& result) {
  std::vector<std::string> remarks;
  if (result.start_state != LoopState::Settles) {
    remarks.push_back(fmt::format("At the start the loop {}: the search began at a point where it settles.",
                                  what_it_does(result.start_state)));
  }
  if (result.plants.front().frequencies.empty()) {
    remarks.emplace_back("No margin is known: [goal] does not say where the loop is cut, as in loop = \"PID.XOUT\".");
  }
  if (result.start_errors.size() > 1) {
    std::string text =
        fmt::format("The best of {} starts was number {}. What each left, in %:", result.start_errors.size(),
                    result.best_start + 1);
    for (std::size_t start = 0; start < result.start_errors.size(); ++start) {
      const double error = result.start_errors[start];
      text += std::isnan(error)   ? fmt::format(" {} limits broken;", start + 1)
              : std::isinf(error) ? fmt::format(" {} no loop that settles;", start + 1)
                                  : fmt::format(" {} {:.3g};", start + 1, 100.0 * error);
    }
    text.back() = '.';
    remarks.push_back(text + " Number 1 is the file's own.");
  }
  const bool stays = std::ranges::all_of(problem.parameters, [&](const FreeParameter& free) {
    return result.x[&free - problem.parameters.data()] == free.start;
  });
  if (stays) {
    remarks.emplace_back("Nothing better than the start was found: its values are kept.");
  }
  return remarks;
}

std::string as_text(const TextTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t column = 0; column < table.heads.size(); ++column) {
    std::size_t width = character_count(table.heads[column]);
    for (const auto& row : table.rows) {
      width = std::max(width, character_count(row[column]));
    }
    widths.push_back(width);
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t column = 0; column < cells.size(); ++column) {
      text += cells[column] + std::string(widths[column] - character_count(cells[column]) + 2, ' ');
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text + "\n";
  };
  std::string text = line(table.heads);
  for (const auto& row : table.rows) {
    text += line(row);
  }
  return text;
}

}  // namespace hysteron::tool
