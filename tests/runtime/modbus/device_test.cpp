// The client role against a device that does everything wrong, and over a serial line.
#include "runtime/modbus/device.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>

#include "runtime/modbus/server.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "tests/runtime/modbus/bad_device.hpp"
#include "tests/runtime/modbus/memory_door.hpp"

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
    expect_values_to_cross({.link = TcpLink{.port = server.port()}, .period = milliseconds(5)},
                           server.map(), door);
  }
}

/// CRC of a serial frame, bit by bit as in the specification.
std::uint16_t crc_of(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U);
    }
  }
  return crc;
}

/// A serial device at the other end of a pseudo-terminal, which answers whole requests by the server's own answers.
class SerialDevice {
 public:
  explicit SerialDevice(Responder& responder) : responder_(responder), master_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (!master_.is_open() || ::grantpt(master_.number()) != 0 || ::unlockpt(master_.number()) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    std::array<char, 128> name{};
    ::ptsname_r(master_.number(), name.data(), name.size());
    path_ = name.data();
    keep_open_ = Descriptor(::open(path_.c_str(), O_RDWR | O_NOCTTY));  // or the master hangs up between two clients
    termios raw{};
    ::tcgetattr(keep_open_.number(), &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(keep_open_.number(), TCSANOW, &raw);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void run(const std::stop_token& stop) {
    std::vector<std::uint8_t> frame;
    while (!stop.stop_requested()) {
      pollfd one{master_.number(), POLLIN, 0};
      if (::poll(&one, 1, 20) <= 0) {
        frame.clear();
        continue;
      }
      std::array<std::uint8_t, 256> bytes{};
      const ssize_t got = ::read(master_.number(), bytes.data(), bytes.size());
      frame.insert(frame.end(), bytes.begin(), bytes.begin() + std::max<ssize_t>(got, 0));
      const bool whole = frame.size() >= 4 && crc_of(frame) == 0;  // the CRC of a frame with its CRC
      if (!whole) {
        continue;
      }
      const Reply reply = responder_.answer(std::span(frame).subspan(1, frame.size() - 3), {});
      std::vector<std::uint8_t> answer{frame[0]};
      answer.insert(answer.end(), reply.pdu().begin(), reply.pdu().end());
      const std::uint16_t crc = crc_of(answer);
      answer.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
      answer.push_back(static_cast<std::uint8_t>(crc >> 8U));
      frame.clear();
      if (::write(master_.number(), answer.data(), answer.size()) < 0) {
        return;
      }
    }
  }

  Responder& responder_;
  Descriptor master_;
  Descriptor keep_open_;
  std::string path_;
  std::jthread thread_;
};

TEST(Device, EveryTypeOverASerialLine) {
  test::MemoryDoor door(test::points_of_every_type());
  const RegisterMap map = make_register_map(door.points(), {.title = "T"});
  Responder responder(map, door, {});
  const SerialDevice line(responder);
  expect_values_to_cross({.link = SerialLink{.path = line.path(), .baud = 115200},
                          .unit = 7,
                          .period = milliseconds(5),
                          .response = milliseconds(2000)},
                         map, door);
}

TEST(Device, SeveralUnitsOnOneSerialLineTakeTurns) {
  test::MemoryDoor door(test::points_of_every_type());
  const RegisterMap map = make_register_map(door.points(), {.title = "T"});
  Responder responder(map, door, {});
  const SerialDevice line(responder);
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
