#include "diagnosis/model/task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "codegen/graph/units.hpp"
#include "codegen/parameters/apply.hpp"
#include "codegen/parameters/elements.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double prior_share = 0.3;
/// A tuning that ran into a bound has bent the parameter to make up for something else: it says less of its value.
constexpr double wider_at_bound = 5.0;

/// The unit is what the wires make of it: C1 of a slope between V and um is um/V.
Unknown known_of(const Parameter& parameter, const std::string& unit) {
  const double value = parameter.value.front();
  Unknown unknown{.path = parameter.path,
                  .unit = unit,
                  .start = value,
                  .lower = parameter.field.minimum,
                  .upper = parameter.field.maximum,
                  .typical = value == 0.0 ? 1.0 : std::abs(value),
                  .deviation = prior_share * std::abs(value)};
  return unknown;
}

/// Once; or where there are several records, each with its own value, once for each. What a tuning gives is their mean,
/// and no prior for one of them.
void add_known(const Unknown& unknown, std::size_t records, std::vector<Unknown>& known) {
  if (records < 2) {
    known.push_back(unknown);
    return;
  }
  for (std::size_t record = 0; record < records; ++record) {
    Unknown own = unknown;
    own.record = record;
    own.deviation = infinity;
    known.push_back(std::move(own));
  }
}

bool is_name(const std::string& text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

}  // namespace

Task task_of(const DiagnosisInput& input) {
  Graph graph = input.program.graph;
  const parameters::ParameterFile file = parameters::by_element(input.file, graph);
  Task task{.file = {.file = file.file, .values = file.values, .initial = file.initial}, .records = input.records};
  parameters::apply(file, graph);
  const std::vector<std::string> units = units::Solution(graph, input.program.schedule).parameters();
  const auto known_at = [&](std::size_t parameter) { return known_of(graph.parameters[parameter], units[parameter]); };
  for (const parameters::FitSetting& setting : file.fits) {
    const std::int64_t found = find_parameter(graph, setting.path);
    if (found < 0 || graph.parameters[static_cast<std::size_t>(found)].field.type != Type::Real ||
        graph.parameters[static_cast<std::size_t>(found)].field.length > 1) {
      continue;  // output_error_problem reports the first; arrays stay as they are
    }
    Unknown unknown = known_at(static_cast<std::size_t>(found));
    unknown.lower = setting.minimum ? std::max(unknown.lower, setting.minimum->value) : unknown.lower;
    unknown.upper = setting.maximum ? std::min(unknown.upper, setting.maximum->value) : unknown.upper;
    if (setting.scale) {
      unknown.typical = setting.scale->value;
    }
    unknown.start = std::clamp(unknown.start, unknown.lower, unknown.upper);
    const double margin = 1e-3 * std::abs(unknown.start);
    unknown.at_bound = unknown.lower < unknown.upper &&
                       (unknown.start - unknown.lower <= margin || unknown.upper - unknown.start <= margin);
    if (unknown.at_bound) {
      unknown.deviation *= wider_at_bound;
    }
    add_known(unknown, setting.by_record ? input.records.size() : 1, task.known);
  }
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    const Parameter& parameter = graph.parameters[i];
    const bool number = parameter.field.type == Type::Real && parameter.field.length == 1;
    if (!task.known.empty() && !file.fits.empty()) {
      break;
    }
    if (number && parameter.value.front() != 0.0 && std::isfinite(parameter.value.front()) &&
        parameter.field.role != FieldRole::StartValue) {
      task.known.push_back(known_at(i));
    }
  }
  for (const parameters::PlacedText& state : input.file.tune.initial_states) {
    task.initial_states.push_back(state.text);
  }
  std::vector<std::string> wanted;
  for (const parameters::PlacedText& output : file.tune.outputs) {
    wanted.push_back(output.text);
  }
  for (const Port& output : graph.outputs) {
    const bool chosen = wanted.empty() || std::ranges::any_of(wanted, [&](const std::string& name) {
                          return language::same_name(name, output.name);
                        });
    if (chosen && output.type == Type::Real && std::ranges::any_of(input.records, [&](const records::Record& record) {
          return record.find(output.name) != nullptr;
        })) {
      task.outputs.push_back(output.name);
    }
  }
  return task;
}

std::vector<std::string> unused_columns(const Task& task, const Program& program) {
  std::vector<std::string> result;
  const auto named = [](const std::vector<Port>& ports, const std::string& name) {
    return std::ranges::any_of(ports, [&](const Port& port) { return language::same_name(port.name, name); });
  };
  for (const records::Column& column : task.records.front().columns()) {
    const bool everywhere = std::ranges::all_of(
        task.records, [&](const records::Record& record) { return record.find(column.name) != nullptr; });
    const auto [low, high] = std::ranges::minmax(column.values);
    if (everywhere && high > low && is_name(column.name) && !named(program.graph.inputs, column.name) &&
        !named(program.graph.outputs, column.name)) {
      result.push_back(language::upper(column.name));
    }
  }
  return result;
}

std::vector<std::string> remarks_on_bounds(const Task& task) {
  std::vector<std::string> remarks;
  for (const Unknown& known : task.known) {
    if (known.at_bound && known.record.value_or(0) == 0) {
      const bool low = known.start - known.lower <= known.upper - known.start;
      remarks.push_back(fmt::format(
          "{} = {} lies on the {} bound of its fit: the tuning would have gone further, and may stand in for what "
          "the diagram lacks. Widen the bound and tune again, or set a value that you know.",
          known.path, number_text(known.start), low ? "lower" : "upper"));
    }
  }
  return remarks;
}

InputError error_of_start(const DiagnosisInput& input) {
  return {error::start_without_value,
          {.file = input.file.file},
          "The diagram has no finite output with these parameters.",
          "run it with hysteron run to see where it leaves its range, and correct the parameters."};
}

std::vector<std::vector<Signal>> columns_by_record(const Task& task, const std::vector<std::string>& names) {
  std::vector<std::vector<Signal>> result;
  for (const records::Record& record : task.records) {
    result.emplace_back();
    for (const std::string& name : names) {
      result.back().push_back(record.column(name).values);
    }
  }
  return result;
}

std::string unit_of(const Program& program, const std::string& output) {
  const Port* const port = find_port(program.graph.outputs, output);
  return port == nullptr ? std::string() : port->unit;
}

double longest_duration(const Task& task) {
  double longest = 0.0;
  for (const records::Record& record : task.records) {
    longest = std::max(longest, record.time().back() - record.time().front());
  }
  return longest;
}

std::vector<Signal> by_record(const Task& task, const VectorXd& residuals, std::size_t output) {
  Index row = static_cast<Index>(output) * (residuals.size() / std::ssize(task.outputs));
  std::vector<Signal> result;
  for (const records::Record& record : task.records) {
    Signal& here = result.emplace_back(record.size());
    for (double& value : here) {
      value = residuals[row++] * task.scales[output];
    }
  }
  return result;
}

double rms_of(const Task& task, const VectorXd& residuals, std::size_t output) {
  const Index rows = residuals.size() / std::ssize(task.outputs);
  const Index first = static_cast<Index>(output) * rows;
  const auto own = residuals.segment(first, rows);
  const auto out = std::ranges::count_if(task.left_out, [&](Index row) { return row >= first && row < first + rows; });
  return std::sqrt(own.squaredNorm() / static_cast<double>(std::max<Index>(1, rows - out))) * task.scales[output];
}

}  // namespace hysteron::diagnosis
