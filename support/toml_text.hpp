// TOML with errors in the house's form: parameter files, test files and run files are all read through here.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "support/diagnostic.hpp"

namespace hysteron {

/// What the errors of one kind of file are.
struct TomlKind {
  int no_toml = 0;    ///< number of the error for what is no TOML
  int key_twice = 0;  ///< number of the error for a key or table given twice
  /// How a table and a value of such a file look: "a table as [outputs.U] and a value as safe = 0.0".
  std::string_view looks{};
};

/// Throws InputError with the kind's numbers.
[[nodiscard]] toml::table parse_toml(const std::string& file, std::string_view text, const TomlKind& kind);

/// What a value is, for messages: "a table", "a whole number".
[[nodiscard]] std::string_view toml_kind(const toml::node& node);

[[nodiscard]] Place place_of(const std::string& file, const toml::source_region& region);

}  // namespace hysteron
