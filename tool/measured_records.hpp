// The measured records that a fit or a diagnosis is made from.
#pragma once

#include <string>
#include <vector>

#include "records/record.hpp"

namespace hysteron::tool {

/// Reads them. Throws InputError HY730 where two are the same file, under whatever names: a repeated record would count
/// as a second measurement, and shrink the standard errors of what is fitted; else as records::read_csv does.
[[nodiscard]] std::vector<records::Record> read_measured_records(const std::vector<std::string>& logs);

}  // namespace hysteron::tool
