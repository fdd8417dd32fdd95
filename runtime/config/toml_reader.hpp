// Reading TOML into the house's errors: every key is known and read once, every value of its type and range, or there
// is an error with its place. Only the files of this folder see the library.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/config/run_keys.hpp"
#include "support/diagnostic.hpp"
#include "support/toml_text.hpp"

namespace hysteron::runtime {

/// One table of the file. What is asked for and not there leaves the value as it was. Ranges and words of a choice are
/// those that the key is declared with.
class TomlReader {
 public:
  /// Reports every key that is not among `known`.
  TomlReader(const std::string& file, std::string name, const toml::table& table, std::span<const RunKey> known,
             Diagnostics& diagnostics);

  void read(std::string_view key, bool& into);
  void read(std::string_view key, std::string& into);
  /// `example`: a list as the file would have it, for the mend.
  void read(std::string_view key, std::vector<std::string>& into, const char* example);
  void read(std::string_view key, double& into);
  void read_duration(std::string_view key, std::int64_t& into);
  void read_duration(std::string_view key, std::chrono::nanoseconds& into);
  /// Rounded up.
  void read_duration(std::string_view key, std::chrono::milliseconds& into);
  /// Within bounds that the key's declaration cannot know.
  void read_duration(std::string_view key, std::int64_t& into, std::int64_t low, std::int64_t high);
  /// The index of the word that stands there.
  void read_choice(std::string_view key, std::size_t& into);
  template <class Integer>
  void read_whole(std::string_view key, Integer& into) {
    if (const auto value = whole(key)) {
      into = static_cast<Integer>(*value);
    }
  }

  /// An error where the table does not have the key; `example` is a value as it may stand there.
  void require(const std::string& key, const std::string& example);
  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
  [[nodiscard]] bool is_whole(std::string_view key) const { return has(key) && table_->get(key)->is_integer(); }
  /// Of a value; of the table where the key is not there.
  [[nodiscard]] Place place(std::string_view key) const;
  /// Of an element of a list; of the list where it has none such.
  [[nodiscard]] Place place(std::string_view key, std::size_t element) const;
  [[nodiscard]] Place place() const { return place_of(*file_, table_->source()); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[nodiscard]] const RunKey& declared(std::string_view key) const;
  std::optional<std::int64_t> whole(std::string_view key);
  void wrong_type(std::string_view key, const std::string& wanted, const std::string& example);
  void wrong_time(std::string_view key, const toml::node& node, std::int64_t low, std::int64_t high);
  void out_of_range(std::string_view key, const std::string& range);

  const std::string* file_;
  std::string name_;
  const toml::table* table_;
  std::span<const RunKey> known_;
  Diagnostics* diagnostics_;
};

}  // namespace hysteron::runtime
