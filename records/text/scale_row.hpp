// Rows of a head that state a factor or an offset by column. Whether the numbers have it in them already, no file says:
// they are taken as they stand, and that is said.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hysteron::records {

/// scale, gain, offset and the like.
[[nodiscard]] bool is_key_of_scale(std::string_view key);

/// What is said of a cell of the row `key`, which stands for a column; nothing where the key is none of these, or the
/// cell changes nothing.
[[nodiscard]] std::optional<std::string> note_of_scale(std::string_view key, std::string_view cell,
                                                       std::string_view column);

}  // namespace hysteron::records
