// The client role against a device that does everything wrong, and over a serial line.
#include "runtime/modbus/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "runtime/modbus/server.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "tests/runtime/modbus/bad_device.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/serial_device.hpp"

namespace hysteron::runtime::modbus {
namespace {

using std::chrono::milliseconds;
using test::BadServer;
using test::Fault;

constexpr milliseconds response{60};

using test::soon;

DeviceOptions one_register(std::uint16_t port) {
  return test::one_register(port, response);
}

class BadDevice : public ::testing::TestWithParam<std::pair<Fault, std::string_view>> {};

TEST_P(BadDevice, NeverGivesAWrongValueAndIsUsedAgainWhenItIsSound) {
  const auto result = test::meet(GetParam().first, 4, 3, 2, response);
  EXPECT_GE(result.met, 6U);
  EXPECT_EQ(result.wrong, 0U);
  EXPECT_EQ(result.recovered, 3U);
  EXPECT_GT(result.status.connections, 1U) << "every fault ends the connection";
  EXPECT_GT(result.status.timeouts + result.status.closed + result.status.wrong_answers + result.status.no_link, 0U);
}

INSTANTIATE_TEST_SUITE_P(Faults, BadDevice, ::testing::ValuesIn(test::link_faults), [](const auto& fault) {
  std::string name(fault.param.second);
  std::ranges::replace(name, ' ', '_');
  return name;
});

TEST(Device, AnExceptionRefusesTheValueAndKeepsTheLink) {
  BadServer server(response);
  const Device device(one_register(server.port()));
  ASSERT_TRUE(soon([&] { return device.read(0).quality == Quality::good; }));
  const auto failures = [&] {
    const DeviceStatus now = device.status();
    return now.timeouts + now.closed + now.wrong_answers;
  };
  const auto before = failures();
  for (std::uint8_t code = 1; code <= 11; ++code) {
    const auto seen = device.status().exceptions;
    server.set(Fault::exception, code);
    EXPECT_TRUE(soon([&] { return device.status().exceptions > seen + 1; }));
    EXPECT_EQ(device.read(0).quality, Quality::refused);
    EXPECT_EQ(device.read(0).value, test::right_value);
  }
  server.set(Fault::none);
  EXPECT_TRUE(soon([&] { return device.read(0).quality == Quality::good; }));
  EXPECT_EQ(failures(), before);
}

TEST(Device, ADeadOneNeverSlowsAnother) {
  BadServer dead_server(response);
  dead_server.set(Fault::black_hole);
  BadServer live_server(response);
  DeviceOptions slow = one_register(dead_server.port());
  slow.response = milliseconds(20'000);
  const Device dead(slow);
  const Device live(one_register(live_server.port()));
  EXPECT_TRUE(soon([&] { return live.status().answers >= 200; }));
  EXPECT_EQ(dead.status().answers, 0U);
  EXPECT_EQ(dead.status().timeouts, 0U) << "it is still waiting for its first answer";
  EXPECT_EQ(dead.read(0).quality, Quality::never);
}

TEST(Device, OneThatIsNotThereIsTriedAgainMoreAndMoreRarely) {
  std::uint16_t port = 0;
  { port = port_of(listen_on("127.0.0.1", 0, {})); }
  const Device device(one_register(port));
  EXPECT_TRUE(soon([&] { return device.status().no_link >= 4; }));
  EXPECT_EQ(device.status().connections, 0U);
  EXPECT_EQ(device.read(0).quality, Quality::never);
}

TEST(Device, AgeAndQualityOfALostValue) {
  auto server = std::make_unique<BadServer>(response);
  DeviceOptions options = one_register(server->port());
  const Device device(options);
  ASSERT_TRUE(soon([&] { return device.read(0).quality == Quality::good; }));
  server.reset();
  EXPECT_TRUE(soon([&] { return device.read(0).quality == Quality::lost; }));
  const RemoteReading first = device.read(0);
  std::this_thread::sleep_for(milliseconds(5));
  EXPECT_GT(device.read(0).age, first.age);
  EXPECT_EQ(first.value, test::right_value);
}

TEST(Device, WhatCannotBeWrittenIsRefusedAtTheStart) {
  const auto with = [](RemoteValue value) { return DeviceOptions{.values = {value}}; };
  using A = Area;
  EXPECT_THROW(Device(with({.at = {A::input_register, 0, 1}, .written = true})), std::invalid_argument);
  EXPECT_THROW(Device(with({.at = {A::coil, 0, 1}, .format = {.type = PointType::int16}})), std::invalid_argument);
  EXPECT_THROW(Device(with({.at = {A::holding_register, 0xFFFF, 2}, .format = {.type = PointType::real32}})),
               std::invalid_argument);
}

/// All types both ways against our own server: what is written to the one half is read back bit by bit.
void expect_values_to_cross(const DeviceOptions& to, const RegisterMap& map, test::MemoryDoor& door) {
  DeviceOptions options = to;
  std::vector<std::size_t> points;
  for (const bool written : {false, true}) {
    for (const MapEntry& entry : map.entries()) {
      if (!written || map.point_of(entry).writable) {
        options.values.push_back({.at = entry.at, .format = entry.format, .written = written});
        points.push_back(entry.point);
      }
    }
  }
  Device device(options);
  const auto value_of_point = [&](std::size_t point) {
    const Point& about = map.points()[point];
    return about.type == PointType::boolean  ? static_cast<double>(point % 2)
           : about.type == PointType::real64 ? 0.1 + static_cast<double>(point)
                                             : 100.0 + static_cast<double>(point);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (options.values[i].written) {
      device.write(i, value_of_point(points[i]));
    } else if (!map.points()[points[i]].writable) {
      door.set(points[i], value_of_point(points[i]));
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(soon([&] { return device.read(i).value == value_of_point(points[i]); }))
        << map.points()[points[i]].name;
    EXPECT_EQ(door.value(points[i]), value_of_point(points[i]));
  }
}

TEST(Device, EveryTypeAndWordOrderOverTcp) {
  for (const WordOrder order : word_orders) {
    test::MemoryDoor door(test::points_of_every_type());
    const Server server(make_register_map(door.points(), {.title = "T", .order = order}), door, {.port = 0});
    expect_values_to_cross({.link = TcpLink{.port = server.port()}, .period = milliseconds(5)}, *server.map(), door);
  }
}

TEST(Device, EveryTypeOverASerialLine) {
  test::MemoryDoor door(test::points_of_every_type());
  const RegisterMap map = make_register_map(door.points(), {.title = "T"});
  Responder responder(map, door, {});
  const test::SerialDevice line(responder);
  expect_values_to_cross({.link = SerialLink{.path = line.path(), .baud = 115200},
                          .unit = 7,
                          .period = milliseconds(5),
                          .response = milliseconds(2000)},
                         map, door);
}

/// A device on a serial line that is in such trouble.
struct TroubledLine {
  explicit TroubledLine(test::LineTrouble trouble, bool has_echo) : line(responder, trouble) {
    options = {
        .link = SerialLink{.path = line.path(), .baud = 115200, .has_echo = has_echo},
        .unit = 7,
        .values = {{.at = {Area::holding_register, 0, 4}, .format = {.type = PointType::int64}},
                   {.at = {Area::holding_register, 4, 4}, .format = {.type = PointType::uint64}, .written = true}},
        .response = milliseconds(1000)};
  }
  test::MemoryDoor door{test::points_of_every_type()};
  RegisterMap map{make_register_map(door.points(), {.title = "T"})};
  Responder responder{map, door, {}};
  test::SerialDevice line;
  DeviceOptions options;
};

TEST(Device, AnEchoIsTakenAwayAndADamagedOneIsAWrongAnswer) {
  TroubledLine sound({.has_echo = true}, true);
  Device device(sound.options, {.own_thread = false});
  device.write(1, 815.0);
  EXPECT_TRUE(device.round());
  EXPECT_TRUE(device.round());
  EXPECT_EQ(device.status().answers, 4U);
  EXPECT_EQ(sound.door.writes(), 2U);
  TroubledLine damaged({.has_echo = true, .bad_echo = true}, true);
  Device unlucky(damaged.options, {.own_thread = false});
  EXPECT_FALSE(unlucky.round());
  EXPECT_EQ(unlucky.status().wrong_answers, 1U);
  TroubledLine unexpected({.has_echo = true}, false);
  Device surprised(unexpected.options, {.own_thread = false});
  EXPECT_FALSE(surprised.round()) << "what was sent is no answer";
}

TEST(Device, AWrongChecksumIsCountedAsSuch) {
  TroubledLine line({.bad_checksum = true}, false);
  Device device(line.options, {.own_thread = false});
  EXPECT_FALSE(device.round());
  EXPECT_EQ(device.status().bad_checksums, 1U);
  EXPECT_EQ(device.status().answers, 0U);
}

TEST(Device, UnitsBehindAGatewayShareOneConnection) {
  test::MemoryDoor door(test::points_of_every_type());
  const RegisterMap map = make_register_map(door.points(), {.title = "T"});
  const Server gateway(map, door, {.port = 0, .connections = 1});
  std::vector<DeviceOptions> options;
  for (const int unit : {1, 2, 247, 255}) {
    options.push_back({.link = TcpLink{.port = gateway.port()},
                       .unit = static_cast<std::uint8_t>(unit),
                       .shares_connection = true,
                       .values = {{.at = {Area::holding_register, 18, 1}}},
                       .period = milliseconds(1),
                       .response = milliseconds(5000)});
  }
  const auto links = shared_links(options);
  EXPECT_EQ(std::set(links.begin(), links.end()).size(), 1U);
  options.push_back({.link = TcpLink{.port = gateway.port()}});
  EXPECT_EQ(shared_links(options).back(), nullptr) << "it has not asked to share";
  options.back().shares_connection = true;
  options.back().link = TcpLink{.host = "localhost", .port = gateway.port()};
  EXPECT_NE(shared_links(options).back(), shared_links(options).front()) << "another address";
  std::vector<std::unique_ptr<Device>> units;
  for (std::size_t i = 0; i < 4; ++i) {
    units.push_back(std::make_unique<Device>(options[i], DeviceWork{.link = links[i]}));
  }
  for (const auto& unit : units) {
    EXPECT_TRUE(soon([&] { return unit->status().answers >= 50; }));
    const DeviceStatus status = unit->status();
    EXPECT_EQ(status.timeouts + status.wrong_answers + status.closed + status.no_link, 0U);
  }
  EXPECT_EQ(gateway.status().accepted, 1U);
  EXPECT_EQ(gateway.status().refused_full, 0U);
}

TEST(Device, AUnitThatDoesNotAnswerDoesNotSpoilWhatOthersOnItsConnectionRead) {
  BadServer gateway(response);
  DeviceOptions options = one_register(gateway.port());
  options.shares_connection = true;
  const std::vector<DeviceOptions> both{options, options};
  const auto links = shared_links(both);
  const Device first(both[0], {.link = links[0]});
  const Device second(both[1], {.link = links[1]});
  ASSERT_TRUE(soon([&] { return first.status().answers > 10 && second.status().answers > 10; }));
  for (const Fault fault : {Fault::never, Fault::late, Fault::duplicate, Fault::none}) {
    gateway.set(fault);
    std::this_thread::sleep_for(3 * response);
    for (const Device* const device : {&first, &second}) {
      const RemoteReading reading = device->read(0);
      EXPECT_TRUE(reading.quality != Quality::good || reading.value == test::right_value);
    }
  }
  EXPECT_TRUE(soon([&] { return first.read(0).quality == Quality::good && second.read(0).quality == Quality::good; }));
  EXPECT_EQ(first.read(0).value, test::right_value);
}

TEST(Device, SeveralUnitsOnOneSerialLineTakeTurns) {
  test::MemoryDoor door(test::points_of_every_type());
  const RegisterMap map = make_register_map(door.points(), {.title = "T"});
  Responder responder(map, door, {});
  const test::SerialDevice line(responder);
  std::vector<std::unique_ptr<Device>> units;
  for (std::uint8_t unit = 3; unit <= 5; ++unit) {
    units.push_back(
        std::make_unique<Device>(DeviceOptions{.link = SerialLink{.path = line.path(), .baud = 115200, .parity = 'N'},
                                               .unit = unit,
                                               .values = {{.at = {Area::holding_register, 0, 1}}},
                                               .period = milliseconds(1),
                                               .response = milliseconds(5000)}));
  }
  for (const auto& unit : units) {
    EXPECT_TRUE(soon([&] { return unit->status().answers >= 50; }));
  }
  for (const auto& unit : units) {
    const DeviceStatus status = unit->status();
    EXPECT_EQ(status.timeouts + status.wrong_answers + status.closed, 0U) << "answers to another's requests";
    EXPECT_EQ(status.connections, 1U);
  }
}

TEST(ValueBits, LimitsOfATypeComeBackAsTheyAre) {
  for (const RegisterType type : register_types) {
    const auto [low, high] = limits_of(type);
    EXPECT_EQ(value_of(bits_of(low, type), type), low) << name_of(type);
    EXPECT_EQ(value_of(bits_of(high, type), type), high) << name_of(type);
  }
}

}  // namespace
}  // namespace hysteron::runtime::modbus
