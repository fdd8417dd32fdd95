// What to write instead of a cell that is no number.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hysteron::records {

/// The number that a word is in decimal digits where it is hexadecimal, the negative number of (1.5), the number alone
/// of 1.5V, [1.5] and np.float64(1.5); nothing where no number stands in it.
[[nodiscard]] std::optional<std::string> mend_by_number(std::string_view word);

}  // namespace hysteron::records
