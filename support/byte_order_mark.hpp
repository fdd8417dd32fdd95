// The mark that some editors put before a text in UTF-8. It is no part of the text.
#pragma once

#include <string_view>

namespace hysteron {

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

}  // namespace hysteron
