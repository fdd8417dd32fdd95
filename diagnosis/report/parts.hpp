// The style and the script of the report, beside those of every page.
#pragma once

#include <string_view>

namespace hysteron::diagnosis::report {

[[nodiscard]] std::string_view style();
/// What is drawn where; needs the scripts of plots/page.hpp before it.
[[nodiscard]] std::string_view page_script();

}  // namespace hysteron::diagnosis::report
