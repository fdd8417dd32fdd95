// The version of the tool, as the build states it.
#pragma once

#include <string_view>

namespace hysteron::tool {

inline constexpr std::string_view version = HYSTERON_VERSION;

}  // namespace hysteron::tool
