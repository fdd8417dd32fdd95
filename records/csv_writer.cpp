#include "records/csv.hpp"
#include "records/text/csv_line.hpp"
#include "support/atomic_file.hpp"
#include "support/numbers.hpp"

namespace hysteron::records {
namespace {

/// A header cell; in quotes where a separator, a comment mark or a blank at its ends would be taken for something else.
std::string header_cell(const Column& column) {
  // Empty brackets say that what ends the name is no unit: "level mV".
  const HeaderName read = split_header(column.name);
  const bool clear = read.name == column.name && read.unit.empty();
  const std::string text = column.unit.empty() && clear ? column.name : column.name + " [" + column.unit + "]";
  const bool plain = text.find_first_of(",;\t\"#") == std::string::npos;
  return plain ? text : '"' + text + '"';
}

}  // namespace

std::string csv_text(const Record& record) {
  std::string text(record.time_heading());
  for (const Column& column : record.columns()) {
    text += ',' + header_cell(column);
  }
  text += '\n';
  text.reserve(text.size() + record.size() * (record.columns().size() + 1) * 12);
  for (std::size_t row = 0; row < record.size(); ++row) {
    text += number_text(record.time()[row]);
    for (const Column& column : record.columns()) {
      text += ',';
      text += number_text(column.values[row]);
    }
    text += '\n';
  }
  return text;
}

void write_csv(const std::filesystem::path& path, const Record& record) {
  write_file_atomically(path, csv_text(record));
}

}  // namespace hysteron::records
