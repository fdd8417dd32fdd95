// Collects the errors of one text by offset; they are given a line and a column, and put in the order of the text,
// when all are known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "codegen/language/syntax.hpp"

namespace hysteron::language {

class Reporter {
 public:
  /// Above this number a text is not a diagram, and a longer list helps nobody.
  static constexpr std::size_t limit = 1000;

  void error(int number, Span span, std::string cause, std::string mend);

  /// Whether an error was found between two offsets.
  [[nodiscard]] bool has_error_within(std::uint32_t begin, std::uint32_t end) const;

  /// More were found than are kept: reading on is of no use.
  [[nodiscard]] bool is_full() const { return overflow_; }

  [[nodiscard]] bool empty() const { return found_.empty(); }

  /// Hands the errors over in the order of the text, one for each place.
  void publish(const SourceFile& file, Diagnostics& diagnostics);

 private:
  struct Found {
    Span span{};
    int number = 0;
    std::string cause{};
    std::string mend{};
  };
  std::vector<Found> found_;
  bool overflow_ = false;
  Span first_left_out_{};
};

}  // namespace hysteron::language
