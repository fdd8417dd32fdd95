// What the readers of a parameter file's tables share: keys that are known, numbers, names, and what is said of others.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::parameters {

class SettingsReader {
 public:
  /// `file` stands in the places of errors, which go to `diagnostics`: both outlive the reader.
  SettingsReader(const std::string& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

 protected:
  [[nodiscard]] Place at(const toml::node& node) const;
  [[nodiscard]] Place at(const toml::key& key) const;
  void wrong_type(const toml::key& key, const toml::node& node, std::string_view wanted, std::string_view example);
  void wrong_element(const toml::key& key, const toml::node& element, std::string_view wanted,
                     std::string_view example);
  void no_name(const toml::key& key, const toml::node& node, std::string_view text, std::string_view example);
  void contradiction(const Place& place, std::string cause, std::string mend);

  /// Whether a key is among those known of a table; HY603 where not. An empty name: the whole file.
  bool known_key(const toml::key& key, const toml::node& node, std::span<const std::string_view> known,
                 std::string_view table);
  const toml::table* as_table(const toml::key& key, const toml::node& node);

  /// A number, whole or not, that may be infinite.
  std::optional<PlacedNumber> number_of(const toml::key& key, const toml::node& node);
  void not_finite(const toml::key& key, const PlacedNumber& number, std::string_view mend);
  std::optional<PlacedNumber> finite(const toml::key& key, const toml::node& node);

  /// A name, or a list of names of which none stands there twice.
  std::optional<PlacedText> name_of(const toml::key& key, const toml::node& node, std::string_view example,
                                    bool (*is_name)(std::string_view));
  std::vector<PlacedText> names_of(const toml::key& key, const toml::node& node, std::string_view example,
                                   bool (*is_name)(std::string_view));
  /// The place of one of a few words in their list.
  std::optional<std::size_t> word_of(const toml::key& key, const toml::node& node,
                                     std::span<const std::string_view> words);

  const std::string& file_;
  Diagnostics& diagnostics_;
};

}  // namespace hysteron::parameters
