// Which names a parameter file may hold: paths into a diagram, and columns of records.
#pragma once

#include <algorithm>
#include <string_view>

#include "support/element_name.hpp"

namespace hysteron::parameters {

/// INV.C1: letters, digits and underscores, in parts between single points.
inline bool is_path(std::string_view key) {
  if (const auto element = element_of(key); element && element->index >= 0) {  // "Y[2]": the element of a vector
    key = element->vector;
  }
  const bool letters = std::ranges::all_of(key, [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  });
  return letters && !key.empty() && key.front() != '.' && key.back() != '.' && key.find("..") == std::string_view::npos;
}

/// What the header of a record may hold.
inline bool is_column(std::string_view name) {
  return !name.empty() &&
         std::ranges::all_of(name, [](char c) { return c != '"' && c != '\\' && !(c >= 0 && c < ' ') && c != '\x7F'; });
}

}  // namespace hysteron::parameters
