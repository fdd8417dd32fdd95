// The program dot of Graphviz, from the path or as the environment variable GRAPHVIZ_DOT names it.
#pragma once

#include <string>

namespace hysteron::tool {

/// What dot makes of a text in a format: svg, png, plain. `without` says which option needs no Graphviz. Throws
/// InputError: HY740 where there is no dot, HY741 where it fails.
[[nodiscard]] std::string drawn_by_graphviz(const std::string& text, const std::string& format,
                                            const std::string& without);

}  // namespace hysteron::tool
