#include "diagnosis/findings/inner_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnosis/effects/edges.hpp"
#include "diagnosis/effects/insertion.hpp"
#include "diagnosis/model/least_squares.hpp"
#include "support/names.hpp"

namespace hysteron::diagnosis {
namespace {

bool is_port(const Graph& graph, const std::string& name) {
  const auto named = [&](const Port& port) { return language::same_name(port.name, name); };
  return std::ranges::any_of(graph.inputs, named) || std::ranges::any_of(graph.outputs, named);
}

std::string output_name(const std::string& column) {
  std::string name = language::upper(column);
  std::ranges::replace(name, '.', '_');
  return name + "_MEASURED";
}

records::Record renamed(const records::Record& record, const std::string& from, const std::string& to) {
  std::vector<records::Column> columns = record.columns();
  for (records::Column& column : columns) {
    if (language::same_name(column.name, from)) {
      column.in_file = column.name_in_file();
      column.name = to;
    }
  }
  const auto time = record.time();
  return {{time.begin(), time.end()}, record.sample_time(), std::move(columns), {.file = record.file()}};
}

/// Whether the first part of a name, before its dot, is a block of the diagram.
bool begins_with_instance(const Graph& graph, const std::string& name) {
  const std::string first = name.substr(0, name.find('.'));
  return std::ranges::any_of(graph.nodes, [&](const Node& node) {
    return language::same_name(node.path.substr(0, node.path.find_first_of(".#")), first);
  });
}

/// A name of the language from that of a column: HALL_TEMP of Hall.Temp. None that the diagram or a record has.
std::string driver_name(const DiagnosisInput& input, const std::string& column) {
  std::string name;
  for (const char c : language::upper(column)) {
    const bool fits = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (fits || (!name.empty() && name.back() != '_')) {
      name += fits ? c : '_';
    }
  }
  name.erase(name.find_last_not_of('_') + 1);
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) {
    name = "C_" + name;
  }
  const auto is_taken = [&](const std::string& candidate) {
    return is_port(input.program.graph, candidate) || begins_with_instance(input.program.graph, candidate) ||
           std::ranges::any_of(input.records,
                               [&](const records::Record& record) { return record.find(candidate) != nullptr; });
  };
  std::string result = name;
  for (int number = 2; is_taken(result); ++number) {
    result = fmt::format("{}_{}", name, number);
  }
  return result;
}

}  // namespace

DiagnosisInput with_named_drivers(const DiagnosisInput& input, std::vector<std::string>& remarks) {
  DiagnosisInput result = input;
  for (const records::Column& column : input.records.front().columns()) {
    const auto moves_in = [&](const records::Record& record) {
      const records::Column* const there = record.find(column.name);
      return there != nullptr && std::ranges::min(there->values) < std::ranges::max(there->values);
    };
    if (column.name.find('.') == std::string::npos || begins_with_instance(input.program.graph, column.name) ||
        !std::ranges::all_of(input.records, moves_in)) {
      continue;
    }
    const std::string name = driver_name(result, column.name);
    for (records::Record& record : result.records) {
      record = renamed(record, column.name, name);
    }
    result.file.record.columns.push_back({.key = name, .value = {.text = column.name_in_file()}});
    remarks.push_back(
        fmt::format("The column {0} is tried as a driver by the name {1}, which `improved.toml` keeps: "
                    "with another parameter file, give --column {1}={0}.",
                    column.name_in_file(), name));
  }
  return result;
}

DiagnosisInput with_inner_signals(const DiagnosisInput& input, std::vector<std::string>& signals) {
  DiagnosisInput result = input;
  const Graph& graph = input.program.graph;
  for (const records::Column& column : input.records.front().columns()) {
    const bool everywhere = std::ranges::all_of(
        input.records, [&](const records::Record& record) { return record.find(column.name) != nullptr; });
    if (!everywhere || is_port(graph, column.name)) {
      continue;
    }
    const std::string name = output_name(column.name);
    // improved.st has the outputs of the diagnosis before.
    if (!is_port(graph, name)) {
      Diagnostics ignored;  // the text compiles
      const auto source = std::make_shared<const language::SourceFile>(language::parse("text", result.text, ignored));
      const Definitions definitions = define(source, ignored);
      const std::uint32_t top = top_definition(definitions, graph.name);
      const std::vector<Edge> edges = edges_of(definitions, top);
      const Edge* const edge = find_edge(edges, column.name);
      if (edge == nullptr || edge->definition != top) {
        continue;
      }
      result.text = with_output(*source, *edge, name);
    }
    for (records::Record& record : result.records) {
      record = renamed(record, column.name, name);
    }
    if (!result.file.tune.outputs.empty()) {
      result.file.tune.outputs.push_back({.text = name});
    }
    signals.push_back(name);
  }
  if (result.text != input.text) {
    result.program = compile_text(result.text, {.top = graph.name, .any_order = true});
  }
  return result;
}

std::vector<CutFinding> cuts_at(const std::vector<std::string>& signals, const Task& task, const Program& program,
                                const Materiality& materiality) {
  std::vector<CutFinding> cuts;
  Model model(task, program);
  const Index rows = model.rows() / std::ssize(task.outputs);
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    if (std::ranges::find(signals, task.outputs[output]) == signals.end()) {
      continue;
    }
    VectorXd weights = VectorXd::Zero(model.rows());
    weights.segment(static_cast<Index>(output) * rows, rows).setOnes();
    const Fit alone = fit(model, model.start(), {.iterations = 20, .weights = &weights});
    cuts.push_back({.signal = task.outputs[output],
                    .agrees = std::isfinite(alone.cost) && !materiality.is_left(alone.residuals, output)});
  }
  return cuts;
}

std::vector<std::string> unmatched_columns(const DiagnosisInput& input) {
  Diagnostics ignored;  // the text compiles
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", input.text, ignored));
  const Definitions definitions = define(source, ignored);
  const std::uint32_t top = top_definition(definitions, input.program.graph.name);
  const std::vector<Edge> edges = edges_of(definitions, top);
  std::vector<std::string> known;
  for (const Edge& edge : edges) {
    if (edge.definition == top) {
      known.push_back(edge.name);
      known.insert(known.end(), edge.aliases.begin(), edge.aliases.end());
    }
  }
  std::vector<std::string> names;
  for (const records::Record& record : input.records) {
    for (const records::Column& column : record.columns()) {
      const auto same = [&](const std::string& name) { return language::same_name(name, column.name); };
      if (column.name.find('.') != std::string::npos && std::ranges::none_of(names, same)) {
        names.push_back(column.name);
      }
    }
  }
  std::vector<std::string> remarks;
  for (const std::string& name : names) {
    const Edge* const edge = find_edge(edges, name);
    if (edge == nullptr) {
      const std::string_view near = nearest_name(name, known);
      remarks.push_back(fmt::format("The column {} is no signal of {} and is left aside{}", name,
                                    input.program.graph.name,
                                    near.empty() ? "." : fmt::format(": did you mean {}?", near)));
      if (begins_with_instance(input.program.graph, name)) {
        remarks.back() += fmt::format(" Where it may be a cause, name it without a dot: --column {}={}.",
                                      driver_name(input, name), name);
      }
    } else if (edge->definition != top) {
      remarks.push_back(fmt::format(
          "The column {} is a signal inside an inner block and is left aside: only signals of {} itself cut it.", name,
          input.program.graph.name));
    } else if (!std::ranges::all_of(input.records,
                                    [&](const records::Record& record) { return record.find(name) != nullptr; })) {
      remarks.push_back(fmt::format("The column {} is left aside: not every record has it.", name));
    }
  }
  return remarks;
}

}  // namespace hysteron::diagnosis
