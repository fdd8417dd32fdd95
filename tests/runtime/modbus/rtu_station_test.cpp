// The station on a serial line under a given now: no line, no clock.
#include "runtime/modbus/rtu_station.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/serial_device.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Frame16 = std::vector<std::uint8_t>;
using std::chrono::microseconds;
using test::with_crc;

constexpr std::uint8_t own_unit = 17;
constexpr RtuTiming timing{.silence = microseconds(1750), .longest_gap = milliseconds(20)};

struct StationBench {
  explicit StationBench(bool has_echo = false)
      : door(test::points_of_every_type()),
        map(make_register_map(door.points(), {.title = "B"})),
        responder(map, door, {}),
        station(own_unit, timing, has_echo) {}

  Served give(const Frame16& bytes) { return station.received(bytes, now, responder, {}); }
  /// What is sent after the silence.
  Frame16 take() {
    EXPECT_TRUE(station.output(now).empty()) << "the line is silent first";
    now += timing.silence;
    const auto output = station.output(now);
    Frame16 all(output.begin(), output.end());
    station.sent(all.size(), now);
    return all;
  }
  Served wait() {
    now += timing.longest_gap + microseconds(1);
    return station.silent(now, responder, {});
  }

  test::MemoryDoor door;
  RegisterMap map;
  Responder responder;
  RtuStation station;
  Instant now{Instant{} + std::chrono::hours(1)};
};

const Frame16 read_frame = with_crc({own_unit, 3, 0, 20, 0, 2});
const Frame16 write_frame = with_crc({own_unit, 6, 0, 20, 0x12, 0x34});

TEST(RtuStation, TheChecksumIsThatOfTheSpecification) {
  EXPECT_EQ(rtu_checksum(Frame16{0x02, 0x07}), 0x1241) << "its example: 41, then 12";
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    Frame16 bytes(1 + random() % 256);
    for (auto& byte : bytes) {
      byte = static_cast<std::uint8_t>(random());
    }
    EXPECT_EQ(rtu_checksum(bytes), test::crc_of(bytes));
  }
  EXPECT_EQ(rtu_silence(9600), std::chrono::nanoseconds(4'010'416));
  EXPECT_EQ(rtu_silence(115200), microseconds(1750));
}

TEST(RtuStation, EveryWayToCutARequestIsAnsweredAlike) {
  for (unsigned cuts = 0; cuts < 1U << (write_frame.size() - 1); ++cuts) {
    StationBench bench;
    Frame16 part;
    for (std::size_t i = 0; i < write_frame.size(); ++i) {
      part.push_back(write_frame[i]);
      if (i + 1 == write_frame.size() || (cuts >> i & 1U) != 0) {
        bench.now += milliseconds(15);
        bench.give(part);
        part.clear();
      }
    }
    ASSERT_EQ(bench.take(), write_frame);
    ASSERT_EQ(bench.door.value(bench.map.find(Area::holding_register, 20)->point), 0x1234);
  }
}

TEST(RtuStation, ReadsAndExceptionsAreAnswered) {
  StationBench bench;
  EXPECT_EQ(bench.give(read_frame).requests, 1U);
  EXPECT_EQ(bench.take(), with_crc({own_unit, 3, 4, 0, 0, 0, 0}));
  EXPECT_EQ(bench.give(with_crc({own_unit, 3, 0x70, 0, 0, 1})).exceptions, 1U);
  EXPECT_EQ(bench.take(), with_crc({own_unit, 0x83, 2}));
  EXPECT_EQ(bench.give(with_crc({own_unit, 99, 1, 2, 3})).requests, 0U) << "nothing tells its length but the silence";
  EXPECT_EQ(bench.wait().exceptions, 1U);
  EXPECT_EQ(bench.take(), with_crc({own_unit, 0xE3, 1}));
}

TEST(RtuStation, ABroadcastIsCarriedOutAndNotAnswered) {
  StationBench bench;
  EXPECT_EQ(bench.give(with_crc({0, 6, 0, 20, 0, 7})).writes, 1U);
  EXPECT_EQ(bench.take(), Frame16{});
  EXPECT_EQ(bench.door.value(bench.map.find(Area::holding_register, 20)->point), 7.0);
  EXPECT_EQ(bench.station.counts().broadcasts, 1U);
}

TEST(RtuStation, OthersOnTheLineArePassedOver) {
  StationBench bench;
  Frame16 all = with_crc({9, 3, 0, 20, 0, 2});
  for (const Frame16& more : {with_crc({9, 3, 4, 1, 2, 3, 4}), with_crc({9, 16, 0, 20, 0, 1, 2, 0, 7}),
                              with_crc({9, 16, 0, 20, 0, 1}), with_crc({8, 0x83, 2}), read_frame}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  EXPECT_EQ(bench.give(all).requests, 1U) << "all that came in one read";
  EXPECT_EQ(bench.take().size(), 9U);
  EXPECT_EQ(bench.station.counts().frames, 6U);
  EXPECT_EQ(bench.give(with_crc({9, 65, 1, 2, 3, 4, 5, 6, 7})).requests, 0U) << "a function nobody knows";
  EXPECT_EQ(bench.give(read_frame).requests, 1U);
  EXPECT_EQ(bench.door.writes(), 0U);
  EXPECT_EQ(bench.station.counts().broken, 0U);
}

TEST(RtuStation, ADamagedFrameIsCountedAndTheNextIsHeard) {
  for (std::size_t bit = 0; bit < 8 * write_frame.size(); ++bit) {
    StationBench bench;
    Frame16 damaged = write_frame;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    bench.give(damaged);
    bench.wait();
    EXPECT_EQ(bench.door.writes(), 0U) << bit;
    EXPECT_EQ(bench.station.counts().broken, 1U) << bit;
    EXPECT_TRUE(bench.station.output(bench.now + timing.silence).empty()) << "nobody answers what nobody asked";
    bench.give(write_frame);
    EXPECT_EQ(bench.take(), write_frame) << bit;
  }
}

TEST(RtuStation, ATornFrameDoesNotSpoilTheOneAfterTheSilence) {
  StationBench bench;
  bench.give(Frame16(read_frame.begin(), read_frame.begin() + 5));
  bench.now += timing.longest_gap + microseconds(1);
  EXPECT_EQ(bench.give(read_frame).requests, 1U);
  EXPECT_EQ(bench.station.counts().broken, 1U);
}

TEST(RtuStation, AMasterThatSpeaksOnGetsNoLateAnswer) {
  StationBench bench;
  bench.give(read_frame);
  bench.now += microseconds(500);
  bench.give(write_frame);
  EXPECT_EQ(bench.take(), write_frame) << "and not the answer to the read";
}

TEST(RtuStation, AnEchoIsTakenAway) {
  StationBench bench(true);
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(bench.give(write_frame).requests, 1U);
    Frame16 echo = bench.take();
    EXPECT_EQ(bench.give(Frame16(echo.begin(), echo.begin() + 3)).requests, 0U);
    EXPECT_EQ(bench.give(Frame16(echo.begin() + 3, echo.end())).requests, 0U) << "its own answer is no request";
    bench.now += milliseconds(30);
  }
  EXPECT_EQ(bench.door.writes(), 3U);
  EXPECT_EQ(bench.station.counts().echo_lost, 0U);
  bench.give(write_frame);
  (void)bench.take();
  bench.now += milliseconds(500);
  EXPECT_EQ(bench.give(write_frame).requests, 1U) << "the adapter gave nothing back: the same bytes are a request now";
  EXPECT_EQ(bench.station.counts().echo_lost, 1U);
}

TEST(RtuStation, AnyBytesDoNoHarm) {
  std::mt19937 random(7);
  StationBench bench;
  std::uint64_t heard = 0;
  for (int i = 0; i < 20'000; ++i) {
    Frame16 bytes(random() % 40);
    for (auto& byte : bytes) {
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? own_unit : random());
    }
    heard += bench.give(bytes).requests;
    bench.now += milliseconds(random() % 30);
    (void)bench.station.silent(bench.now, bench.responder, {});
    ASSERT_LE(bench.station.output(bench.now + timing.silence).size(), longest_rtu_frame);
    const auto next = bench.station.next_deadline();
    ASSERT_TRUE(!next || *next <= bench.now + timing.longest_gap + microseconds(1));
  }
  EXPECT_LT(heard, 10U) << "one of 65536 by chance";
  (void)bench.wait();
  bench.give(write_frame);
  EXPECT_EQ(bench.take(), write_frame);
}

}  // namespace
}  // namespace hysteron::runtime::modbus
