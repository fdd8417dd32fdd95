#include "support/option_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/shell_words.hpp"

namespace hysteron {
namespace {

constexpr std::array options{
    LibraryOption{"time", "time", OptionForm::Text, true},
    LibraryOption{"rate", "rate"},
    LibraryOption{"column", "columns", OptionForm::Pair},
    LibraryOption{"skip", "skip", OptionForm::Number},
    LibraryOption{"range", "range"},
    LibraryOption{"rows", "rows"},
    LibraryOption{"decimal", "decimal"},
    LibraryOption{"resample", "resample", OptionForm::TextOrPair},
    LibraryOption{"top", "top", OptionForm::Text, true},
    LibraryOption{"any-order", "any_order", OptionForm::Flag},
    LibraryOption{"float32", "float32", OptionForm::Flag},
    LibraryOption{"params", "params"},
    LibraryOption{"fmu-time-limit", "", OptionForm::None},
    LibraryOption{"trace", "traces", OptionForm::List},
    LibraryOption{"log", "records", OptionForm::Argument},
    LibraryOption{"start", "starts", OptionForm::Number},
    LibraryOption{"u", "u", OptionForm::Argument},
    LibraryOption{"y", "y", OptionForm::Argument},
    LibraryOption{"controller", "controller"},
    LibraryOption{"material", "material", OptionForm::Number},
    LibraryOption{"effects", "effects", OptionForm::List},
    LibraryOption{"ignore", "ignore", OptionForm::List},
    LibraryOption{"most", "most", OptionForm::Number},
    LibraryOption{"limit", "limits", OptionForm::Pair},
    LibraryOption{"effort", "effort", OptionForm::Number},
    LibraryOption{"time-limit", "time_limit", OptionForm::Number},
    LibraryOption{"seed", "seed", OptionForm::Number},
    LibraryOption{"explain", "explain", OptionForm::Flag},
    LibraryOption{"without", "without", OptionForm::List},
    LibraryOption{"threads", "threads", OptionForm::Number},
};

/// Signs that end a sentence or a part of one.
constexpr std::string_view marks = ",;:.?!)`";

/// Words of small letters that are values of an option wherever they stand behind it.
constexpr std::array<std::string_view, 5> small_values{"linear", "hold", "average", "point", "comma"};

bool is_small(char c) {
  return c >= 'a' && c <= 'z';
}

/// A word of a text from an offset on, without the signs that end a sentence or a part of one.
struct SentenceWord {
  std::string text{};
  std::size_t end = 0;  ///< behind it
  bool is_quoted = false;
};

SentenceWord quoted_word(std::string_view text, std::size_t begin) {
  constexpr std::string_view inner_quote = "'\\''";
  const char quote = text[begin];
  SentenceWord word{.is_quoted = true};
  std::size_t at = begin + 1;
  while (at < text.size()) {
    if (quote == '\'' && text.substr(at).starts_with(inner_quote)) {
      word.text += '\'';
      at += inner_quote.size();
    } else if (text[at] == quote) {
      word.end = at + 1;
      return word;
    } else {
      word.text += text[at++];
    }
  }
  return {.end = begin};
}

SentenceWord plain_word(std::string_view text, std::size_t begin) {
  auto end = std::min(text.find(' ', begin), text.size());
  const auto ends_a_part = [&] {
    const char last = text[end - 1];
    const std::string_view word = text.substr(begin, end - begin);
    const bool is_open_range = word.ends_with("..") && !word.ends_with("...");  // 60..
    return marks.find(last) != std::string_view::npos && !is_open_range;
  };
  while (end > begin && ends_a_part()) {
    --end;
  }
  return {.text = std::string(text.substr(begin, end - begin)), .end = end};
}

/// The value behind an option that ends at an offset; with the same end where there is none.
SentenceWord value_behind(const LibraryOption& option, std::string_view text, std::size_t end) {
  if (option.form == OptionForm::Flag || option.form == OptionForm::None || end + 1 >= text.size() ||
      text[end] != ' ') {
    return {.end = end};
  }
  const bool is_quoted = text[end + 1] == '\'' || text[end + 1] == '"';
  SentenceWord word = is_quoted ? quoted_word(text, end + 1) : plain_word(text, end + 1);
  const bool is_prose =
      std::ranges::all_of(word.text, is_small) && !option.any_value && !is_one_of(word.text, std::span(small_values));
  const bool is_value = !word.text.empty() && (word.is_quoted || !is_prose) &&
                        (option.form != OptionForm::Pair || word.text.find('=') != std::string::npos);
  return is_value ? word : SentenceWord{.end = end};
}

/// As both languages write it.
std::string literal(std::string_view text, OptionForm form) {
  const bool is_number = form != OptionForm::Text && parse_number(text).status == NumberStatus::Finite;
  if (is_number) {
    return std::string(text);
  }
  std::string result = "\"";
  for (const char c : text) {
    result += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  }
  return result + '"';
}

std::string value_text(const LibraryOption& option, const std::string& value, Caller caller) {
  switch (option.form) {
    case OptionForm::Flag:
      return caller == Caller::Python ? "True" : "true";
    case OptionForm::TextOrPair:
      if (value.find('=') == std::string::npos) {
        return literal(value, OptionForm::Text);
      }
      [[fallthrough]];
    case OptionForm::Pair: {
      const auto equals = value.find('=');
      return fmt::format("{{{}: {}}}", literal(value.substr(0, equals), OptionForm::Text),
                         literal(value.substr(equals + 1), option.form));
    }
    case OptionForm::List:
      return '[' + literal(value, OptionForm::Text) + ']';
    default:
      return literal(value, option.form);
  }
}

/// The option in the caller's words, with its value where it has one.
std::string reworded(const LibraryOption& option, const std::string& value, Caller caller, bool begins_sentence) {
  if (option.form == OptionForm::None) {
    return fmt::format("{} option `--{}` of the tool", begins_sentence ? "The" : "the", option.option);
  }
  const bool is_argument = option.form == OptionForm::Argument;
  if (!value.empty() || option.form == OptionForm::Flag) {
    const std::string written = value_text(option, value, caller);
    return caller == Caller::Python ? fmt::format("{}={}", option.key, written)
           : is_argument            ? fmt::format("the argument {}, {}", option.key, written)
                                    : fmt::format("{{\"{}\": {}}}", option.key, written);
  }
  return caller == Caller::Python || is_argument
             ? fmt::format("{} argument {}", begins_sentence ? "The" : "the", option.key)
             : fmt::format("{} option \"{}\"", begins_sentence ? "The" : "the", option.key);
}

/// The option whose name stands behind `--` at an offset; null where the library has none.
const LibraryOption* option_at(std::string_view text, std::size_t name, std::size_t& end) {
  end = name;
  while (end < text.size() && (is_small(text[end]) || (std::isdigit(static_cast<unsigned char>(text[end])) != 0) ||
                               (text[end] == '-' && end + 1 < text.size() && is_small(text[end + 1])))) {
    ++end;
  }
  const auto* const found = std::ranges::find(options, text.substr(name, end - name), &LibraryOption::option);
  return found == options.end() ? nullptr : found;
}

}  // namespace

std::span<const LibraryOption> library_options() {
  return options;
}

std::string option_value(std::string_view value) {
  const bool is_plain = !value.empty() && value.find_first_of(" \t\n\"'`$\\;&|<>()*?!#~") == std::string_view::npos &&
                        (marks.find(value.back()) == std::string_view::npos || value.ends_with(".."));
  return is_plain ? std::string(value) : shell_quoted(value);
}

std::string in_words_of(Caller caller, std::string_view text) {
  std::string result;
  if (caller == Caller::CommandLine) {
    return std::string(text);
  }
  bool is_command = false;
  for (std::size_t at = 0; at < text.size();) {
    is_command = text[at] == '`' ? !is_command : is_command;
    std::size_t end = 0;
    const bool is_word = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
    const LibraryOption* const option =
        !is_command && is_word && text.substr(at).starts_with("--") ? option_at(text, at + 2, end) : nullptr;
    if (option == nullptr) {
      result += text[at++];
      continue;
    }
    const SentenceWord value = value_behind(*option, text, end);
    result += reworded(*option, value.text, caller, at == 0 || text.substr(0, at).ends_with(". "));
    at = value.end;
  }
  return result;
}

Diagnostics in_words_of(Caller caller, const Diagnostics& diagnostics) {
  Diagnostics result;
  for (Diagnostic one : diagnostics.all()) {
    one.cause = in_words_of(caller, one.cause);
    one.mend = in_words_of(caller, one.mend);
    for (Note& note : one.notes) {
      note.text = in_words_of(caller, note.text);
    }
    result.add(std::move(one));
  }
  return result;
}

}  // namespace hysteron
