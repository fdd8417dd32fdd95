// Which reader takes a file: one line for each format.
#pragma once

#include <string>
#include <string_view>

#include "records/read_options.hpp"
#include "records/table.hpp"

namespace hysteron::records {

struct Format {
  std::string_view name{};
  /// Whether the bytes are of this format; the ending of the file's name, in small letters, is asked only where
  /// several formats begin alike.
  bool (*is_it)(std::string_view bytes, std::string_view ending) = nullptr;
  /// Null where it is not read.
  Table (*read)(const std::string& file, std::string bytes, const ReadOptions& options) = nullptr;
  std::string_view mend{};  ///< how to come to a format that is read
};

/// The first that fits; text is the last and fits always.
[[nodiscard]] const Format& format_of(const std::string& file, std::string_view bytes);

}  // namespace hysteron::records
