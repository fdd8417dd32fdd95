// TOML with errors in the house's form. Only the files of this folder see the library.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "support/diagnostic.hpp"

namespace hysteron::parameters {

/// Throws InputError HY601 (no TOML) or HY602 (a key given twice).
[[nodiscard]] toml::table parse_toml(const std::string& file, std::string_view text);

[[nodiscard]] Place place_of(const std::string& file, const toml::source_region& region);

}  // namespace hysteron::parameters
