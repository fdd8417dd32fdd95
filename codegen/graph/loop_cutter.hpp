// The block that cuts a loop, as mends name it.
#pragma once

#include <string_view>

#include "blocks/delay.hpp"

namespace hysteron {

inline constexpr std::string_view loop_cutter = Delay::about.name;

}  // namespace hysteron
