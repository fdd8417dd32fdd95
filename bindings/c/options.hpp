// Options across the border: an object of JSON, of which every key is asked for, or refused.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hysteron::bindings {

class Options {
 public:
  /// NULL is an object without keys. Throws InputError HY730 where the text is no object of JSON.
  explicit Options(const char* text);

  // Each throws InputError HY730 where the key holds something else.
  [[nodiscard]] std::string text(std::string_view key);  ///< a number as its text; empty where there is none
  [[nodiscard]] bool flag(std::string_view key);         ///< false where there is none
  [[nodiscard]] std::optional<double> number(std::string_view key);
  [[nodiscard]] std::optional<long long> whole(std::string_view key, long long least, long long most);
  [[nodiscard]] std::vector<std::string> texts(std::string_view key);
  [[nodiscard]] std::vector<std::pair<std::string, nlohmann::json>> members(std::string_view key);
  /// The same, where a text alone is a member without a name.
  [[nodiscard]] std::vector<std::pair<std::string, nlohmann::json>> members_or_text(std::string_view key);

  /// Throws InputError HY730 for a key that was not asked for.
  void finish() const;

 private:
  [[nodiscard]] const nlohmann::json* find(std::string_view key);

  nlohmann::json object_{};
  std::vector<std::string> known_{};
};

}  // namespace hysteron::bindings
