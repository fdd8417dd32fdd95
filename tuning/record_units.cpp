#include "tuning/record_units.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "codegen/graph/unit.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/option_words.hpp"

namespace hysteron {

void convert_unit(records::Record& record, const std::string& name, const Port& port, const Graph& graph,
                  Diagnostics& diagnostics) {
  const records::Column* const column = record.find(name);
  if (column == nullptr || column->unit.empty() || port.unit.empty() || column->unit == port.unit) {
    return;
  }
  std::string reason;
  const std::optional<units::Unit> wanted = units::parse_unit(port.unit, reason);
  const std::optional<units::Unit> found = units::parse_unit(column->unit, reason);
  const Note of_port{.place = graph.place(port.span), .text = fmt::format("{} is in {}", port.name, port.unit)};
  const std::string as_in_the_diagram = option_value(fmt::format("{}={}[{}]", name, column->name_in_file(), port.unit));
  if (!wanted || !found) {
    diagnostics.warning(
        error::unit_of_column, record.place(name, 0),
        fmt::format("The unit {} of column {} is not known; its numbers are taken to be in {}.", column->unit,
                    column->name, port.unit),
        fmt::format("say the unit in which its numbers are: --column {}, if that is it.", as_in_the_diagram),
        {of_port});
    return;
  }
  const std::optional<double> factor = units::conversion(*found, *wanted);
  if (!factor) {
    diagnostics.error(error::unit_of_column, record.place(name, 0),
                      fmt::format("Column {} is in {}, and {} of the diagram in {}.", column->name, column->unit,
                                  port.name, port.unit),
                      fmt::format("name another column, or say that its numbers are in {} all the same: --column {}.",
                                  port.unit, as_in_the_diagram),
                      {of_port});
    return;
  }
  if (units::same_size(*factor, 1.0)) {
    return;
  }
  record.note(fmt::format("column {} is in {}, and was converted to {}: times {}", column->name, column->unit,
                          port.unit, number_text(*factor)));
  record.convert(name, *factor, port.unit);
}

void convert_units(records::Record& record, const Program& program, Diagnostics& diagnostics) {
  for (const auto* const ports : {&program.graph.inputs, &program.graph.outputs}) {
    for (const Port& port : *ports) {
      convert_unit(record, port.name, port, program.graph, diagnostics);
    }
  }
}

}  // namespace hysteron
