// The sources that a generated host is built from, as the tool carries them: an installed tool has no source tree.
#pragma once

#include <span>
#include <string_view>

namespace hysteron::tool {

struct EmbeddedSource {
  std::string_view path;  ///< runtime/host/host.cpp
  std::string_view text;
};

/// By path. What they are, embed_sources.cmake derives from the sources of the runtime at build time.
[[nodiscard]] std::span<const EmbeddedSource> host_sources();
/// What a host with the live page needs besides; without the page's own files, which are runtime::web::assets().
[[nodiscard]] std::span<const EmbeddedSource> page_sources();

}  // namespace hysteron::tool
