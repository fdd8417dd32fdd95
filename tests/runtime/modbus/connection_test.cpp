// A connection under a given now: no socket, no clock.
#include "runtime/modbus/connection.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "runtime/modbus/heartbeat.hpp"
#include "tests/runtime/modbus/exact_answers.hpp"
#include "tests/runtime/modbus/memory_door.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Bytes request{0x12, 0x34, 0, 0, 0, 6, 1, 3, 0, 0, 0, 2};
const Instant start{};

struct ConnectionBench {
  ConnectionBench()
      : door(test::points_of_every_type()),
        map(make_register_map(door.points(), {.title = "B"})),
        responder(map, door, {}) {}
  Served give(std::span<const std::uint8_t> bytes, Instant now) {
    return connection.received(bytes, now, responder, {});
  }
  Bytes take(Instant now) {
    Bytes all(connection.output().begin(), connection.output().end());
    connection.sent(all.size(), now);
    return all;
  }
  test::MemoryDoor door;
  RegisterMap map;
  Responder responder;
  Connection connection{start, {}};
};

TEST(Connection, EveryWayToCutARequestIsAnsweredAlike) {
  const auto result = test::cut_every_way();
  EXPECT_EQ(result.ways, 2048U);
  EXPECT_EQ(result.wrong, 0U);
}

TEST(Connection, RequestsThatComeTogetherAreAnsweredInOrder) {
  ConnectionBench bench;
  Bytes many;
  for (std::uint8_t i = 0; i < 20; ++i) {
    Bytes one = request;
    one[1] = i;
    many.insert(many.end(), one.begin(), one.end());
  }
  many.insert(many.end(), request.begin(), request.begin() + 5);
  EXPECT_EQ(bench.give(many, start).requests, 20U);
  const Bytes answers = bench.take(start);
  ASSERT_EQ(answers.size(), 20U * 13U);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(answers[13 * i + 1], i);
  }
  EXPECT_EQ(bench.give(std::span(request).subspan(5), start).requests, 1U);
}

TEST(Connection, AFrameMustBeWholeInTimeHoweverItDrips) {
  ConnectionBench bench;
  for (int i = 0; i < 5; ++i) {
    bench.give(std::span(request).subspan(static_cast<std::size_t>(i), 1), start + milliseconds(100 * i));
    EXPECT_EQ(bench.connection.due(start + milliseconds(100 * i)), std::nullopt);
  }
  EXPECT_EQ(bench.connection.next_deadline(), start + milliseconds(500));
  EXPECT_EQ(bench.connection.due(start + milliseconds(499)), std::nullopt);
  EXPECT_EQ(bench.connection.due(start + milliseconds(500)), Ending::frame_late);
}

TEST(Connection, IdleEndsAndARequestBeginsItAnew) {
  ConnectionBench bench;
  EXPECT_EQ(bench.connection.due(start + milliseconds(59'999)), std::nullopt);
  EXPECT_EQ(bench.connection.due(start + milliseconds(60'000)), Ending::idle);
  bench.give(request, start + milliseconds(59'000));
  bench.take(start + milliseconds(59'000));
  EXPECT_EQ(bench.connection.due(start + milliseconds(118'999)), std::nullopt);
  EXPECT_EQ(bench.connection.next_deadline(), start + milliseconds(119'000));
}

TEST(Connection, WhoNeverReadsIsAskedNoMoreAndThenDropped) {
  ConnectionBench bench;
  Instant now = start;
  std::size_t most = 0;
  while (bench.connection.wants_input() >= request.size()) {
    bench.give(request, now);
    most = std::max(most, bench.connection.output().size());
    now += milliseconds(1);
  }
  EXPECT_LE(most, ConnectionLimits{}.output_bytes + longest_frame);
  while (bench.connection.wants_input() > 0) {
    bench.give(request, now);
  }
  EXPECT_EQ(bench.connection.due(start + milliseconds(1999)), std::nullopt);
  EXPECT_EQ(bench.connection.due(start + milliseconds(2000)), Ending::unread);
}

TEST(Connection, WhoReadsSlowlyIsServedOn) {
  ConnectionBench bench;
  Instant now = start;
  std::size_t answered = 0;
  std::size_t asked = 0;
  for (int i = 0; i < 3000; ++i) {
    now += milliseconds(10);
    if (bench.connection.wants_input() >= request.size()) {
      bench.give(request, now);
      ++asked;
    }
    bench.connection.sent(std::min<std::size_t>(bench.connection.output().size(), 5), now);
    answered += 5;
    ASSERT_EQ(bench.connection.due(now), std::nullopt) << i;
    bench.connection.resume(now, bench.responder, {});
  }
  EXPECT_GT(asked * 13, answered);
}

TEST(Connection, OutputThatMovesOnceAndThenNoMoreIsDropped) {
  ConnectionBench bench;
  bench.give(request, start);
  bench.connection.sent(3, start + milliseconds(1500));
  EXPECT_EQ(bench.connection.due(start + milliseconds(3499)), std::nullopt);
  EXPECT_EQ(bench.connection.due(start + milliseconds(3500)), Ending::unread);
}

TEST(Connection, WhatIsNoFrameEndsItAfterTheRequestsBefore) {
  for (const auto& [at, ending] : {std::pair{3U, Ending::wrong_protocol}, std::pair{4U, Ending::wrong_length}}) {
    ConnectionBench bench;
    Bytes bytes = request;
    bytes.insert(bytes.end(), request.begin(), request.end());
    bytes[request.size() + at] = 1;
    EXPECT_EQ(bench.give(bytes, start).requests, 1U);
    EXPECT_EQ(bench.connection.due(start), ending);
    EXPECT_EQ(bench.connection.wants_input(), 0U);
    EXPECT_EQ(bench.give(request, start).requests, 0U) << "nothing is taken behind it";
    EXPECT_EQ(bench.take(start).size(), 13U);
  }
}

TEST(Heartbeat, OffNeverLosesAnyone) {
  Heartbeat heartbeat({});
  heartbeat.telegram(2, true, start);
  EXPECT_FALSE(heartbeat.is_lost(start + milliseconds(1'000'000)));
  EXPECT_EQ(heartbeat.next_deadline(), std::nullopt);
}

TEST(Heartbeat, BeginsWithTheFirstTelegramThatCounts) {
  for (const auto mode : {HeartbeatMode::any_telegram, HeartbeatMode::write_telegram}) {
    Heartbeat heartbeat({.mode = mode});
    EXPECT_FALSE(heartbeat.is_lost(start + milliseconds(99'999)));
    heartbeat.telegram(2, false, start + milliseconds(100'000));
    const bool begun = mode == HeartbeatMode::any_telegram;
    EXPECT_EQ(heartbeat.is_lost(start + milliseconds(101'000)), begun);
    heartbeat.telegram(2, true, start + milliseconds(102'000));
    EXPECT_FALSE(heartbeat.is_lost(start + milliseconds(102'999)));
    heartbeat.telegram(2, false, start + milliseconds(102'999));
    EXPECT_EQ(heartbeat.is_lost(start + milliseconds(103'000)), !begun);
  }
}

TEST(Heartbeat, ALostClientComesBackByATelegramThatCounts) {
  Heartbeat heartbeat({.mode = HeartbeatMode::write_telegram});
  heartbeat.telegram(2, true, start);
  EXPECT_TRUE(heartbeat.is_lost(start + milliseconds(1000)));
  heartbeat.telegram(2, false, start + milliseconds(1001));
  EXPECT_TRUE(heartbeat.is_lost(start + milliseconds(1002)));
  heartbeat.telegram(3, true, start + milliseconds(1003));
  EXPECT_FALSE(heartbeat.is_lost(start + milliseconds(1004)));
}

TEST(Heartbeat, TheFirstWriterOwnsTheWritesUntilItGoesOrIsLost) {
  Heartbeat heartbeat({.mode = HeartbeatMode::any_telegram, .own_writes = true});
  EXPECT_FALSE(heartbeat.other_owns_writes(2));
  heartbeat.telegram(2, true, start);
  EXPECT_FALSE(heartbeat.other_owns_writes(2));
  EXPECT_TRUE(heartbeat.other_owns_writes(3));
  heartbeat.gone(3);
  EXPECT_TRUE(heartbeat.other_owns_writes(3));
  heartbeat.gone(2);
  EXPECT_FALSE(heartbeat.other_owns_writes(3));
  heartbeat.telegram(3, true, start);
  EXPECT_TRUE(heartbeat.other_owns_writes(2));
  heartbeat.telegram(2, false, start + milliseconds(900));
  EXPECT_TRUE(heartbeat.is_lost(start + milliseconds(1000))) << "another's telegrams are not the owner's";
  EXPECT_FALSE(heartbeat.other_owns_writes(2));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
