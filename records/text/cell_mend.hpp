// What to write instead of a cell that is no number.
#pragma once

#include <string>
#include <string_view>

namespace hysteron::records {

/// Of one word in a column of numbers: the number that it is in decimal digits where it is hexadecimal, the negative
/// number of (1.5), the number alone of 1.5V, [1.5] and np.float64(1.5).
[[nodiscard]] std::string mend_of_word(std::string_view word);

/// Of a column of words, which begins with this one: the same where a number stands in it; else another column.
[[nodiscard]] std::string mend_of_words(std::string_view first);

}  // namespace hysteron::records
