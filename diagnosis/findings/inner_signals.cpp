#include "diagnosis/findings/inner_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
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
      column.name = to;
    }
  }
  const auto time = record.time();
  return {{time.begin(), time.end()}, record.sample_time(), std::move(columns), {.file = record.file()}};
}

}  // namespace

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
