#include "runtime/modbus/responder.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "runtime/modbus/value_bits.hpp"
#include "tests/runtime/modbus/exact_answers.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/oracle.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct ResponderBench {
  explicit ResponderBench(WordOrder order = WordOrder::abcd)
      : door(test::points_of_every_type()),
        map(make_register_map(door.points(), {.title = "BENCH", .order = order})),
        responder(map, door, {}) {}

  Bytes ask(const Bytes& pdu, const Caller& caller = {}) {
    const Reply reply = responder.answer(pdu, caller);
    return {reply.pdu().begin(), reply.pdu().end()};
  }
  [[nodiscard]] Stretch at(const std::string& name) const {
    for (const MapEntry& entry : map.entries()) {
      if (map.point_of(entry).name == name) {
        return entry.at;
      }
    }
    throw std::runtime_error(name);
  }
  [[nodiscard]] std::size_t point(const std::string& name) const {
    for (std::size_t i = 0; i < map.points().size(); ++i) {
      if (map.points()[i].name == name) {
        return i;
      }
    }
    throw std::runtime_error(name);
  }
  /// A request of function 16 that writes the bits of a value to a point.
  [[nodiscard]] Bytes write_request(const std::string& name, double value) const {
    const Stretch where = at(name);
    std::vector<std::uint16_t> words(where.count);
    to_registers(bits_of(value, map.points()[point(name)].type), map.order(), words);
    Bytes pdu{16, static_cast<std::uint8_t>(where.address >> 8U), static_cast<std::uint8_t>(where.address & 0xFFU),
              0,  static_cast<std::uint8_t>(where.count),         static_cast<std::uint8_t>(2 * where.count)};
    for (const std::uint16_t word : words) {
      pdu.push_back(static_cast<std::uint8_t>(word >> 8U));
      pdu.push_back(static_cast<std::uint8_t>(word & 0xFFU));
    }
    return pdu;
  }

  test::MemoryDoor door;
  RegisterMap map;
  Responder responder;
};

using test::hex;
using test::request_of;

TEST(Responder, EveryFunctionAndLengthIsAnsweredAsTheOracleSays) {
  for (const WordOrder order : word_orders) {
    const auto result = test::every_function_and_length(order);
    EXPECT_EQ(result.answers, 65024U);
    EXPECT_EQ(result.first_wrong, "");
    EXPECT_LT(result.exceptions, 65024U);
  }
}

/// The same for requests of the right length, so that most of them do something.
TEST(Responder, RandomSoundRequestsAreAnsweredAsTheOracleSays) {
  for (const WordOrder order : word_orders) {
    ResponderBench bench(order);
    test::Oracle oracle(bench.map);
    std::mt19937 random(50 + static_cast<unsigned>(order));
    std::map<int, int> done;
    for (int i = 0; i < 40000; ++i) {
      constexpr std::array<int, 11> functions{1, 2, 3, 4, 5, 6, 15, 16, 22, 23, 43};
      const int function = functions[random() % functions.size()];
      const std::size_t data = 1 + random() % 24;
      const std::size_t size = function == 15   ? 6 + (data + 7) / 8
                               : function == 16 ? 6 + 2 * data
                               : function == 22 ? 7
                               : function == 23 ? 10 + 2 * data
                               : function == 43 ? 4
                                                : 5;
      const Bytes pdu = request_of(function, size, random);
      const Bytes expected = oracle.answer(pdu);
      const Bytes got = bench.ask(pdu);
      ASSERT_EQ(hex(got), hex(expected)) << hex(pdu);
      done[function] += got[0] == function ? 1 : 0;
    }
    for (const auto& [function, times] : done) {
      EXPECT_GT(times, 40) << function;
    }
    EXPECT_EQ(done.size(), 11U);
  }
}

TEST(Responder, WritesArriveAndAreReadBack) {
  for (const WordOrder order : word_orders) {
    ResponderBench bench(order);
    for (const auto& [name, value] : std::vector<std::pair<std::string, double>>{{"I16.W", -123},
                                                                                 {"U16.W", 54321},
                                                                                 {"I32.W", -123456},
                                                                                 {"U32.W", 4e9},
                                                                                 {"I64.W", -1e15},
                                                                                 {"U64.W", 1e15},
                                                                                 {"R32.W", 0.5},
                                                                                 {"R64.W", 0.1}}) {
      const Bytes request = bench.write_request(name, value);
      EXPECT_EQ(bench.ask(request), Bytes(request.begin(), request.begin() + 5)) << name;
      EXPECT_EQ(bench.door.value(bench.point(name)), value);
      const Bytes back = bench.ask({3, request[1], request[2], request[3], request[4]});
      EXPECT_EQ(Bytes(back.begin() + 2, back.end()), Bytes(request.begin() + 6, request.end())) << name;
    }
    EXPECT_EQ(bench.door.writes(), 8U);
  }
}

TEST(Responder, NotANumberInfinityAndOutOfRangeAreRefused) {
  ResponderBench bench;
  const double nan = std::nan("");
  for (const auto& [name, value] : std::vector<std::pair<std::string, double>>{{"R64.W", nan},
                                                                               {"R64.W", HUGE_VAL},
                                                                               {"R64.W", -HUGE_VAL},
                                                                               {"R64.W", 1.1e300},
                                                                               {"R32.W", nan},
                                                                               {"R32.W", HUGE_VAL},
                                                                               {"R32.W", -2e30},
                                                                               {"I16.W", 1001},
                                                                               {"I16.W", -1001},
                                                                               {"U32.W", 4000000001.0},
                                                                               {"I64.W", 1e16}}) {
    EXPECT_EQ(bench.ask(bench.write_request(name, value)), (Bytes{0x90, 3})) << name << " " << value;
  }
  EXPECT_EQ(bench.door.writes(), 0U);
}

TEST(Responder, ARefusedValueAmongGoodOnesChangesNothing) {
  ResponderBench bench;
  const Stretch first = bench.at("I16.W");
  const Stretch second = bench.at("U16.W");
  ASSERT_EQ(second.address, first.address + 1);
  EXPECT_EQ(bench.ask({16, 0, static_cast<std::uint8_t>(first.address), 0, 2, 4, 0x7F, 0xFF, 0, 1}), (Bytes{0x90, 3}));
  EXPECT_EQ(bench.ask({16, 0, static_cast<std::uint8_t>(first.address), 0, 2, 4, 0, 7, 0, 9}),
            (Bytes{16, 0, static_cast<std::uint8_t>(first.address), 0, 2}));
  EXPECT_EQ(bench.door.value(bench.point("U16.W")), 9);
  EXPECT_EQ(bench.door.writes(), 1U);
}

TEST(Responder, APartOfAWideValueIsNotWritten) {
  ResponderBench bench;
  const auto at = static_cast<std::uint8_t>(bench.at("R64.W").address);
  const auto after = [&](unsigned n) { return static_cast<std::uint8_t>(at + n); };
  EXPECT_EQ(bench.ask({6, 0, at, 0, 1}), (Bytes{0x86, 2}));
  EXPECT_EQ(bench.ask({16, 0, at, 0, 2, 4, 0, 1, 0, 2}), (Bytes{0x90, 2}));
  EXPECT_EQ(bench.ask({16, 0, after(2), 0, 2, 4, 0, 1, 0, 2}), (Bytes{0x90, 2}));
  EXPECT_EQ(bench.ask({22, 0, after(1), 0, 0, 0, 1}), (Bytes{0x96, 2}));
  EXPECT_EQ(bench.ask({23, 0, at, 0, 1, 0, after(3), 0, 1, 2, 0, 1}), (Bytes{0x97, 2}));
  EXPECT_EQ(bench.door.writes(), 0U);
  EXPECT_EQ(bench.ask({3, 0, after(1), 0, 2}).size(), 6U) << "a part may be read";
}

TEST(Responder, AClientThatMayOnlyReadHasNoWritingFunctions) {
  ResponderBench bench;
  const Caller reader{.rights = Rights{}.without_writes()};
  for (const int function : {5, 6, 15, 16, 22, 23}) {
    std::mt19937 random(9);
    const Bytes pdu = request_of(function, 12, random);
    EXPECT_EQ(bench.ask(pdu, reader), (Bytes{static_cast<std::uint8_t>(128 + function), 1}));
  }
  EXPECT_EQ(bench.ask({3, 0, 0, 0, 1}, reader).size(), 4U);
  EXPECT_EQ(bench.door.writes(), 0U);
}

TEST(Responder, OtherRefusalsComeAfterTheChecks) {
  ResponderBench bench;
  const Caller guest{.other_owns_writes = true};
  EXPECT_EQ(bench.ask(bench.write_request("I16.W", 5), guest), (Bytes{0x90, 6}));
  EXPECT_EQ(bench.ask(bench.write_request("I16.W", 5000), guest), (Bytes{0x90, 3}));
  EXPECT_EQ(bench.ask({6, 0x20, 0, 0, 5}, guest), (Bytes{0x86, 2}));
  bench.door.refuse("I16.W is not now");
  EXPECT_EQ(bench.ask(bench.write_request("I16.W", 5)), (Bytes{0x90, 4}));
  EXPECT_EQ(bench.responder.take_refusal(), "I16.W is not now");
  bench.door.refuse("");
  EXPECT_EQ(bench.ask(bench.write_request("I16.W", 5)).at(0), 16);
  EXPECT_EQ(bench.door.writes(), 1U);
}

TEST(Responder, LongIdentificationGoesOnWhereItStopped) {
  test::MemoryDoor door(test::points_of_every_type());
  const std::string title(190, 'T');
  const RegisterMap map = make_register_map(door.points(), {.title = title});
  Responder responder(map, door, {.vendor = std::string(500, 'V'), .product = "P", .revision = "R"});
  std::map<int, std::string> objects;
  std::uint8_t from = 0;
  for (int round = 0; round < 6; ++round) {
    const Bytes request{43, 14, 3, from};
    const Reply reply = responder.answer(request, {});
    const auto pdu = reply.pdu();
    ASSERT_LE(pdu.size(), longest_pdu);
    std::size_t at = 7;
    for (int i = 0; i < pdu[6]; ++i) {
      objects[pdu[at]] =
          std::string(pdu.begin() + static_cast<long>(at) + 2, pdu.begin() + static_cast<long>(at) + 2 + pdu[at + 1]);
      at += 2U + pdu[at + 1];
    }
    EXPECT_EQ(at, pdu.size());
    if (pdu[4] == 0) {
      break;
    }
    from = pdu[5];
  }
  EXPECT_EQ(objects,
            (std::map<int, std::string>{
                {0, std::string(200, 'V')}, {1, "P"}, {2, "R"}, {4, title}, {128, map.hash()}, {129, "ABCD"}}));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
