// Text that stands in HTML, SVG and XML.
#pragma once

#include <string>
#include <string_view>

namespace hysteron {

/// The text with &, <, > and both quotes escaped: for content and for attributes.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace hysteron
