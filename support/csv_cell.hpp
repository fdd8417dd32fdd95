// A text as a cell of CSV.
#pragma once

#include <string>
#include <string_view>

namespace hysteron {

/// The text, in quotation marks where it has a comma, a quotation mark or a line break (RFC 4180).
[[nodiscard]] std::string csv_cell(std::string_view text);

}  // namespace hysteron
