// Lists of processors as the kernel writes them in /sys and /proc.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::tool {

/// Of a list of processors as the kernel writes it, "0-2,5": 0, 1, 2, 5. Nothing where it is none.
[[nodiscard]] std::optional<std::vector<unsigned>> parse_processors(std::string_view text);

/// 0-2,5
[[nodiscard]] std::string processors_text(const std::vector<unsigned>& processors);

}  // namespace hysteron::tool
