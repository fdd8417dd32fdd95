#include "tuning/goal/goal_problem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <utility>

#include "codegen/graph/defaults.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/parameters/apply.hpp"
#include "codegen/parameters/elements.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "tuning/record_units.hpp"
#include "tuning/signal_names.hpp"

namespace hysteron {
namespace {

using parameters::GoalSettings;
using parameters::ParameterFile;
using parameters::PlacedNumber;
using parameters::PlacedText;

/// How many steps the loop rests before the test signal begins.
constexpr std::size_t steps_at_rest = 10;
constexpr double least_steps = 10.0;  ///< of a test
constexpr double most_steps = 1e6;
constexpr double settling_times = 3.0;

class GoalBuilder {
 public:
  GoalBuilder(const Program& program, const ParameterFile& file, std::span<const records::Record> records)
      : program_(program),
        file_(parameters::by_element(file, program.graph, diagnostics_)),
        goal_(file.goal),
        records_(records) {
    problem_.settings = goal_;
  }

  GoalProblem build() {
    parameters::apply(file_, program_.graph, diagnostics_);
    check_records();
    throw_if_any();
    if (!records_.empty()) {
      settle_sample_time(records_.front(), program_, diagnostics_);
    }
    find_ports();
    throw_if_any();
    drive();
    throw_if_any();
    const units::Solution units(program_.graph, program_.schedule);
    problem_.parameters = free_parameters(program_.graph, file_, 1, units.parameters(), diagnostics_);
    check_parameters();
    take_limits();
    add_plants();
    throw_if_any();
    if (const auto& effort = problem_.plants.front().effort; effort && effort->from == Wire::From::Node) {
      problem_.effort_unit = units.outputs()[effort->index].empty() ? "" : units.outputs()[effort->index][effort->port];
    }
    return std::move(problem_);
  }

 private:
  void throw_if_any() {
    if (diagnostics_.has_errors()) {
      throw InputError(std::move(diagnostics_));
    }
  }

  void lacks(const Place& place, std::string cause, std::string mend) {
    diagnostics_.error(error::goal_lacks, place, std::move(cause), std::move(mend));
  }

  void check_records() {
    const bool needs_record = goal_.signal == GoalSettings::Signal::Record;
    if (needs_record && records_.size() != 1) {
      lacks(goal_.place,
            fmt::format("signal = \"record\" takes one record, and {} given.",
                        records_.empty() ? "none is" : fmt::format("{} are", records_.size())),
            "give it as --log LOG.csv.");
    } else if (!needs_record && !records_.empty()) {
      lacks(goal_.place, "[goal] has a test signal of its own, and a record is given as well.",
            "write signal = \"record\" in [goal] to drive the loop by the record, leave --log out, or take [goal] out "
            "of the file to fit the record.");
    }
  }

  void check_parameters() {
    if (problem_.parameters.empty() && !diagnostics_.has_errors()) {
      diagnostics_.error(
          error::nothing_to_fit, {.file = file_.file},
          fmt::format("{} marks no parameter for tuning.", file_.file.empty() ? "the parameter file" : file_.file),
          "name those of the controller in a table [fit.INSTANCE], as in [fit.PID] and KP = {min = 0.0}.");
    }
    for (const parameters::FitSetting& fit : file_.fits) {
      if (fit.by_record) {
        diagnostics_.error(error::contradicting_range, fit.place,
                           fmt::format("{} has a value for each record, and a goal has no records.", fit.path),
                           fmt::format("move it from [fit.record] to [fit].", fit.path));
      }
    }
    if (!file_.tune.initial_states.empty()) {
      diagnostics_.error(error::contradicting_range, file_.tune.initial_states.front().place,
                         "initial_states are fitted to records, and a goal has none.", "take them out of [tune].");
    }
  }

  // ---- ports ------------------------------------------------------------------------------------------------------

  /// The only LREAL among ports that a condition leaves.
  template <class Condition>
  std::optional<std::size_t> only_port(const std::vector<Port>& ports, std::string_view kind, Condition condition) {
    std::vector<std::size_t> candidates;
    for (std::size_t i = 0; i < ports.size(); ++i) {
      if (ports[i].type == Type::Real && condition(ports[i])) {
        candidates.push_back(i);
      }
    }
    if (candidates.size() == 1) {
      return candidates.front();
    }
    const std::vector<std::string> names = names_of(ports);
    lacks(goal_.place,
          fmt::format("[goal] does not say which {} it means: {} has {}.", kind, program_.graph.name,
                      names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))),
          names.empty() ? fmt::format("declare an {} of the loop in the diagram.", kind)
                        : fmt::format("name it, as in {} = \"{}\".", kind, names.front()));
    return std::nullopt;
  }

  void find_ports() {
    const Graph& graph = program_.graph;
    const auto input = goal_.input ? find_port(graph, graph.inputs, "input", *goal_.input, diagnostics_)
                                   : only_port(graph.inputs, "input", [&](const Port& port) {
                                       return !has_default(graph, port) || graph.inputs.size() == 1;
                                     });
    const auto output = goal_.output ? find_port(graph, graph.outputs, "output", *goal_.output, diagnostics_)
                                     : only_port(graph.outputs, "output", [](const Port&) { return true; });
    for (const auto& [found, ports, kind] :
         {std::tuple(input, &graph.inputs, "input"), std::tuple(output, &graph.outputs, "output")}) {
      if (found && (*ports)[*found].type != Type::Real) {
        lacks(goal_.place, fmt::format("The {} {} is no LREAL.", kind, (*ports)[*found].name),
              "name a signal that moves continuously.");
      }
    }
    problem_.input = input.value_or(0);
    problem_.output = output.value_or(0);
  }

  // ---- test signal ------------------------------------------------------------------------------------------------

  static double value_or(const std::optional<PlacedNumber>& number, double otherwise) {
    return number ? number->value : otherwise;
  }

  void drive() {
    if (goal_.rise_time || goal_.settling_time) {
      problem_.model = wished_response(goal_);
    }
    if (goal_.signal == GoalSettings::Signal::Record) {
      take_record();
    } else {
      make_signal();
    }
    if (diagnostics_.has_errors()) {
      return;
    }
    if (problem_.model) {
      const Signal& input = problem_.drive.inputs[problem_.input];
      problem_.wished = response_to(*problem_.model, input, problem_.drive.sample_time);
    }
    if (goal_.signal == GoalSettings::Signal::Record) {
      const auto [low, high] = std::ranges::minmax(problem_.wished);
      problem_.size = high - low;
      if (!(problem_.size > 0.0)) {
        report_no_move();
      }
    }
  }

  void make_signal() {
    const Graph& graph = program_.graph;
    for (const Port& port : graph.inputs) {
      if (&port != &graph.inputs[problem_.input] && !has_default(graph, port)) {
        lacks(goal_.place, fmt::format("Nothing drives the input {} during the test.", port.name),
              fmt::format("give it a default in the diagram, as in {} : LREAL := 0.0, or drive the loop by a record: "
                          "signal = \"record\".",
                          port.name));
      }
    }
    const double ts = Machine<double>(program_).sample_time();
    // A limit that is broken behind a short test is broken all the same.
    const double watched = settling_times * problem_.model->settling;
    const double duration = value_or(goal_.duration, watched);
    const double whole = std::max(duration, watched);
    const bool is_short = duration / ts < least_steps;
    if (whole / ts > most_steps || is_short) {
      const Place place = goal_.duration ? goal_.duration->place : goal_.place;
      const double told = is_short ? duration : whole;
      diagnostics_.error(error::contradicting_range, place,
                         fmt::format("The test lasts {:.4g} s, {:.3g} steps of the diagram{}.", told, told / ts,
                                     told > duration ? ", since limits count over three settling times" : ""),
                         "choose a duration of 10 to 1000000 steps, or another wished response.");
      return;
    }
    if (goal_.duration && duration < problem_.model->settling) {
      diagnostics_.error(
          error::contradicting_range, goal_.duration->place,
          fmt::format("The test ends at {:.4g} s, before the wished response has settled, at {:.4g} s.", duration,
                      problem_.model->settling),
          fmt::format("leave duration out, or let it be at least {:.4g}: what comes later would not be seen.",
                      watched));
      return;
    }
    const double from = value_or(goal_.from, 0.0);
    const double size = value_or(goal_.size, 1.0);
    problem_.begin = steps_at_rest;
    problem_.drive.sample_time = ts;
    problem_.drive.steps = steps_at_rest + static_cast<std::size_t>(std::ceil(whole / ts));
    problem_.end = steps_at_rest + static_cast<std::size_t>(std::ceil(duration / ts));
    for (const Port& port : graph.inputs) {
      problem_.drive.inputs.push_back({port.preset});
    }
    Signal test(problem_.drive.steps, from);
    for (std::size_t k = steps_at_rest; k < test.size(); ++k) {
      test[k] += goal_.signal == GoalSettings::Signal::Step ? size : size * static_cast<double>(k - steps_at_rest) * ts;
    }
    problem_.size = std::fabs(test.back() - from);
    problem_.drive.inputs[problem_.input] = std::move(test);
  }

  /// A wish that stands still over the whole record has nothing that a loop could follow.
  void report_no_move() {
    const Signal& input = problem_.drive.inputs[problem_.input];
    const std::string& name = program_.graph.inputs[problem_.input].name;
    const auto moves = std::ranges::adjacent_find(input, std::not_equal_to<>());
    if (goal_.wished) {
      lacks(goal_.wished->place, fmt::format("The column {} of the record never moves.", goal_.wished->text),
            "name a column in which the response moves, or take another record.");
    } else if (moves == input.end()) {
      lacks(goal_.place, fmt::format("The set point {} of the record never moves.", name),
            "take a record in which it moves.");
    } else {
      const auto behind = static_cast<double>(input.end() - moves - 1) * problem_.drive.sample_time;
      lacks(
          goal_.dead_time ? goal_.dead_time->place : goal_.place,
          fmt::format("The record ends {:.4g} s after {} moves, within the dead time of the wished response, {:.4g} s.",
                      behind, name, problem_.model->dead_time),
          fmt::format("take a record that goes on for {:.4g} s behind the move, or state a smaller dead_time.",
                      settling_times * problem_.model->settling));
    }
  }

  void take_record() {
    const records::Record& record = records_.front();
    problem_.drive = drive_from(record, program_, {}, diagnostics_);
    problem_.end = problem_.drive.steps;
    const Port& input = program_.graph.inputs[problem_.input];
    if (!diagnostics_.has_errors() && problem_.drive.inputs[problem_.input].size() < 2) {
      diagnostics_.error(error::missing_column, {.file = record.file()},
                         fmt::format("The record has no column {}, which is to drive the loop.", input.name),
                         fmt::format("say which column holds it, as --column {}=NAME.", input.name));
    }
    if (goal_.wished) {
      if (record.find(goal_.wished->text) != nullptr) {
        records::Record converted = record;
        convert_unit(converted, goal_.wished->text, program_.graph.outputs[problem_.output], program_.graph,
                     problem_.found);
        diagnostics_.add_all(problem_.found);
        problem_.wished = converted.column(goal_.wished->text).values;
        problem_.notes.assign(converted.notes().begin() + static_cast<std::ptrdiff_t>(record.notes().size()),
                              converted.notes().end());
      } else {
        diagnostics_.error(error::missing_column, goal_.wished->place,
                           fmt::format("{} has no column {}.", record.file(), goal_.wished->text),
                           fmt::format("the columns are {}.", fmt::join(record.names(), ", ")));
      }
    }
  }

  // ---- limits and plants ------------------------------------------------------------------------------------------

  void take_limits() {
    for (const LimitText& text : limit_texts) {
      if (const auto& limit = goal_.*text.key.setting) {
        problem_.limits.push_back({.kind = text.kind, .limit = limit->value, .place = limit->place});
      }
    }
  }

  void add_plants() {
    if (goal_.plants.empty()) {
      add_plant(file_.file, program_);
    }
    for (const PlacedText& plant : goal_.plants) {
      ParameterFile values;
      try {
        const std::string file = file_of_plant(file_.file, plant.text);
        values = parameters::by_element(parameters::read_parameter_file(file), program_.graph);
      } catch (const InputError& error) {
        for (Diagnostic one : error.diagnostics().all()) {
          one.notes.push_back({.place = plant.place, .text = "named as a plant here"});
          diagnostics_.add(std::move(one));
        }
        continue;
      }
      for (const parameters::ParameterValue& value : values.values) {
        const auto tuned = std::ranges::find_if(problem_.parameters, [&](const FreeParameter& free) {
          return equal_ignoring_case(program_.graph.parameters[free.parameter].path, value.path);
        });
        if (tuned != problem_.parameters.end()) {
          diagnostics_.error(error::plant_sets_tuned, value.place,
                             fmt::format("{} is tuned, and cannot be a value of the plant {}.", value.path, plant.text),
                             "remove it here, or from [fit] of the goal's file.",
                             {{.place = tuned->place, .text = "it is tuned here"}});
        }
      }
      Program program = program_;
      parameters::apply(values, program.graph, diagnostics_);
      add_plant(plant.text, std::move(program));
    }
  }

  void add_plant(const std::string& name, Program program) {
    LoopPlant plant{.name = name, .program = std::move(program)};
    const Graph& graph = plant.program.graph;
    plant.output = graph.outputs[problem_.output].wire;
    const auto& effort = goal_.effort ? goal_.effort : goal_.loop;
    try {
      if (effort) {
        plant.effort = find_signal(graph, effort->text, effort->place);
        problem_.effort = in_capitals(effort->text);
      }
      if (goal_.loop) {
        const Wire wire = find_signal(graph, goal_.loop->text, goal_.loop->place);
        plant.cut = cut_loop(plant.program, wire, goal_.loop->text, goal_.loop->place, diagnostics_);
      }
    } catch (const InputError& error) {
      diagnostics_.add(error.diagnostics().all().front());
    }
    if (problem_.plants.empty() || !diagnostics_.has_errors()) {
      problem_.plants.push_back(std::move(plant));
    }
  }

  Diagnostics diagnostics_{};
  Program program_;
  ParameterFile file_;  ///< by element
  const GoalSettings& goal_;
  std::span<const records::Record> records_;
  GoalProblem problem_{};
};

}  // namespace

std::string file_of_plant(const std::string& goal_file, const std::string& plant) {
  return (std::filesystem::path(goal_file).parent_path() / plant).string();
}

GoalProblem goal_problem(const Program& program, const ParameterFile& file, std::span<const records::Record> records) {
  return GoalBuilder(program, file, records).build();
}

}  // namespace hysteron
