// A record from a file, in whatever dress a tool of the field has written it.
#pragma once

#include <functional>
#include <string>

#include "records/read_options.hpp"
#include "records/record.hpp"
#include "records/table.hpp"

namespace hysteron::records {

/// Reads a file; its format is found by its first bytes (formats.hpp). Throws InputError: HY100 where it cannot be
/// read, HY501 to HY514 where it is no record, or one that could be read in two ways.
[[nodiscard]] Record read_record(const std::string& path, const ReadOptions& options = {});

/// The same from the bytes of a file; `file` stands in the places of errors.
[[nodiscard]] Record parse_record(const std::string& file, std::string bytes, const ReadOptions& options = {});

/// The same from a table, that of columns at hand (column_table.hpp), say. A range of times is read a second time, with
/// its rows alone.
using TableReader = std::function<Table(const ReadOptions& options)>;
[[nodiscard]] Record read_table(const std::string& file, const TableReader& read, const ReadOptions& options);

}  // namespace hysteron::records
