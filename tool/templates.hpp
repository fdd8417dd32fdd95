// The folders that `hysteron new` makes, as the tool carries them: tool/templates.
#pragma once

#include <span>
#include <string_view>

namespace hysteron::tool {

struct TemplateFile {
  std::string_view folder{};  ///< the name of the template: piezo, servo …
  std::string_view name{};
  std::string_view text{};
};

/// Sorted by folder and name. Written at build time by embed_templates.cmake.
[[nodiscard]] std::span<const TemplateFile> template_files();

}  // namespace hysteron::tool
