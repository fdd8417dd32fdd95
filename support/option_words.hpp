// Options in the words of who called. A message names them as the command line does, and a program cannot follow that:
//
//   command line   read the rows before it: --rows 1..60
//   C              read the rows before it: {"rows": "1..60"}
//   Python         read the rows before it: rows="1..60"
//
// Commands in backticks, `hysteron fmt --any-order`, are commands for everyone.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "support/diagnostic.hpp"

namespace hysteron {

enum class Caller : std::uint8_t { CommandLine, C, Python };

/// How the library takes what an option of the command line says.
enum class OptionForm : std::uint8_t {
  Text,
  Number,
  Flag,
  Pair,        ///< NAME=VALUE, in an object
  TextOrPair,  ///< VALUE as a text, or NAME=VALUE in an object
  List,        ///< an element of a list
  Argument,    ///< an argument of the function, and no option
  None         ///< not at all: what it is for can be done with the tool
};

struct LibraryOption {
  std::string_view option;  ///< as on the command line, without --
  std::string_view key;
  OptionForm form = OptionForm::Text;
  bool any_value = false;  ///< a word of small letters behind it is its value, too, not the next of the sentence
};

/// The options of the command line that messages of the library name.
[[nodiscard]] std::span<const LibraryOption> library_options();

/// What an option is given, as messages show it: in quotes where a shell or the end of a sentence would take it apart.
[[nodiscard]] std::string option_value(std::string_view value);

/// A text with each of these options in the caller's words. What stands behind an option is its value where it is in
/// quotes, or is no word of small letters alone. Other options stay as they are.
[[nodiscard]] std::string in_words_of(Caller caller, std::string_view text);

/// The same of causes, mends and notes.
[[nodiscard]] Diagnostics in_words_of(Caller caller, const Diagnostics& diagnostics);

}  // namespace hysteron
