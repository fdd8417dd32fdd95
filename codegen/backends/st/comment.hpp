// Comments of Structured Text: ASCII, which every compiler reads, and never ended by the user's own words.
#pragma once

#include <string>
#include <string_view>

namespace hysteron {

/// A text in which no comment begins or ends, with the usual signs of units spelled in ASCII.
std::string st_comment(std::string_view text);

/// What stands beside a variable: its unit, its range and its meaning.
std::string st_remark(std::string_view unit, double minimum, double maximum, bool above_minimum,
                      std::string_view meaning);

}  // namespace hysteron
