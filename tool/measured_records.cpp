#include "tool/measured_records.hpp"

#include <fmt/format.h>

#include "records/csv.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/overwriting.hpp"

namespace hysteron::tool {

std::vector<records::Record> read_measured_records(const std::vector<std::string>& logs) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (same_file(logs[k], logs[i])) {
        throw InputError(error::bad_usage, {.file = logs[i]},
                         logs[k] == logs[i] ? fmt::format("--log names the record {} twice.", logs[i])
                                            : fmt::format("--log names one record as {} and as {}.", logs[k], logs[i]),
                         "give each record once: repeated, it would count as a second measurement.");
      }
    }
  }
  std::vector<records::Record> records;
  records.reserve(logs.size());
  for (const std::string& log : logs) {
    records.push_back(records::read_csv(log));
  }
  return records;
}

}  // namespace hysteron::tool
