#include "diagnosis/model/ignored_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::diagnosis {
namespace {

void check(const parameters::PlacedText& ignored, const DiagnosisInput& input, Diagnostics& diagnostics) {
  const Graph& graph = input.program.graph;
  if (find_port(graph.inputs, ignored.text) != nullptr) {
    diagnostics.error(error::unknown_key, ignored.place,
                      fmt::format("{} is an input of {}: it drives the diagram.", ignored.text, graph.name),
                      "ignore columns alone that the diagram does not name, or take the input out of the diagram.");
    return;
  }
  if (find_port(graph.outputs, ignored.text) != nullptr) {
    diagnostics.error(
        error::unknown_key, ignored.place,
        fmt::format("{} is an output of {}: it is what the diagram should meet.", ignored.text, graph.name),
        "name the outputs to be met in [tune]: outputs = [\"Y\"].");
    return;
  }
  std::vector<std::string> known;
  for (const records::Record& record : input.records) {
    for (const std::string& name : record.names()) {
      if (equal_ignoring_case(name, ignored.text)) {
        return;
      }
      known.push_back(name);
    }
  }
  const auto near = nearest_name(ignored.text, known);
  diagnostics.error(error::missing_column, ignored.place,
                    fmt::format("{} is to be ignored, and no record has such a column.", ignored.text),
                    near.empty() ? fmt::format("the columns are {}.", fmt::join(input.records.front().names(), ", "))
                                 : fmt::format("did you mean {}?", near));
}

}  // namespace

void ignore_columns(DiagnosisInput& input) {
  const std::vector<parameters::PlacedText>& ignored = input.file.diagnose.ignore;
  Diagnostics diagnostics;
  for (const parameters::PlacedText& one : ignored) {
    check(one, input, diagnostics);
  }
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
  for (records::Record& record : input.records) {
    for (const parameters::PlacedText& one : ignored) {
      record.remove(one.text);
    }
  }
}

}  // namespace hysteron::diagnosis
