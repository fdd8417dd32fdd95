// What a command prints: results to the standard output, diagnostics to the standard error.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "support/diagnostic.hpp"
#include "support/render.hpp"

namespace hysteron::tool {

/// Whom the results of a command are for.
enum class Results : std::uint8_t {
  Product,   ///< a program too: as they are
  Findings,  ///< a reader: broken to the width of a terminal
  Report     ///< likewise, and they speak of files that were written: a quiet command leaves them out
};

/// How a command is to speak.
struct Speech {
  bool quiet = false;  ///< errors and warnings alone: neither notes, nor progress, nor reports
  Results results = Results::Product;
};

class Console {
 public:
  /// From now on.
  void speak(const Speech& speech);

  /// Results. Where the reader of a pipe has gone, what is left is dropped without a word.
  void print(std::string_view text);

  /// What was understood of an input, `note: log.csv: ...`, to the standard error.
  static void note(std::string_view file, std::string_view text);

  /// Diagnostics with the lines that they speak of, and their count.
  void report(const Diagnostics& diagnostics);

  /// The same among the results: for the command whose results they are.
  void print(const Diagnostics& diagnostics);

  /// For diagnostics about a text that is not in the file of that name.
  [[nodiscard]] Sources& sources() { return sources_; }

  /// Whether results may be coloured.
  [[nodiscard]] static bool colour() { return wants_colour(stdout); }

  /// Flushes. Gives back the exit code, or exit_bad_input with an error where results could not be written.
  [[nodiscard]] int finish(int exit_code);

 private:
  static inline bool quiet_ = false;  ///< of the program as a whole: notes are told where no console is at hand
  Results results_ = Results::Product;
  Sources sources_;
  int write_error_ = 0;
};

}  // namespace hysteron::tool
