// From a diagram, a parameter file and records to the problem of output_error.hpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "codegen/graph/units.hpp"
#include "codegen/parameters/apply.hpp"
#include "codegen/parameters/elements.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/rounded_text.hpp"
#include "tuning/free_parameters.hpp"
#include "tuning/output_error.hpp"
#include "tuning/signal_names.hpp"

namespace hysteron {
namespace {

using parameters::ParameterFile;

class Builder {
 public:
  Builder(const Program& program, const ParameterFile& file, std::span<const records::Record> records)
      : file_(parameters::by_element(file, program.graph, diagnostics_)), records_(records) {
    problem_.program = program;
    problem_.loss = file.tune.loss == parameters::Loss::Huber ? Loss::Huber : Loss::Squares;
    parameters::apply(file_, problem_.program.graph, diagnostics_);
  }

  OutputErrorProblem build(bool may_be_fixed) {
    const units::Solution units(graph(), problem_.program.schedule);
    if (!file_.tune.initial_states.empty()) {
      state_units_ = units.states();
    }
    problem_.parameters = free_parameters(graph(), file_, records_.size(), units.parameters(), diagnostics_);
    for (const parameters::PlacedText& state : file_.tune.initial_states) {
      add_state(state);
    }
    if (!may_be_fixed && problem_.parameters.empty() && problem_.initial_states.empty() && !diagnostics_.has_errors()) {
      diagnostics_.error(error::nothing_to_fit, {.file = file_.file},
                         fmt::format("{} marks no parameter for fitting.", name_of_file()),
                         "name those that may change in a table [fit.INSTANCE], as in C1 = {min = 0.0}.");
    }
    if (!may_be_fixed && file_.goal.is_given()) {
      diagnostics_.error(error::goal_lacks, file_.goal.place,
                         "The file has a [goal] for a control loop, and a fit to records was asked for.",
                         "take [goal] out of the file to fit the records, or tune for it by hysteron tune.");
    }
    find_outputs();
    for (const records::Record& record : records_) {
      settle_sample_time(record, problem_.program, diagnostics_);
      check_same_sample_time(record);
      add_experiment(record);
    }
    refuse_empty_tests();
    if (diagnostics_.has_errors()) {
      throw InputError(std::move(diagnostics_));
    }
    return std::move(problem_);
  }

 private:
  [[nodiscard]] const Graph& graph() const { return problem_.program.graph; }
  [[nodiscard]] std::string name_of_file() const { return file_.file.empty() ? "the parameter file" : file_.file; }

  // ---- unknowns ---------------------------------------------------------------------------------------------------

  void add_state(const parameters::PlacedText& wanted) {
    if (const auto found = parameters::find_state(graph(), wanted.text, wanted.place, diagnostics_)) {
      const Node& node = graph().nodes[found->node];
      const Field& field = node.block->states[found->state];
      problem_.initial_states.push_back({.path = fmt::format("{}.{}", node.path, field.name),
                                         .unit = state_units_[found->node][found->state],
                                         .meaning = std::string(field.meaning),
                                         .place = wanted.place,
                                         .lower = field.minimum,
                                         .upper = field.maximum});
    }
  }

  // ---- records ----------------------------------------------------------------------------------------------------

  void find_outputs() {
    const auto& outputs = graph().outputs;
    for (const parameters::PlacedText& wanted : file_.tune.outputs) {
      if (const auto found = find_port(graph(), outputs, "output", wanted, diagnostics_)) {
        problem_.outputs.push_back(*found);
      }
    }
    if (!file_.tune.outputs.empty()) {
      return;
    }
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const auto measured = [&](const records::Record& record) { return record.find(outputs[i].name) != nullptr; };
      if (std::ranges::any_of(records_, measured)) {
        problem_.outputs.push_back(i);
      }
    }
    if (outputs.empty()) {
      diagnostics_.error(error::no_measured_output, {.file = graph().source ? graph().source->path : std::string()},
                         fmt::format("{} has no output that a record could hold.", graph().name),
                         "declare one in VAR_OUTPUT, named as the record's column.");
    } else if (problem_.outputs.empty()) {
      const std::vector<std::string> names = names_of(outputs);
      const std::vector<std::string> columns =
          records_.empty() ? std::vector<std::string>() : records_.front().all_names();
      diagnostics_.error(
          error::no_measured_output, {.file = records_.empty() ? std::string() : records_.front().file()},
          fmt::format("No column bears the name of an output of {}: {}.", graph().name, fmt::join(names, ", ")),
          records_.empty()  ? "give a record."
          : columns.empty() ? "record an output beside the time: its only column is t."
                            : fmt::format("say which column holds it, as --column {}=NAME; the columns are {}.",
                                          names.front(), fmt::join(columns, ", ")));
    }
  }

  /// A sample time that is no whole number of nanoseconds is not kept in the program; records must agree all the same.
  void check_same_sample_time(const records::Record& record) {
    const double first = records_.front().sample_time();
    if (graph().sample_time_ns == 0 && std::fabs(record.sample_time() - first) > 1e-6 * first) {
      diagnostics_.error(error::sample_time_mismatch, {.file = record.file()},
                         fmt::format("The record has a sample time of {} s, the first one {} s.",
                                     rounded_text(record.sample_time()), rounded_text(first)),
                         "resample one of them.");
    }
  }

  void add_experiment(const records::Record& record) {
    Experiment experiment{.name = record.file(),
                          .time = std::vector<double>(record.time().begin(), record.time().end()),
                          .drive = drive_from(record, problem_.program, {}, diagnostics_)};
    for (const std::size_t output : problem_.outputs) {
      try {
        const records::Column& column = record.column(graph().outputs[output].name);
        experiment.measured.push_back(column.values);
        experiment.steps.push_back(column.step);
      } catch (const InputError& missing) {
        diagnostics_.add(missing.diagnostics().all().front());
      }
    }
    experiment.train = rows_of(record, file_.tune.train);
    experiment.test = rows_of(record, file_.tune.test);
    if (file_.tune.train.empty()) {
      experiment.train = all_but(experiment.test, record.size());
    }
    if (experiment.train.empty()) {
      diagnostics_.error(error::nothing_to_train_on, {.file = record.file()},
                         fmt::format("The record, {} to {} s, has no sample in the intervals of train.",
                                     number_text(record.time().front()), number_text(record.time().back())),
                         "widen train in [tune], or leave the record out.");
    }
    problem_.experiments.push_back(std::move(experiment));
  }

  static std::vector<records::RowRange> all_but(const std::vector<records::RowRange>& taken, std::size_t size) {
    std::vector<records::RowRange> rest;
    std::size_t first = 0;
    for (const records::RowRange& range : taken) {
      if (first < range.first) {
        rest.push_back({.first = first, .last = range.first});
      }
      first = range.last;
    }
    if (first < size) {
      rest.push_back({.first = first, .last = size});
    }
    return rest;
  }

  /// An interval beyond all records would be a test of nothing.
  void refuse_empty_tests() {
    for (const parameters::Interval& test : file_.tune.test) {
      const auto is_met = [&](const records::Record& record) {
        const records::RowRange rows = record.rows_between(test.begin, test.end);
        return rows.first < rows.last;
      };
      if (!records_.empty() && std::ranges::none_of(records_, is_met)) {
        const records::Record& record = records_.front();
        diagnostics_.error(error::contradicting_range, test.place,
                           fmt::format("No record has a sample from {} to {} s, which is to be the test.",
                                       number_text(test.begin), number_text(test.end)),
                           fmt::format("choose a part of a record: {} holds {} to {} s.", record.file(),
                                       number_text(record.time().front()), number_text(record.time().back())));
      }
    }
  }

  /// Sorted, without overlap: a sample counts once.
  static std::vector<records::RowRange> rows_of(const records::Record& record,
                                                const std::vector<parameters::Interval>& intervals) {
    std::vector<records::RowRange> ranges;
    ranges.reserve(intervals.size());
    for (const parameters::Interval& interval : intervals) {
      ranges.push_back(record.rows_between(interval.begin, interval.end));
    }
    std::ranges::sort(ranges, {}, &records::RowRange::first);
    std::vector<records::RowRange> result;
    for (records::RowRange range : ranges) {
      range.first = result.empty() ? range.first : std::max(range.first, result.back().last);
      if (range.first < range.last) {
        result.push_back(range);
      }
    }
    return result;
  }

  Diagnostics diagnostics_{};
  ParameterFile file_;  ///< by element
  std::span<const records::Record> records_;
  std::vector<std::vector<std::string>> state_units_{};  ///< by node and state
  OutputErrorProblem problem_{};
};

}  // namespace

OutputErrorProblem output_error_problem(const Program& program, const ParameterFile& file,
                                        std::span<const records::Record> records, bool may_be_fixed) {
  return Builder(program, file, records).build(may_be_fixed);
}

}  // namespace hysteron
