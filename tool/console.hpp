// What a command prints: results to the standard output, diagnostics to the standard error.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "support/diagnostic.hpp"
#include "support/render.hpp"

namespace hysteron::tool {

/// How a command is to speak.
struct Speech {
  bool quiet = false;      ///< errors and warnings alone: neither notes, nor progress, nor reports
  bool is_report = false;  ///< what is printed speaks of files that were written; else it is the product itself
};

class Console {
 public:
  /// From now on.
  void speak(const Speech& speech);

  /// Results. A report is left out where the command is quiet, and broken to the width of a terminal. Where the reader
  /// of a pipe has gone, what is left is dropped without a word.
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
  bool is_report_ = false;
  Sources sources_;
  int write_error_ = 0;
};

}  // namespace hysteron::tool
