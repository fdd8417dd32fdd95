#include "support/render.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "support/byte_order_mark.hpp"
#include "support/counted.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "support/utf8.hpp"

namespace hysteron {
namespace {

constexpr std::string_view ellipsis = "…";

struct Palette {
  std::string_view error, warning, quiet, strong, end;
};
constexpr Palette plain{};
constexpr Palette coloured{
    .error = "\033[1;31m", .warning = "\033[1;33m", .quiet = "\033[2m", .strong = "\033[1m", .end = "\033[0m"};

std::string_view word(Severity severity) {
  return severity == Severity::Error ? "error" : "warning";
}

std::string where(const Place& place) {
  std::string text = printable(place.file);
  if (place.line > 0) {
    text += fmt::format("{}{}", text.empty() ? "" : ":", place.line);
    if (place.column > 0) {
      text += fmt::format(":{}", place.column);
    }
  }
  return text.empty() ? text : text + ": ";
}

std::vector<std::string_view> characters(std::string_view text) {
  std::vector<std::string_view> result;
  while (!text.empty()) {
    result.push_back(text.substr(0, utf8_length(text)));
    text.remove_prefix(result.back().size());
  }
  return result;
}

/// The source line with its number, and below it the carets. Of a long line, the stretch round the carets.
std::string excerpt(const Place& place, Sources& sources, const RenderOptions& options, const Palette& palette,
                    std::string_view caret_colour) {
  const auto source = sources.line(place.file, place.line);
  if (!source) {
    return {};
  }
  const std::string safe = printable(*source);
  const auto line = characters(safe);
  const std::size_t column = std::min<std::size_t>(place.column > 0 ? place.column - 1 : 0, line.size());
  const std::size_t length = std::max<std::size_t>(1, std::min<std::size_t>(place.length, line.size() - column));

  std::size_t begin = 0;
  std::size_t end = line.size();
  if (line.size() > options.width) {
    const std::size_t lead = options.width / 3;
    begin = std::min(column - std::min(column, lead), line.size() - options.width);
    end = begin + options.width;
  }
  std::string text(begin > 0 ? ellipsis : "");
  std::string carets(begin > 0 ? " " : "");
  for (std::size_t i = begin; i < end; ++i) {
    text += line[i];
    if (i < column) {
      carets += line[i] == "\t" ? '\t' : ' ';  // a tab below a tab, whatever its width
    }
  }
  text += end < line.size() ? ellipsis : "";
  const std::size_t shown = std::min(length, std::max<std::size_t>(1, end - std::min(end, column)));
  const std::string number = fmt::format("{:>5} | ", place.line);
  std::string result = fmt::format("{}{}{}{}\n", palette.quiet, number, palette.end, text);
  if (place.column > 0) {
    result += fmt::format("{}{}| {}{}{}{}{}\n", palette.quiet, std::string(number.size() - 2, ' '), palette.end, carets,
                          caret_colour, std::string(shown, '^'), palette.end);
  }
  return result;
}

/// Loggers of Windows write µ and ° as one byte: what is no UTF-8 is shown as the reader of records takes it.
std::string from_latin_1(std::string_view bytes) {
  constexpr unsigned first_shown = 0xA0;  // below it are controls
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= first_shown) {
      text += static_cast<char>(0xC0U | (byte >> 6U));
      text += static_cast<char>(0x80U | (byte & 0x3FU));
    } else {
      text += c;
    }
  }
  return text;
}

nlohmann::json place_as_json(const Place& place) {
  nlohmann::json result = {{"file", printable(place.file)}};
  if (place.line > 0) {
    result["line"] = place.line;
    if (place.column > 0) {
      result["column"] = place.column;
      result["length"] = place.length;
    }
  }
  return result;
}

}  // namespace

Sources::Lines::Lines(std::string whole)
    : text(first_invalid_utf8(whole) == std::string_view::npos ? std::move(whole) : from_latin_1(whole)) {
  starts.push_back(text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', end + 1)) {
    starts.push_back(end + 1);
  }
}

std::optional<std::string_view> Sources::line(const std::string& file, std::uint32_t number) {
  if (file.empty() || number == 0) {
    return std::nullopt;
  }
  auto found = texts_.find(file);
  if (found == texts_.end()) {
    Lines lines;
    try {
      // A pipe was read once, and whoever wrote it has gone: it is not waited for again.
      if (std::error_code unknown; std::filesystem::is_regular_file(file, unknown)) {
        lines = Lines(read_text_file(file));
      }
    } catch (const InputError&) {
      // The diagnostic is shown without its line: it may have been about a text that has gone since.
    }
    found = texts_.emplace(file, std::move(lines)).first;
  }
  const Lines& lines = found->second;
  if (number > lines.starts.size()) {
    return std::nullopt;
  }
  std::string_view line = std::string_view(lines.text).substr(lines.starts[number - 1]);
  line = line.substr(0, line.find('\n'));
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

std::string as_text(const Diagnostic& diagnostic, Sources& sources, const RenderOptions& options) {
  const Palette& palette = options.colour ? coloured : plain;
  const auto colour = diagnostic.severity == Severity::Error ? palette.error : palette.warning;
  std::string text =
      fmt::format("{}HY{:03} {}{}: {}{}{}{}\n", colour, diagnostic.number, word(diagnostic.severity), palette.end,
                  where(diagnostic.place), palette.strong, printable(diagnostic.cause), palette.end);
  text += excerpt(diagnostic.place, sources, options, palette, colour);
  if (!diagnostic.mend.empty()) {
    text += fmt::format("mend: {}\n", printable(diagnostic.mend));
  }
  for (const Note& note : diagnostic.notes) {
    text += fmt::format("note: {}{}\n", where(note.place), printable(note.text));
    text += excerpt(note.place, sources, options, palette, palette.strong);
  }
  return text;
}

std::string as_text(const Diagnostics& diagnostics, Sources& sources, const RenderOptions& options) {
  std::string text;
  std::size_t errors = 0;
  std::size_t warnings = 0;
  std::map<int, std::size_t> by_number;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    if (++by_number[diagnostic.number] <= options.alike) {
      text += as_text(diagnostic, sources, options) + "\n";
    }
    ++(diagnostic.severity == Severity::Error ? errors : warnings);
  }
  for (const auto& [number, count] : by_number) {
    if (count > options.alike) {
      text += fmt::format("HY{:03}: {} more like these; the first {} are shown.\n\n", number, count - options.alike,
                          options.alike);
    }
  }
  if (errors > 0) {
    text += counted(errors, "error") + (warnings > 0 ? ", " : "\n");
  }
  if (warnings > 0) {
    text += counted(warnings, "warning") + "\n";
  }
  return text;
}

nlohmann::json as_json(const Diagnostics& diagnostics) {
  auto list = nlohmann::json::array();
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    auto entry = place_as_json(diagnostic.place);
    entry["number"] = fmt::format("HY{:03}", diagnostic.number);
    entry["title"] = title_of(diagnostic.number);
    entry["severity"] = word(diagnostic.severity);
    entry["cause"] = printable(diagnostic.cause);
    entry["mend"] = printable(diagnostic.mend);
    entry["page"] = fmt::format("docs/errors/HY{:03}.md", diagnostic.number);
    entry["notes"] = nlohmann::json::array();
    for (const Note& note : diagnostic.notes) {
      auto noted = place_as_json(note.place);
      noted["text"] = printable(note.text);
      entry["notes"].push_back(std::move(noted));
    }
    list.push_back(std::move(entry));
  }
  return list;
}

std::string_view title_of(int number) {
  for (const auto& entry : error_titles()) {
    if (entry.number == number) {
      return entry.title;
    }
  }
  return {};
}

bool wants_colour(std::FILE* stream) {
  const char* const no_colour = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  const bool able = terminal != nullptr && std::string_view(terminal) != "dumb";
  return able && (no_colour == nullptr || *no_colour == '\0') && isatty(fileno(stream)) == 1;
}

}  // namespace hysteron
