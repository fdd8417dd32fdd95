// Diagnostics for people (text with the source line and a caret) and for programs (JSON).
//
//   HY202 error: plant.st:9:8: HY_GAIN has no pin XNI.
//      9 |   AMP(XNI := U);
//        |       ^^^
//   mend: did you mean XIN?
//
// Columns count characters, not bytes; the caret stays below its character beside tabs and beyond ASCII.
#pragma once

#include <cstddef>
#include <cstdio>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.hpp"

namespace hysteron {

/// The texts that diagnostics point into, by file name. Files are read when first asked for; a text that is at hand
/// already, or stands in no file, can be put in.
class Sources {
 public:
  void put(const std::string& file, std::string_view text) { texts_[file] = Lines(std::string(text)); }

  /// A line of a file, without its end; nothing where there is no such file or line.
  [[nodiscard]] std::optional<std::string_view> line(const std::string& file, std::uint32_t number);

 private:
  /// A text, and where its lines begin.
  struct Lines {
    Lines() = default;
    explicit Lines(std::string whole);
    std::string text{};
    std::vector<std::size_t> starts{};  ///< empty where there is no such file
  };
  std::map<std::string, Lines, std::less<>> texts_;
};

struct RenderOptions {
  bool colour = false;
  std::size_t width = 100;  ///< characters of a source line that are shown; of a longer one, an excerpt
  std::size_t alike = 20;   ///< of one number, so many are shown; the others are counted
};

/// One diagnostic as text, each line ended.
[[nodiscard]] std::string as_text(const Diagnostic& diagnostic, Sources& sources, const RenderOptions& options = {});

/// All of them, a blank line between two, and a closing line that counts them ("2 errors, 1 warning"). Of many with one
/// number the first, and how many more there are.
[[nodiscard]] std::string as_text(const Diagnostics& diagnostics, Sources& sources, const RenderOptions& options = {});

/// A list of objects: number ("HY202"), title, severity, file, line, column, length, cause, mend, notes, page. A line
/// or column that is not known is left out.
[[nodiscard]] nlohmann::json as_json(const Diagnostics& diagnostics);

/// The title of a number, as its page has it; empty where there is no such number.
[[nodiscard]] std::string_view title_of(int number);

/// Whether a stream should be coloured: it is a terminal that can, and NO_COLOR (no-color.org) is not set.
[[nodiscard]] bool wants_colour(std::FILE* stream);

}  // namespace hysteron
