#include "codegen/language/reporter.hpp"

#include <algorithm>
#include <utility>

#include "support/errors.hpp"

namespace hysteron::language {

void Reporter::error(int number, Span span, std::string cause, std::string mend) {
  if (found_.size() < limit) {
    found_.push_back({span, number, std::move(cause), std::move(mend)});
  } else if (!overflow_) {
    overflow_ = true;
    first_left_out_ = span;
  }
}

bool Reporter::has_error_within(std::uint32_t begin, std::uint32_t end) const {
  return std::any_of(found_.begin(), found_.end(),
                     [&](const Found& found) { return found.span.offset >= begin && found.span.offset < end; });
}

void Reporter::publish(const SourceFile& file, Diagnostics& diagnostics) {
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Found& a, const Found& b) { return a.span.offset < b.span.offset; });
  const Found* last = nullptr;
  for (auto& found : found_) {
    if (last == nullptr || last->span.offset != found.span.offset) {
      diagnostics.error(found.number, file.place(found.span), std::move(found.cause), std::move(found.mend));
    }
    last = &found;
  }
  if (overflow_) {
    diagnostics.error(error::too_many_errors, file.place(first_left_out_),
                      "There are more than " + std::to_string(limit) + " syntax errors; the rest is left out.",
                      "Mend the first ones, or check that this file is a diagram at all.");
  }
}

}  // namespace hysteron::language
