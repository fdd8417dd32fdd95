// What is written to standard error meanwhile, in as many lines as there are kinds of it: a count of a thousand changes
// needs no thousand lines.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::test {

/// Lines that differ in their numbers alone are one: the first of them, and how many there were.
inline std::string summarised(std::string_view text) {
  struct Kind {
    std::string without_numbers{};
    std::string_view first{};
    std::size_t count = 0;
  };
  std::vector<Kind> kinds;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    std::string plain;
    for (const char sign : line) {
      if (std::isdigit(static_cast<unsigned char>(sign)) == 0) {
        plain += sign;
      } else if (!plain.ends_with('#')) {
        plain += '#';
      }
    }
    const auto known = std::ranges::find(kinds, plain, &Kind::without_numbers);
    if (known == kinds.end()) {
      kinds.push_back({.without_numbers = plain, .first = line, .count = 1});
    } else {
      ++known->count;
    }
  }
  std::string result;
  for (const Kind& kind : kinds) {
    result += kind.count == 1 ? fmt::format("{}\n", kind.first)
                              : fmt::format("{} (and {} more of its kind)\n", kind.first, kind.count - 1);
  }
  return result;
}

/// For as long as it lives. What a process says that dies meanwhile is lost.
class SummarisedStderr {
 public:
  SummarisedStderr() {
    if (meanwhile_ != nullptr && before_ >= 0) {
      (void)std::fflush(stderr);
      (void)::dup2(::fileno(meanwhile_.get()), STDERR_FILENO);
    }
  }
  SummarisedStderr(const SummarisedStderr&) = delete;
  SummarisedStderr& operator=(const SummarisedStderr&) = delete;
  SummarisedStderr(SummarisedStderr&&) = delete;
  SummarisedStderr& operator=(SummarisedStderr&&) = delete;
  ~SummarisedStderr() {
    if (meanwhile_ == nullptr || before_ < 0) {
      return;
    }
    (void)std::fflush(stderr);
    (void)::dup2(before_, STDERR_FILENO);
    (void)::close(before_);
    std::string text;
    std::array<char, 65536> part{};
    std::rewind(meanwhile_.get());
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), meanwhile_.get())) {
      text.append(part.data(), count);
    }
    (void)std::fputs(summarised(text).c_str(), stderr);
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> meanwhile_{std::tmpfile()};
  int before_ = ::dup(STDERR_FILENO);
};

}  // namespace hysteron::test
