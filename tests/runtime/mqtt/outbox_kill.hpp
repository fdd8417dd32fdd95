// Rows that wait on the disk while their writer is killed; run in the tests and, longer, in the soak.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>

#include "runtime/mqtt/outbox.hpp"
#include "runtime/mqtt/outbox_file.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/support/killed_writer.hpp"

namespace hysteron::runtime::test {

struct KilledOutbox {
  std::uint64_t first = 0;  ///< the oldest row that the writer said was still to be sent
  std::uint64_t end = 0;    ///< behind the newest that it said was on the disk
  std::uint64_t found = 0;  ///< rows in the file
  bool is_whole = false;    ///< they follow each other, and none of those is missing
};

/// The row of a number, which tells it.
inline MqttRow numbered_row(std::uint64_t number) {
  return {.utc_ms = 1'795'867'200'000 + static_cast<std::int64_t>(number),
          .cycle = number,
          .values = {{.point = 0, .value = 0.1 * static_cast<double>(number)},
                     {.point = 1, .value = -1.0, .quality = ValueQuality::Uncertain}}};
}

/// Adds rows and takes some away, as a broker that comes and goes confirms them, until so many transactions were told,
/// and then for some microseconds more. Goes on from what the file has. To be called while the process has one thread.
inline KilledOutbox kill_outbox(const std::filesystem::path& path, int transactions, useconds_t microseconds) {
  using Told = std::array<std::uint64_t, 2>;
  const auto write = [&](const auto& tell) {
    OutboxFile file(path, {"U", "Y"});
    Outbox outbox(10'000'000, 1'000'000'000, file.first());
    for (const MqttRow& row : file.rows()) {
      (void)outbox.add(row, 0);
    }
    for (std::uint64_t turn = 0;; ++turn) {
      for (int i = 0; i < 20; ++i) {
        (void)outbox.add(numbered_row(outbox.first() + outbox.size()), 0);
      }
      // About as many go as come: else the last of a thousand runs would read what all before it have left.
      for (int i = 0; i < 30 && turn % 3 != 2 && outbox.size() > 5; ++i) {
        const std::uint64_t number = outbox.next_number();
        outbox.send();
        (void)outbox.confirm(number);
      }
      file.follow(outbox.first(), outbox.rows_from(std::max(file.end(), outbox.first()), 0));
      tell({outbox.first(), file.end()});
    }
  };
  const Told told =
      told_before_kill<Told>(transactions, std::chrono::microseconds(microseconds), write).value_or(Told{});
  KilledOutbox result{.first = told[0], .end = told[1]};
  const OutboxFile file(path, {"U", "Y"});
  result.found = file.rows().size();
  // A row more may be gone, or there, than was told of before the kill.
  result.is_whole = file.aside().empty() && file.first() >= result.first && file.first() <= result.end + 20 &&
                    file.end() >= result.end && file.end() - file.first() == result.found;
  for (std::uint64_t i = 0; i < result.found && result.is_whole; ++i) {
    const MqttRow expected = numbered_row(file.first() + i);
    const MqttRow& row = file.rows()[i];
    result.is_whole = row.cycle == expected.cycle && row.utc_ms == expected.utc_ms && row.values.size() == 2 &&
                      row.values[0].value == expected.values[0].value &&
                      row.values[1].quality == ValueQuality::Uncertain;
  }
  return result;
}

}  // namespace hysteron::runtime::test
