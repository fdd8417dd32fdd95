#include "diagnosis/inner_signals.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "diagnosis/edges.hpp"
#include "diagnosis/insertion.hpp"

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

}  // namespace hysteron::diagnosis
