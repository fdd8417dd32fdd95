// Rows that wait: none is lost but the oldest, none overtakes another, and each is there until it is confirmed; held
// against a list that does the same by searching.
#include "runtime/mqtt/outbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace hysteron::runtime {
namespace {

MqttRow row_of(std::uint64_t cycle, std::size_t values = 3) {
  MqttRow row{.utc_ms = static_cast<std::int64_t>(cycle), .cycle = cycle};
  row.values.resize(values);
  return row;
}

/// Of a row of three values.
std::uint64_t row_size() {
  Outbox one(1'000'000, 1'000'000);
  (void)one.add(row_of(0), 0);
  return one.used();
}

TEST(Outboxes, GiveRowsInOrderAndKeepThemUntilTheyAreConfirmed) {
  Outbox outbox(1'000'000, 1000);
  for (std::uint64_t i = 0; i < 5; ++i) {
    EXPECT_EQ(outbox.add(row_of(i), 0), 0U);
  }
  for (std::uint64_t i = 0; i < 3; ++i) {
    EXPECT_EQ(outbox.next()->cycle, i);
    EXPECT_EQ(outbox.next_number(), i);
    outbox.send();
  }
  EXPECT_EQ(outbox.confirm(1), 0U) << "the first is not confirmed yet";
  EXPECT_EQ(outbox.size(), 5U);
  EXPECT_EQ(outbox.confirm(0), 2U);
  EXPECT_EQ(outbox.confirm(0), 0U) << "it is gone";
  EXPECT_EQ(outbox.confirm(3), 0U) << "it was never sent";
  outbox.call_back();
  EXPECT_EQ(outbox.next()->cycle, 2U) << "what was not confirmed is sent again";
  outbox.send();
  outbox.send();
  EXPECT_EQ(outbox.confirm_through(3), 2U);
  EXPECT_EQ(outbox.size(), 1U);
}

TEST(Outboxes, LoseTheOldestAloneWhereTheyAreFull) {
  Outbox outbox(10 * row_size(), 1'000'000);
  std::size_t dropped = 0;
  for (std::uint64_t i = 0; i < 25; ++i) {
    dropped += outbox.add(row_of(i), 0);
    EXPECT_LE(outbox.used(), 10 * row_size());
  }
  EXPECT_EQ(dropped, 15U);
  EXPECT_EQ(outbox.next()->cycle, 15U);
  EXPECT_EQ(outbox.next_number(), 15U);
}

TEST(Outboxes, TakeARowThatIsLargerThanAllRoom) {
  Outbox outbox(10, 1000);
  EXPECT_EQ(outbox.add(row_of(1), 0), 0U);
  EXPECT_EQ(outbox.add(row_of(2), 0), 1U) << "the newest is there, whatever the room";
  EXPECT_EQ(outbox.next()->cycle, 2U);
}

TEST(Outboxes, LoseWhatIsTooOld) {
  Outbox outbox(1'000'000, 100);
  (void)outbox.add(row_of(1), 0);
  (void)outbox.add(row_of(2), 50);
  outbox.send();
  EXPECT_EQ(outbox.expire(100), 0U);
  EXPECT_EQ(outbox.expire(101), 1U);
  EXPECT_EQ(outbox.on_the_way(), 0U);
  EXPECT_EQ(outbox.next()->cycle, 2U);
  EXPECT_EQ(outbox.confirm(0), 0U) << "its confirmation comes too late";
  EXPECT_EQ(outbox.expire(1000), 1U);
  EXPECT_EQ(outbox.used(), 0U);
}

struct Modelled {
  std::uint64_t number = 0;
  std::int64_t since = 0;
  bool is_sent = false;
  bool is_confirmed = false;
};

TEST(Outboxes, AreAsAPlainListWhateverComes) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint64_t limit) { return random() % limit; };
    const std::size_t room = 1 + below(40);
    const auto keep = static_cast<std::int64_t>(5 + below(200));
    Outbox outbox(room * row_size(), keep);
    std::vector<Modelled> list;
    std::uint64_t added = 0;
    std::uint64_t done = 0;
    std::uint64_t lost = 0;
    std::int64_t now = 0;
    const auto clear = [&] {
      std::size_t count = 0;
      while (!list.empty() && list.front().is_sent && list.front().is_confirmed) {
        list.erase(list.begin());
        ++count;
      }
      return count;
    };
    for (int step = 0; step < 500; ++step) {
      now += static_cast<std::int64_t>(below(4));
      switch (below(7)) {
        case 0:
        case 1: {
          std::size_t dropped = 0;
          while (list.size() >= room) {
            list.erase(list.begin());
            ++dropped;
          }
          list.push_back({.number = added, .since = now});
          ASSERT_EQ(outbox.add(row_of(added++), now), dropped) << seed;
          lost += dropped;
          break;
        }
        case 2: {
          const auto dropped = static_cast<std::size_t>(
              std::erase_if(list, [&](const Modelled& one) { return now - one.since > keep; }));
          ASSERT_EQ(outbox.expire(now), dropped) << seed;
          lost += dropped;
          break;
        }
        case 3: {
          const auto next = std::ranges::find(list, false, &Modelled::is_sent);
          ASSERT_EQ(outbox.next() == nullptr, next == list.end()) << seed;
          if (next != list.end()) {
            ASSERT_EQ(outbox.next()->cycle, next->number) << seed;
            ASSERT_EQ(outbox.next_number(), next->number) << seed;
            next->is_sent = true;
            outbox.send();
          }
          break;
        }
        case 4:
        case 5: {
          const std::uint64_t number = below(added + 2);
          const bool through = below(2) == 0;
          for (Modelled& one : list) {
            one.is_confirmed =
                one.is_confirmed || (one.is_sent && (one.number == number || (through && one.number < number)));
          }
          const std::size_t count = clear();
          ASSERT_EQ(through ? outbox.confirm_through(number) : outbox.confirm(number), count) << seed;
          done += count;
          break;
        }
        default:
          if (below(5) == 0) {
            for (Modelled& one : list) {
              one.is_sent = false;
              one.is_confirmed = false;
            }
            outbox.call_back();
          }
      }
      ASSERT_EQ(outbox.size(), list.size()) << seed;
      ASSERT_EQ(outbox.used(), list.size() * row_size()) << seed;
      ASSERT_EQ(done + lost + outbox.size(), added) << seed << ": each row is done, lost or waits";
    }
  }
}

}  // namespace
}  // namespace hysteron::runtime
