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
#include "support/option_words.hpp"

struct hysteron_messages {
  struct Message {
    int severity = HYSTERON_ERROR;
    int code = 0;
    hysteron::Place place{};
    std::string cause{};
    std::string mend{};
  };
  /// What was found, in the words of the command line.
  hysteron::Diagnostics found{};
  std::vector<std::pair<std::string, std::string>> notes{};  ///< file and text
  std::string memory_file{};                                 ///< of a source that stands in no file
  std::string memory_text{};

  /// The same in the words of a caller.
  std::vector<Message> list{};
  std::string text{};

  void word_for(hysteron::Caller caller);
};

namespace hysteron::bindings {

/// What one call has to say, besides its result.
class Call {
 public:
  explicit Call(hysteron_messages** out) noexcept : out_(out) {
    if (out_ != nullptr) {
      *out_ = nullptr;
    }
  }

  /// A source that stands in no file, for the lines that messages show.
  void has_text(std::string_view file, std::string_view text) {
    memory_file_ = file;
    memory_text_ = text;
  }
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
  void hand_out(const Diagnostics& diagnostics) const;

  hysteron_messages** out_;
  std::string_view memory_file_{};
  std::string_view memory_text_{};
  Diagnostics diagnostics_{};
  std::vector<std::pair<std::string, std::string>> notes_{};  ///< file and text
};

/// Throws InputError HY730 where a pointer that must not be null is.
void require(const void* pointer, std::string_view what);

}  // namespace hysteron::bindings
