// The style and the scripts of the report, as they stand in the page.
#pragma once

#include <string_view>

namespace hysteron::diagnosis::report {

[[nodiscard]] std::string_view style();
/// Axes, lines, legends, zoom.
[[nodiscard]] std::string_view plot_script();
/// What is drawn where; needs the plot script before it.
[[nodiscard]] std::string_view page_script();

}  // namespace hysteron::diagnosis::report
