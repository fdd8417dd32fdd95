// A history whose writer is killed while it writes; run in the tests and, longer, in the soak.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/runtime/history/history_bench.hpp"
#include "tests/support/killed_writer.hpp"

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
  const auto write = [&](const auto& tell) {
    HistoryBench bench(file, 1, 100'000'000);
    bench.settings().plan.run.key = std::to_string(number);
    for (bench.start();;) {
      bench.run(rows_at_once);
      bench.turn();
      tell(bench.count().done);
    }
  };
  KilledHistory result;
  result.confirmed =
      told_before_kill<std::uint64_t>(transactions, std::chrono::microseconds(microseconds), write).value_or(0);
  HistoryReader reader(file);
  const auto found = reader.stretches({.run = reader.runs().back().run}).stretches;
  result.rows = found.empty() ? 0 : found.back().rows;
  result.is_whole = found.size() == 1 && result.rows % static_cast<std::int64_t>(rows_at_once) == 0 &&
                    result.rows >= static_cast<std::int64_t>(result.confirmed);
  return result;
}

}  // namespace hysteron::runtime::test
