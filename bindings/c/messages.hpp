// Messages across the border, and the border itself: no exception crosses it.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bindings/c/hysteron.h"
#include "support/diagnostic.hpp"

struct hysteron_messages {
  struct Message {
    int severity = HYSTERON_ERROR;
    int code = 0;
    hysteron::Place place{};
    std::string cause{};
    std::string mend{};
  };
  std::vector<Message> list{};
  std::string text{};
};

namespace hysteron::bindings {

/// A source that stands in no file, for the lines that messages show.
struct MemoryText {
  std::string_view file{};
  std::string_view text{};
};

/// What one call has to say, besides its result.
class Call {
 public:
  explicit Call(hysteron_messages** out) noexcept : out_(out) {
    if (out_ != nullptr) {
      *out_ = nullptr;
    }
  }

  void has_text(std::string_view file, std::string_view text) { memory_ = {.file = file, .text = text}; }
  void warn(const Diagnostics& diagnostics) { diagnostics_ = diagnostics; }
  void note(const std::string& file, const std::vector<std::string>& notes);

  /// Runs the work; gives back what it gives, or null with the errors. Warnings and notes are told on success.
  template <class Work>
  auto operator()(const Work& work) noexcept -> decltype(work()) {
    try {
      auto result = work();
      tell();
      return result;
    } catch (...) {
      fail();
      return nullptr;
    }
  }

 private:
  void tell();
  void fail() noexcept;
  void add(const Diagnostics& diagnostics, hysteron_messages& messages) const;

  hysteron_messages** out_;
  MemoryText memory_{};
  Diagnostics diagnostics_{};
  std::vector<std::pair<std::string, std::string>> notes_{};  ///< file and text
};

/// Throws InputError HY730 where a pointer that must not be null is.
void require(const void* pointer, std::string_view what);

}  // namespace hysteron::bindings
