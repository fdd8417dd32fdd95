// Points that lie on the server, and values that lie on a device, in formats and at addresses of one's choice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/modbus/device.hpp"
#include "runtime/modbus/discovery.hpp"
#include "runtime/modbus/map_text.hpp"
#include "runtime/modbus/responder.hpp"
#include "runtime/modbus/server.hpp"
#include "support/errors.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Octets = std::vector<std::uint8_t>;

std::vector<Point> plant_points() {
  using enum PointKind;
  return {{.name = "TEMPERATURE", .kind = output, .unit = "degC"},
          {.name = "LEVEL", .kind = output},
          {.name = "SET", .kind = input, .low = 0.0, .high = 0.3, .writable = true},
          {.name = "COUNT", .kind = input, .type = PointType::int32, .writable = true},
          {.name = "READY", .kind = output, .type = PointType::boolean},
          {.name = "ENABLE", .kind = input, .type = PointType::boolean, .writable = true},
          {.name = "RESET", .kind = input, .type = PointType::boolean, .writable = true}};
}

GivenRegister given(std::string name, std::string address, GivenFormat format) {
  return {.name = std::move(name),
          .address = std::move(address),
          .format = format,
          .place = {.file = "RUN.toml", .line = 3}};
}

MapRequest plant_request() {
  return {
      .title = "PLANT",
      .given = {given("TEMPERATURE", "input 100", {.type = PointType::int16, .scale = 0.1, .offset = -50.0}),
                given("LEVEL", "input 102", {.type = RegisterType(PointType::uint32, true), .order = WordOrder::cdab}),
                given("SET", "holding 7", {.type = PointType::uint16, .scale = 0.1}),
                given("COUNT", "holding 8", {.type = PointType::real32}), given("READY", "input 104.9", {}),
                given("ENABLE", "holding 10.0", {}), given("RESET", "holding 10.7", {})}};
}

struct PlantBench {
  PlantBench()
      : door(plant_points()), map(make_register_map(door.points(), plant_request())), responder(map, door, {}) {}
  Octets ask(const Octets& pdu) {
    const Reply reply = responder.answer(pdu, {});
    return {reply.pdu().begin(), reply.pdu().end()};
  }
  test::MemoryDoor door;
  RegisterMap map;
  Responder responder;
};

TEST(FormattedPoints, AreReadAsTheirFormatsSay) {
  PlantBench bench;
  bench.door.set(0, 21.52);
  bench.door.set(1, 12345678.4);
  bench.door.set(4, 1.0);
  EXPECT_EQ(bench.ask({4, 0, 100, 0, 1}), (Octets{4, 2, 715 >> 8, 715 & 255})) << "(21.52 + 50)/0.1, the nearest";
  EXPECT_EQ(bench.ask({4, 0, 102, 0, 3}), (Octets{4, 6, 0x56, 0x78, 0x12, 0x34, 0x02, 0x00}));
  EXPECT_EQ(bench.ask({4, 0, 103, 0, 1}), (Octets{4, 2, 0x12, 0x34})) << "a part of a wide value may be read";
  EXPECT_EQ(bench.ask({4, 0, 100, 0, 3}), (Octets{0x84, 2})) << "no point lies at 101";
  EXPECT_EQ(bench.responder.saturated(), 0U);
}

TEST(FormattedPoints, WhatDoesNotFitIsSaturatedAndCountedAndNaNIsNoNumber) {
  PlantBench bench;
  bench.door.set(0, 1e6);
  EXPECT_EQ(bench.ask({4, 0, 100, 0, 1}), (Octets{4, 2, 0x7F, 0xFF}));
  bench.door.set(0, -HUGE_VAL);
  EXPECT_EQ(bench.ask({4, 0, 100, 0, 1}), (Octets{4, 2, 0x80, 0x00}));
  EXPECT_EQ(bench.responder.saturated(), 2U);
  EXPECT_EQ(bench.map.points()[bench.responder.saturated_point()].name, "TEMPERATURE");
  bench.door.set(0, std::nan(""));
  EXPECT_EQ(bench.ask({4, 0, 100, 0, 1}), (Octets{0x84, 4}));
}

TEST(FormattedPoints, AreWrittenWithinTheirLimitsAndTheirType) {
  PlantBench bench;
  EXPECT_EQ(bench.ask({6, 0, 7, 0, 3}), (Octets{6, 0, 7, 0, 3}));
  EXPECT_EQ(bench.door.value(2), 0.3) << "three steps of 0.1 are the limit";
  EXPECT_EQ(bench.ask({6, 0, 7, 0, 4}), (Octets{0x86, 3}));
  EXPECT_EQ(bench.ask({16, 0, 8, 0, 2, 4, 0x41, 0x20, 0, 0}), (Octets{16, 0, 8, 0, 2}));
  EXPECT_EQ(bench.door.value(3), 10.0);
  EXPECT_EQ(bench.ask({16, 0, 8, 0, 2, 4, 0x41, 0x28, 0, 0}), (Octets{0x90, 3})) << "10.5 is no DINT";
  EXPECT_EQ(bench.ask({6, 0, 8, 0x41, 0x20}), (Octets{0x86, 2})) << "a part of a wide value";
  EXPECT_EQ(bench.ask({16, 0, 7, 0, 2, 4, 0, 1, 0x41, 0x20}), (Octets{0x90, 2})) << "whole, and a part";
  EXPECT_EQ(bench.door.value(2), 0.3);
}

TEST(FormattedPoints, BitsOfARegisterAreWrittenTogetherAndNoOtherBitIsLost) {
  PlantBench bench;
  EXPECT_EQ(bench.ask({6, 0, 10, 0, 0x81}), (Octets{6, 0, 10, 0, 0x81}));
  EXPECT_EQ(bench.door.value(5) + 2 * bench.door.value(6), 3.0);
  EXPECT_EQ(bench.ask({6, 0, 10, 0, 0x83}), (Octets{0x86, 3})) << "bit 1 is no point's";
  EXPECT_EQ(bench.ask({22, 0, 10, 0xFF, 0xFE, 0, 0}), (Octets{22, 0, 10, 0xFF, 0xFE, 0, 0})) << "clears bit 0";
  EXPECT_EQ(bench.door.value(5) + 2 * bench.door.value(6), 2.0);
  EXPECT_EQ(bench.ask({22, 0, 10, 0xFF, 0xFF, 0, 2}), (Octets{22, 0, 10, 0xFF, 0xFF, 0, 2})) << "keeps all";
  EXPECT_EQ(bench.ask({22, 0, 10, 0xFF, 0xFD, 0, 2}), (Octets{0x96, 3})) << "sets bit 1";
  EXPECT_EQ(bench.ask({3, 0, 10, 0, 1}), (Octets{3, 2, 0, 0x80}));
}

/// Number and cause of every error.
std::string refusal(const MapRequest& request) {
  std::string all;
  try {
    (void)make_register_map(plant_points(), request);
  } catch (const InputError& refused) {
    for (const Diagnostic& one : refused.diagnostics().all()) {
      all += std::to_string(one.number) + " " + one.cause + "\n";
    }
  }
  return all;
}

TEST(FormattedPoints, OverlapsAndUnfitFormatsAreRefusedByName) {
  const auto with = [](std::vector<GivenRegister> list) { return MapRequest{.title = "T", .given = std::move(list)}; };
  EXPECT_EQ(refusal(with({given("COUNT", "holding 8", {.type = PointType::real32}),
                          given("SET", "holding 9", {.type = PointType::int16})})),
            "820 SET is given holding 9, which COUNT has.\n");
  EXPECT_EQ(refusal(with({given("SET", "holding 9", {.type = PointType::int16}), given("ENABLE", "holding 9.15", {})})),
            "820 ENABLE is given holding 9.15, which SET has.\n");
  EXPECT_EQ(refusal(with({given("ENABLE", "holding 9.3", {}), given("RESET", "holding 9.3", {})})),
            "820 RESET is given holding 9.3, which ENABLE has.\n");
  EXPECT_EQ(refusal(with({given("SET", "", {.scale = 0.0})})),
            "860 SET has the scale 0 and the offset 0, and a scale is a finite number that is not 0.\n");
  EXPECT_EQ(refusal(with({given("SET", "", {.type = PointType::boolean})})),
            "860 SET is a real64, which no boolean holds.\n");
  EXPECT_EQ(refusal(with({given("SET", "", {.type = PointType::int16, .order = WordOrder::cdab})})),
            "860 SET lies in one register, which has no word order.\n");
  EXPECT_EQ(refusal(with({given("SET", "holding 9.3", {})})),
            "825 SET is a writable real64 and does not fit holding 9.3.\n");
  EXPECT_EQ(refusal(with({given("READY", "coil 3.1", {})})), "824 coil 3.1 is no address.\n");
  EXPECT_EQ(refusal(with({given("NONE", "", {.scale = 2.0})})), "826 A format is given to NONE, which is no point.\n");
  EXPECT_EQ(refusal(with({given("SET", "%MD3", {.type = PointType::real32})})), "")
      << "the width is that of the format";
}

/// What is wrong is said, and nothing that follows from it.
TEST(FormattedPoints, AnUnfitFormatMakesNoOverlap) {
  const MapRequest request{
      .title = "T",
      .given = {given("SET", "holding 8", {.scale = 0.0}), given("COUNT", "holding 9", {.type = PointType::int16})},
      .lock_file = "a.lock",
      .lock_text = "input 12 real64 TEMPERATURE\nholding 8 real64 SET\n"};
  EXPECT_EQ(refusal(request),
            "860 SET has the scale 0 and the offset 0, and a scale is a finite number that is not 0.\n");
}

/// A range that is declared and does not fit is a warning, of each limit, and none where it fits.
TEST(FormattedPoints, AFormatThatDoesNotHoldTheDeclaredRangeIsSaid) {
  const std::vector<Point> points{
      {.name = "FLOW", .kind = PointKind::output, .low = -10.0, .high = 10.0},
      {.name = "SET", .kind = PointKind::parameter, .low = 0.0, .high = 400.0, .writable = true},
      {.name = "ANY", .kind = PointKind::output}};
  const auto warnings = [&](const std::string& name, GivenFormat format) {
    std::vector<std::string> all;
    const auto map = make_register_map(points, {.title = "T", .given = {given(name, "", format)}});
    for (const Diagnostic& one : map.warnings().all()) {
      EXPECT_EQ(one.severity, Severity::Warning);
      EXPECT_EQ(one.place.line, 3U);
      all.push_back(one.cause);
    }
    return all;
  };
  using ::testing::ElementsAre;
  using ::testing::IsEmpty;
  EXPECT_THAT(warnings("FLOW", {.type = PointType::uint16, .scale = 0.001}),
              ElementsAre("FLOW goes from -10 to 10, and its format, uint16, reaches 0 to 65.535 alone."));
  EXPECT_THAT(warnings("FLOW", {.type = PointType::int16, .scale = 0.001}), IsEmpty());
  EXPECT_THAT(warnings("FLOW", {.type = PointType::int16, .scale = 0.0003}), testing::SizeIs(1));
  EXPECT_THAT(warnings("SET", {.type = RegisterType(PointType::uint16, true), .scale = 0.01}),
              ElementsAre("SET goes from 0 to 400, and its format, bcd16, reaches 0 to 99.99 alone."));
  EXPECT_THAT(warnings("SET", {.type = PointType::int16, .scale = -0.1}), testing::SizeIs(0))
      << "3276.7 down to -3276.8";
  EXPECT_THAT(warnings("SET", {.type = PointType::real32}), IsEmpty());
  EXPECT_THAT(warnings("ANY", {.type = PointType::uint16}), IsEmpty()) << "no range is declared";
}

/// The mend names an address that would do, beside the one that was meant.
TEST(FormattedPoints, TheMendOfAnUnfitAddressFitsThePoint) {
  const auto mend = [](const std::string& name, const std::string& address, GivenFormat format = {}) {
    try {
      (void)make_register_map(plant_points(), {.title = "T", .given = {given(name, address, format)}});
    } catch (const InputError& refused) {
      const Diagnostic& first = refused.diagnostics().all().front();
      EXPECT_EQ(first.number, 825) << first.cause;
      return first.mend;
    }
    return std::string();
  };
  EXPECT_EQ(mend("ENABLE", "holding 102"),
            "write a bit of the register, holding 102.0 (0 is the lowest, 15 the highest), or coil 102.");
  EXPECT_EQ(mend("READY", "input 102"),
            "write a bit of the register, input 102.0 (0 is the lowest, 15 the highest), or discrete 102.");
  EXPECT_EQ(mend("ENABLE", "discrete 7"), "write coil 7, which may be written.");
  EXPECT_EQ(mend("SET", "coil 7"), "write holding 7; it takes 4 registers from there on, as %ML0 and its like do.");
  EXPECT_EQ(mend("SET", "holding 9.3", {.type = PointType::int16}),
            "write holding 9; it takes one register from there on.");
  // What it says is taken.
  EXPECT_EQ(mend("ENABLE", "holding 102.0") + mend("ENABLE", "coil 102") + mend("READY", "discrete 102") +
                mend("SET", "holding 7"),
            "");
}

TEST(FormattedPoints, ALockFileAndTheDiscoveryTellThem) {
  const PlantBench bench;
  const std::string lock = lock_text(bench.map);
  EXPECT_NE(lock.find("input 100 int16 TEMPERATURE\ninput 102 bcd32 LEVEL\ninput 104.9 boolean READY\n"),
            std::string::npos)
      << lock;
  MapRequest again = plant_request();
  for (GivenRegister& one : again.given) {
    one.address.clear();  // the lock file has it
  }
  again.lock_file = "t.lock";
  again.lock_text = lock;
  const RegisterMap map = make_register_map(plant_points(), again);
  EXPECT_EQ(lock_text(map), lock);
  EXPECT_EQ(map.hash(), bench.map.hash());
  const auto found = read_chain(map.chain());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->points.size(), map.entries().size());
  for (std::size_t i = 0; i < map.entries().size(); ++i) {
    EXPECT_EQ(found->points[i].at, map.entries()[i].at);
    EXPECT_EQ(found->points[i].format, map.entries()[i].format) << found->points[i].point.name;
  }
  EXPECT_NE(as_csv(map).find("input,102,2,bcd32,LEVEL,"), std::string::npos);
  EXPECT_NE(as_markdown(map).find("| int16, 0.1·raw - 50 | TEMPERATURE |"), std::string::npos) << as_markdown(map);
  EXPECT_NE(as_markdown(map).find("| input | 104.9 | 300105.9 | boolean | READY |"), std::string::npos);
  MapRequest other = again;
  other.given[0].format->scale = 0.2;
  EXPECT_NE(make_register_map(plant_points(), other).hash(), map.hash()) << "a client relies on the scale";
}

TEST(FormattedPoints, OnlyWhatIsExposedHasAnAddressAndItComesBackToIt) {
  const MapRequest all{.title = "T"};
  const std::string lock = lock_text(make_register_map(plant_points(), all));
  const RegisterMap few = make_register_map(
      plant_points(), {.title = "T", .expose = {"SET", "RE*"}, .lock_file = "t.lock", .lock_text = lock});
  std::string names;
  for (const MapEntry& entry : few.entries()) {
    names += few.point_of(entry).name + " ";
  }
  EXPECT_EQ(names, "RESET READY SET ");
  EXPECT_EQ(read_chain(few.chain())->points.size(), 3U);
  const RegisterMap back =
      make_register_map(plant_points(), {.title = "T", .lock_file = "t.lock", .lock_text = lock_text(few)});
  EXPECT_EQ(lock_text(back), lock) << "nobody else had their addresses meanwhile";
  EXPECT_EQ(refusal({.title = "T", .expose = {"SET", "X*", "NONE"}}),
            "861 expose names X*, which is no point.\n861 expose names NONE, which is no point.\n");
  EXPECT_EQ(refusal({.title = "T", .expose = {"SET"}, .given = {given("COUNT", "holding 8", {})}}),
            "826 COUNT has a place on the map, and expose does not name it.\n");
}

std::vector<Point> many_points(std::size_t count) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({.name = "STATION_" + std::to_string(i) + ".VALUE", .unit = "m3/h", .writable = i % 2 == 0});
  }
  return points;
}

/// The chain as a client reads it by function 20, in requests of up to 120 records.
std::vector<std::uint16_t> read_by_files(Responder& responder, std::uint32_t size) {
  std::vector<std::uint16_t> words;
  while (words.size() < size) {
    const std::size_t at = words.size();
    const std::size_t record = at % records_of_file;
    const std::size_t count = std::min({std::size_t{120}, size - at, records_of_file - record});
    const auto file = static_cast<std::uint8_t>(1 + at / records_of_file);
    const Octets request{20,
                         7,
                         6,
                         0,
                         file,
                         static_cast<std::uint8_t>(record >> 8U),
                         static_cast<std::uint8_t>(record & 255U),
                         0,
                         static_cast<std::uint8_t>(count)};
    const Reply reply = responder.answer(request, {});
    if (reply.exception != Exception::none || reply.size != 4 + 2 * count) {
      return {};
    }
    for (std::size_t i = 0; i < count; ++i) {
      words.push_back(static_cast<std::uint16_t>(reply.bytes[4 + 2 * i] << 8U | reply.bytes[5 + 2 * i]));
    }
  }
  return words;
}

TEST(Discovery, OfManyPointsIsReadInFiles) {
  for (const std::size_t count : {std::size_t{3}, std::size_t{800}, std::size_t{1200}, std::size_t{6000}}) {
    test::MemoryDoor door(many_points(count));
    const RegisterMap map = make_register_map(door.points(), {.title = "T"});
    Responder responder(map, door, {});
    const auto entrance = read_chain(map.chain_registers());
    ASSERT_TRUE(entrance);
    EXPECT_EQ(entrance->hash, map.hash().substr(0, 32));
    EXPECT_EQ(entrance->points.size(), count < 1000 ? count : 0);
    EXPECT_EQ(entrance->in_files, count < 1000 ? 0 : map.chain().size());
    EXPECT_LE(chain_address + map.chain_registers().size(), 0x10000U);
    const auto words = read_by_files(responder, static_cast<std::uint32_t>(map.chain().size()));
    const auto found = read_chain(words);
    ASSERT_TRUE(found) << count;
    EXPECT_EQ(found->points.size(), count);
    EXPECT_EQ(found->points.back().point.name, map.point_of(map.entries().back()).name);
  }
}

TEST(Discovery, WithoutItItsAddressesAreThePoints) {
  MapRequest request{.title = "T", .has_discovery = false, .given = {given("COUNT", "holding 65534", {})}};
  test::MemoryDoor door(plant_points());
  const RegisterMap map = make_register_map(door.points(), request);
  EXPECT_TRUE(map.chain().empty());
  Responder responder(map, door, {});
  EXPECT_EQ(responder.answer(Octets{3, 0xFF, 0xFE, 0, 2}, {}).exception, Exception::none);
  EXPECT_EQ(responder.answer(Octets{3, 0x9C, 0x40, 0, 1}, {}).exception, Exception::illegal_address);
  EXPECT_EQ(responder.answer(Octets{20, 7, 6, 0, 1, 0, 0, 0, 1}, {}).exception, Exception::illegal_address);
  request.has_discovery = true;
  EXPECT_EQ(refusal(request).substr(0, 3), "823");
}

/// Registers as a device has them, plain numbers of 16 bits: 0 to 7 are read, 8 to 15 are written.
class RegisterDevice {
 public:
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  void give(std::size_t address, std::uint16_t word) { door_.set(address, word); }
  [[nodiscard]] std::uint16_t holds(std::size_t address) { return static_cast<std::uint16_t>(door_.value(address)); }

 private:
  static std::vector<Point> registers() {
    std::vector<Point> points;
    for (int i = 0; i < 16; ++i) {
      points.push_back({.name = "R" + std::to_string(i), .type = PointType::uint16, .writable = true});
    }
    return points;
  }
  test::MemoryDoor door_{registers()};
  Server server_{make_register_map(door_.points(), {.title = "D"}), door_, {.port = 0}};
};

RemoteValue value_at(std::uint32_t address, const PointFormat& format, bool written, std::int8_t bit = no_bit) {
  return {.at = {.address = address, .count = static_cast<std::uint32_t>(registers_of(format.type)), .bit = bit},
          .format = format,
          .written = written};
}

TEST(FormattedDevice, ValuesAreReadAsTheDeviceHasThem) {
  RegisterDevice registers;
  const PointFormat boolean{.type = PointType::boolean};
  Device device({.link = TcpLink{.port = registers.port()},
                 .values = {value_at(0, {.type = PointType::int16, .scale = 0.01, .offset = -5.0}, false),
                            value_at(1, {.type = RegisterType(PointType::uint16, true)}, false),
                            value_at(2, {.type = PointType::real32, .order = WordOrder::dcba}, false),
                            value_at(4, boolean, false, 0), value_at(4, boolean, false, 15),
                            value_at(4, {.type = PointType::uint16}, false)}},
                {.own_thread = false});
  registers.give(0, 0xFF9C);  // -100
  registers.give(1, 0x0815);
  registers.give(2, 0x0000);
  registers.give(3, 0x803F);  // 1.0F is 3F80 0000; low word first, bytes swapped
  registers.give(4, 0x8000);
  ASSERT_TRUE(device.round());
  EXPECT_EQ(device.read(0).value, -6.0);
  EXPECT_EQ(device.read(1).value, 815.0);
  EXPECT_EQ(device.read(2).value, 1.0);
  EXPECT_EQ(device.read(3).value, 0.0);
  EXPECT_EQ(device.read(4).value, 1.0);
  EXPECT_EQ(device.read(5).value, 32768.0) << "the whole register, too";
  EXPECT_EQ(device.status().answers, 1U) << "all of it in one request";
  registers.give(1, 0x081A);
  ASSERT_TRUE(device.round());
  EXPECT_EQ(device.read(1).quality, Quality::refused) << "A is no decimal digit";
  EXPECT_EQ(device.read(1).value, 815.0);
  EXPECT_EQ(device.read(0).quality, Quality::good);
  EXPECT_EQ(device.not_taken(), 1U);
}

TEST(FormattedDevice, ALimitIsAsTheTypeOnTheDeviceCanTellItAndAWholeInputTakesNoFraction) {
  RegisterDevice registers;
  RemoteValue limited = value_at(0, {.type = PointType::real32}, false);
  limited.low = -0.7;
  limited.high = 0.1;
  RemoteValue whole = value_at(2, {.type = PointType::int16, .scale = 0.5}, false);
  whole.of = PointType::int32;
  Device device({.link = TcpLink{.port = registers.port()}, .values = {limited, whole}}, {.own_thread = false});
  const auto reads = [&](std::uint32_t bits, std::uint16_t halves) {
    registers.give(0, static_cast<std::uint16_t>(bits >> 16U));
    registers.give(1, static_cast<std::uint16_t>(bits & 0xFFFFU));
    registers.give(2, halves);
    EXPECT_TRUE(device.round());
  };
  reads(std::bit_cast<std::uint32_t>(0.1F), 4);
  EXPECT_EQ(device.read(0).quality, Quality::good);
  EXPECT_EQ(device.read(0).value, 0.1) << "no more than the limit";
  EXPECT_EQ(device.read(1).value, 2.0);
  reads(std::bit_cast<std::uint32_t>(std::nextafter(0.1F, 1.0F)), 5);
  EXPECT_EQ(device.read(0).quality, Quality::refused);
  EXPECT_EQ(device.read(1).quality, Quality::refused) << "2.5 is no DINT";
}

TEST(FormattedDevice, ValuesAreWrittenAsTheDeviceHasThem) {
  RegisterDevice registers;
  const PointFormat boolean{.type = PointType::boolean};
  Device device(
      {.link = TcpLink{.port = registers.port()},
       .values = {value_at(8, {.type = PointType::int16, .scale = -0.5}, true),
                  value_at(9, {.type = RegisterType(PointType::uint32, true), .order = WordOrder::cdab}, true),
                  value_at(11, boolean, true, 3), value_at(11, boolean, true, 15)}},
      {.own_thread = false});
  for (const auto& [value, number] : {std::pair(std::size_t{0}, 50.2), {1, 12345678.0}, {2, 1.0}, {3, 1.0}}) {
    device.write(value, number);
  }
  ASSERT_TRUE(device.round());
  EXPECT_EQ(registers.holds(8), 0xFF9C) << "50.2/-0.5, the nearest";
  EXPECT_EQ(registers.holds(9), 0x5678);
  EXPECT_EQ(registers.holds(10), 0x1234);
  EXPECT_EQ(registers.holds(11), 0x8008);
  EXPECT_EQ(device.status().answers, 1U) << "all of it in one request";
  EXPECT_TRUE(device.has_taken(0, 50.2));
  device.write(0, 1e9);
  device.write(3, 0.0);
  ASSERT_TRUE(device.round());
  EXPECT_EQ(registers.holds(8), 0x8000) << "saturated";
  EXPECT_EQ(registers.holds(11), 0x0008);
  device.write(0, std::nan(""));
  device.write(2, 0.0);
  ASSERT_TRUE(device.round());
  EXPECT_EQ(registers.holds(8), 0x8000) << "what is not a number is not written";
  EXPECT_FALSE(device.has_taken(0, std::nan("")));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
