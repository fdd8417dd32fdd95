// The pages of the errors, docs/errors, as the tool carries them.
#pragma once

#include <span>
#include <string_view>

namespace hysteron::tool {

struct ErrorPage {
  int number = 0;
  std::string_view text{};  ///< Markdown
};

/// By number. Written at build time by embed_error_pages.cmake.
[[nodiscard]] std::span<const ErrorPage> error_pages();

}  // namespace hysteron::tool
