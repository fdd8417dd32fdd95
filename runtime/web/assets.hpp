// The files of the live page, built into the program: it needs no folder beside it and no host but its own.
#pragma once

#include <span>
#include <string_view>

namespace hysteron::runtime::web {

struct Asset {
  std::string_view target;  ///< of the request: /page.js
  std::string_view type;
  std::string_view text;
};

/// From runtime/web/page, and dygraphs as Debian's package has it; written by embed_assets.cmake.
[[nodiscard]] std::span<const Asset> assets();

}  // namespace hysteron::runtime::web
