// Rows of the table of long counts: each has a name, by which it is run alone, and prints what was counted.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::soak {

struct Counted {
  std::uint64_t count = 0;
  std::string result{};
  bool holds = false;
};

struct Row {
  std::string name;  ///< as an argument
  std::string what;
  std::uint64_t count = 0;  ///< in full
  std::function<Counted(std::uint64_t count)> run;
};

/// Runs the rows that the arguments name, or all. A number among the arguments, 0.01 say, is the part of each count.
/// The exit code is 1 where one does not hold, 2 where none has that name.
inline int run_rows(std::span<const Row> rows, std::span<const char* const> arguments) {
  double part = 1.0;
  std::vector<std::string_view> names;
  for (const std::string_view argument : arguments) {
    const bool is_part = argument.starts_with("0.") || argument == "1";
    part = is_part ? std::stod(std::string(argument)) : part;
    if (!is_part) {
      names.push_back(argument);
    }
  }
  bool all_hold = true;
  std::size_t ran = 0;
  for (const Row& row : rows) {
    if (!names.empty() && std::ranges::find(names, row.name) == names.end()) {
      continue;
    }
    ++ran;
    const auto begin = std::chrono::steady_clock::now();
    const auto count = static_cast<std::uint64_t>(std::max(1.0, std::round(static_cast<double>(row.count) * part)));
    const Counted done = row.run(count);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    fmt::print("| {} | {} | {} | {} | {:.1f} |\n", row.what, done.count, done.result, done.holds ? "yes" : "NO",
               time.count());
    (void)std::fflush(stdout);
    all_hold = all_hold && done.holds;
  }
  if (ran < names.size() || ran == 0) {
    fmt::print(stderr, "no such row\n");
    return 2;
  }
  return all_hold ? 0 : 1;
}

}  // namespace hysteron::soak
