// A history whose writer is killed while it writes; run in the tests and, longer, in the soak.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/runtime/history/history_bench.hpp"

namespace hysteron::runtime::test {

struct KilledHistory {
  std::uint64_t confirmed = 0;  ///< rows that the writer said were written
  std::int64_t rows = 0;        ///< of its run, in the file
  bool is_whole = false;        ///< one stretch of whole transactions
};

/// Rows at `rows_at_once`, until so many transactions were confirmed, and then for some microseconds more. To be called
/// while the process has one thread.
inline KilledHistory kill_history(const std::filesystem::path& file, int number, int transactions,
                                  useconds_t microseconds) {
  constexpr std::uint64_t rows_at_once = 50;
  KilledHistory result;
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    return result;
  }
  const pid_t child = ::fork();
  if (child == 0) {
    HistoryBench bench(file, 1, 100'000'000);
    bench.settings().plan.run.key = std::to_string(number);
    for (bench.start();;) {
      bench.run(rows_at_once);
      bench.turn();
      const std::uint64_t done = bench.count().done;
      if (::write(ends[1], &done, sizeof done) != sizeof done) {
        ::_exit(1);
      }
    }
  }
  ::close(ends[1]);
  const auto hear = [&] { return ::read(ends[0], &result.confirmed, sizeof result.confirmed) > 0; };
  while (transactions-- > 0 && hear()) {
  }
  ::usleep(microseconds);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  while (hear()) {
  }
  ::close(ends[0]);
  HistoryReader reader(file);
  const auto found = reader.stretches({.run = reader.runs().back().run}).stretches;
  result.rows = found.empty() ? 0 : found.back().rows;
  result.is_whole = found.size() == 1 && result.rows % static_cast<std::int64_t>(rows_at_once) == 0 &&
                    result.rows >= static_cast<std::int64_t>(result.confirmed);
  return result;
}

}  // namespace hysteron::runtime::test
