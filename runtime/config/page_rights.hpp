// The rights of the live page by their names, as [web] in a run file gives them and the page is told of them.
#pragma once

#include <array>
#include <string_view>

#include "runtime/point.hpp"

namespace hysteron::runtime {

struct PageRight {
  std::string_view name{};
  bool PageRights::*is_given = nullptr;
};

inline constexpr std::array page_rights{PageRight{"parameters", &PageRights::parameters},
                                        PageRight{"reset", &PageRights::reset}, PageRight{"force", &PageRights::force}};

}  // namespace hysteron::runtime
