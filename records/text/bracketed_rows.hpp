// Rows in brackets, as programs print lists: [0.001, 1.5, 2.5] and (0.001, 1.5, 2.5).
#pragma once

#include <string>

namespace hysteron::records {

/// Blanks in the place of the brackets, where each of the first lines stands in them; whether it does.
bool clear_brackets(std::string& text);

}  // namespace hysteron::records
