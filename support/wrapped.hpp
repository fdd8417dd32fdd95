// Text broken to the width of a terminal.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace hysteron {

/// How many characters a line of the stream may have: what COLUMNS says, else the terminal; 0 where it is none.
[[nodiscard]] std::size_t terminal_width(std::FILE* stream);

/// The text with its long lines broken at blanks. What follows of a line stands below its first word; of a line of two
/// columns, `  --out FILE   The result.`, below the second. Where that leaves no room for words, the second column
/// stands below the first, and what is indented so far stands further out. A table, which has more columns, a line of a
/// source that an error shows, a command to be copied (`$ …`) and a word that is longer than the width stay as they
/// are. Colours count no characters. 0 breaks nothing.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t width);

}  // namespace hysteron
