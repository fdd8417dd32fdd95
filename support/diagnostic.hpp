// Diagnostics: what is wrong with an input, where, why, and how to mend it.
//
// Every diagnostic has a number with a page in docs/errors. Errors are collected and printed together; nothing
// prints or exits where an error is found.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hysteron {

/// A stretch of a text file. Lines and columns count from 1; line 0 means the file as a whole, column 0 the line as a
/// whole. Columns and lengths count characters (code points), not bytes.
struct Place {
  std::string file{};
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 1;
};

enum class Severity : std::uint8_t { Error, Warning };

struct Note {
  Place place{};
  std::string text{};
};

struct Diagnostic {
  int number = 0;
  Severity severity = Severity::Error;
  Place place{};
  std::string cause{};        ///< what is wrong, one sentence
  std::string mend{};         ///< what to do about it, one sentence
  std::vector<Note> notes{};  ///< further places that matter: the other end of a wire, the steps of a loop
};

/// Collects the diagnostics of one command.
class Diagnostics {
 public:
  void add(Diagnostic diagnostic) { list_.push_back(std::move(diagnostic)); }
  void add_all(const Diagnostics& others) { list_.insert(list_.end(), others.list_.begin(), others.list_.end()); }
  void error(int number, Place place, std::string cause, std::string mend, std::vector<Note> notes = {}) {
    add({number, Severity::Error, std::move(place), std::move(cause), std::move(mend), std::move(notes)});
  }
  void warning(int number, Place place, std::string cause, std::string mend, std::vector<Note> notes = {}) {
    add({number, Severity::Warning, std::move(place), std::move(cause), std::move(mend), std::move(notes)});
  }
  [[nodiscard]] bool has_errors() const {
    return std::any_of(list_.begin(), list_.end(),
                       [](const Diagnostic& one) { return one.severity == Severity::Error; });
  }
  [[nodiscard]] const std::vector<Diagnostic>& all() const { return list_; }

 private:
  std::vector<Diagnostic> list_;
};

/// Thrown where work cannot go on; carries every diagnostic found so far.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Diagnostics diagnostics)
      : std::runtime_error(summary(diagnostics)), diagnostics_(std::move(diagnostics)) {}
  InputError(int number, Place place, std::string cause, std::string mend)
      : InputError(single(number, std::move(place), std::move(cause), std::move(mend))) {}
  [[nodiscard]] const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  static Diagnostics single(int number, Place place, std::string cause, std::string mend) {
    Diagnostics one;
    one.error(number, std::move(place), std::move(cause), std::move(mend));
    return one;
  }
  static std::string summary(const Diagnostics& diagnostics) {
    return diagnostics.all().empty() ? std::string("no diagnostic") : diagnostics.all().front().cause;
  }
  Diagnostics diagnostics_;
};

}  // namespace hysteron
