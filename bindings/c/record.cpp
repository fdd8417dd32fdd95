#include "bindings/c/record.hpp"

#include <fmt/format.h>

#include <utility>

#include "codegen/graph/port_t.hpp"
#include "records/column_table.hpp"
#include "records/read.hpp"
#include "support/errors.hpp"
#include "support/overwriting.hpp"
#include "tuning/record_units.hpp"
#include "tuning/recorded_run.hpp"

using hysteron::Diagnostics;
using hysteron::InputError;
using hysteron::bindings::Call;
using hysteron::bindings::Options;
using hysteron::bindings::require;
namespace records = hysteron::records;

namespace {

/// What arrays are called in messages.
constexpr const char* memory_record = "arrays";

const records::Column* column_at(const hysteron_record* record, size_t column) {
  return record != nullptr && column < record->record.columns().size() ? &record->record.columns()[column] : nullptr;
}

std::vector<records::NumberColumn> columns_of(size_t columns, size_t rows, const char* const* names,
                                              const char* const* units, const double* values) {
  std::vector<records::NumberColumn> result(columns);
  for (size_t i = 0; i < columns; ++i) {
    require(names[i], fmt::format("The name of column {}", i + 1));
    result[i].name = names[i];
    result[i].unit = units != nullptr && units[i] != nullptr ? units[i] : "";
    if (rows > 0) {
      result[i].values.assign(values + i * rows, values + (i + 1) * rows);
    }
  }
  return result;
}

}  // namespace

namespace hysteron::bindings {

std::vector<records::Record> in_units_of(const hysteron_diagram& diagram, const hysteron_record* const* records,
                                         std::size_t count, bool tell_unused, Diagnostics& diagnostics, Call& call) {
  if (count == 0) {
    throw InputError(error::bad_usage, {}, "There is no record.", "give one or more.");
  }
  require(records, "The list of records");
  std::vector<records::Record> result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    require(records[i], fmt::format("Record {}", i + 1));
    for (std::size_t k = 0; k < i; ++k) {
      const std::string& file = records[i]->record.file();
      if (records[k] == records[i] || (file != memory_record && same_file(records[k]->record.file(), file))) {
        throw InputError(error::bad_usage, {.file = file}, fmt::format("Records {} and {} are the same.", k + 1, i + 1),
                         "give each record once: repeated, it would count as a second measurement.");
      }
    }
    result.push_back(records[i]->record);
    const auto read = static_cast<std::ptrdiff_t>(result.back().notes().size());  // said when it was read
    convert_units(result.back(), diagram.program, diagnostics);
    const auto notes = what_was_read(result.back(), diagram.program, tell_unused,
                                     diagram.file.goal.wished ? diagram.file.goal.wished->text : std::string());
    call.note(result.back().file(), {notes.begin() + read, notes.end()});
  }
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  return result;
}

}  // namespace hysteron::bindings

extern "C" {

hysteron_record* hysteron_record_read(const char* path, const hysteron_diagram* diagram, const char* options,
                                      hysteron_messages** messages) {
  Call call(messages);
  return call([&]() -> hysteron_record* {
    require(path, "The path of the record");
    Options given(options);
    const records::ReadOptions how = hysteron::bindings::read_options_of(given, diagram);
    given.finish();
    records::Record record = records::read_record(path, how);
    call.note(record.file(), record.notes());
    return new hysteron_record{std::move(record)};
  });
}

hysteron_record* hysteron_record_new(size_t columns, size_t rows, const char* const* names, const char* const* units,
                                     const double* values, const hysteron_diagram* diagram, const char* options,
                                     hysteron_messages** messages) {
  Call call(messages);
  return call([&]() -> hysteron_record* {
    require(names, "The list of names");
    require(values, "The array of values");
    Options given(options);
    const records::ReadOptions how = hysteron::bindings::read_options_of(given, diagram);
    given.finish();
    const auto list = columns_of(columns, rows, names, units, values);
    records::Record record = records::read_table(
        memory_record,
        [&](const records::ReadOptions& narrowed) { return records::table_of(memory_record, list, narrowed); }, how);
    call.note(record.file(), record.notes());
    return new hysteron_record{std::move(record)};
  });
}

size_t hysteron_record_rows(const hysteron_record* record) {
  return record != nullptr ? record->record.size() : 0;
}

double hysteron_record_sample_time(const hysteron_record* record) {
  return record != nullptr ? record->record.sample_time() : 0.0;
}

const double* hysteron_record_time(const hysteron_record* record) {
  return record != nullptr ? record->record.time().data() : nullptr;
}

const char* hysteron_record_time_name(const hysteron_record* record) {
  return record != nullptr ? record->record.time_heading().data() : nullptr;
}

size_t hysteron_record_columns(const hysteron_record* record) {
  return record != nullptr ? record->record.columns().size() : 0;
}

const char* hysteron_record_name(const hysteron_record* record, size_t column) {
  const records::Column* const found = column_at(record, column);
  return found != nullptr ? found->name.c_str() : nullptr;
}

const char* hysteron_record_unit(const hysteron_record* record, size_t column) {
  const records::Column* const found = column_at(record, column);
  return found != nullptr ? found->unit.c_str() : nullptr;
}

const double* hysteron_record_values(const hysteron_record* record, size_t column) {
  const records::Column* const found = column_at(record, column);
  return found != nullptr ? found->values.data() : nullptr;
}

void hysteron_record_free(hysteron_record* record) {
  delete record;
}

hysteron_record* hysteron_run(const hysteron_diagram* diagram, const hysteron_record* record, const char* options,
                              hysteron_messages** messages) {
  Call call(messages);
  return call([&]() -> hysteron_record* {
    require(diagram, "The diagram");
    require(record, "The record");
    Options given(options);
    const hysteron::RunRequest request{.traces = given.texts("traces"), .float32 = given.flag("float32")};
    given.finish();
    Diagnostics diagnostics = diagram->warnings;
    records::Record input = record->record;
    const std::size_t read = input.notes().size();
    hysteron::RecordedRun run = hysteron::run_over(diagram->program, input, request, diagnostics);
    std::vector<records::Column> columns;
    for (std::size_t i = 0; i < run.names.size(); ++i) {
      columns.push_back({.name = run.names[i], .unit = run.units[i], .values = std::move(run.values[i])});
    }
    const std::vector<double> time(input.time().begin(), input.time().end());
    auto result = std::make_unique<hysteron_record>(
        hysteron_record{records::Record(time, input.sample_time(), std::move(columns), {})});
    result->record.set_beside_t(hysteron::port_called_t(run.program.graph) != nullptr);
    const auto notes = hysteron::what_was_read(input, run.program, true);
    call.warn(diagnostics);
    // What was understood when the record was read has been said then.
    call.note(input.file(), {notes.begin() + static_cast<std::ptrdiff_t>(read), notes.end()});
    return result.release();
  });
}

}  // extern "C"
