// The units of a record's columns as those of the diagram's ports.
#pragma once

#include <string>

#include "codegen/compile.hpp"
#include "records/record.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// Converts each column that a port of the diagram is named after to the port's unit, where both state one, and notes
/// it in the record. Adds HY729, as an error where the units are of different dimensions, as a warning where the
/// column's is not known: its numbers are taken as they are.
void convert_units(records::Record& record, const Program& program, Diagnostics& diagnostics);

/// The same of a column of another name that is held against a port: the wished course of an output.
void convert_unit(records::Record& record, const std::string& column, const Port& port, const Graph& graph,
                  Diagnostics& diagnostics);

}  // namespace hysteron
