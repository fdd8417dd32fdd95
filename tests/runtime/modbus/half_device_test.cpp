// What a device can still do is done, whatever else of it fails: safe values above all.
#include "tests/runtime/modbus/half_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/modbus/device.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using std::chrono::milliseconds;
using test::HalfDevice;
using test::soon;

/// Registers that do not touch, so that each is a block of its own.
DeviceOptions blocks(const HalfDevice& device, const std::vector<std::uint32_t>& written,
                     const std::vector<std::uint32_t>& read) {
  DeviceOptions options{.link = TcpLink{.port = device.port()},
                        .period = milliseconds(2),
                        .response = milliseconds(60),
                        .first_wait = milliseconds(2),
                        .longest_wait = milliseconds(20)};
  for (const std::uint32_t address : written) {
    options.values.push_back({.at = {Area::holding_register, address, 1}, .written = true});
  }
  for (const std::uint32_t address : read) {
    options.values.push_back({.at = {Area::holding_register, address, 1}});
  }
  return options;
}

constexpr std::array<std::string_view, 4> flaw_names{"None", "NoAnswer", "OneByteMore", "CloseAfter"};

class HalfDeviceReads : public ::testing::TestWithParam<HalfDevice::Flaw> {};

TEST_P(HalfDeviceReads, ThatFailKeepNoWriteBack) {
  for (const std::vector<std::uint32_t>& read : {std::vector<std::uint32_t>{10}, {10, 20, 30}}) {
    HalfDevice half;
    Device device(blocks(half, {0, 2}, read));
    device.write(0, 3.0);
    device.write(1, 4.0);
    const auto all_is_read = [&] {
      for (std::size_t i = 2; i < 2 + read.size(); ++i) {
        if (device.read(i).quality != Quality::good) {
          return false;
        }
      }
      return true;
    };
    ASSERT_TRUE(soon([&] { return all_is_read() && half.holds(2) == 4; }));
    half.flaw_of_reads(GetParam());
    // It fails on the link that was up, and on each new one.
    const auto connections = device.status().connections;
    ASSERT_TRUE(soon([&] { return device.status().connections > connections + 2; }));
    for (std::uint16_t value = 7; value < 10; ++value) {
      device.write(0, value);
      device.write(1, value + 1);
      EXPECT_TRUE(soon([&] { return half.holds(0) == value && half.holds(2) == value + 1; }));
      EXPECT_TRUE(soon([&] { return device.has_taken(0, value) && device.has_taken(1, value + 1); }));
    }
    half.flaw_of_reads(HalfDevice::Flaw::none);
    EXPECT_TRUE(soon(all_is_read));
  }
}

INSTANTIATE_TEST_SUITE_P(Flaws, HalfDeviceReads,
                         testing::Values(HalfDevice::Flaw::silent, HalfDevice::Flaw::one_byte_more,
                                         HalfDevice::Flaw::close_after),
                         [](const auto& flaw) {
                           return std::string(flaw_names.at(static_cast<std::size_t>(flaw.param)));
                         });

/// With what is read and without, as a guard has it.
TEST(HalfDevice, ABlockThatFailsKeepsNoOtherFromItsTurn) {
  for (const std::vector<std::uint32_t>& read : {std::vector<std::uint32_t>{}, {50, 60}}) {
    const std::vector<std::uint32_t> written{0, 10, 20, 30};
    HalfDevice half;
    Device device(blocks(half, written, read));
    const auto all_hold = [&](std::uint16_t value, std::span<const std::uint32_t> but) {
      for (std::size_t i = 0; i < written.size(); ++i) {
        device.write(i, value);
      }
      return soon([&] {
        return std::ranges::all_of(written, [&](std::uint32_t address) {
          return std::ranges::find(but, address) != but.end() ||
                 half.holds(static_cast<std::uint16_t>(address)) == value;
        });
      });
    };
    ASSERT_TRUE(all_hold(1, {}));
    std::uint16_t value = 1;
    for (const std::vector<std::uint32_t>& silent :
         {std::vector<std::uint32_t>{0}, {30}, {0, 10}, {0, 20}, {10, 20, 30}}) {
      for (const std::uint32_t address : silent) {
        half.silent_at(static_cast<std::uint16_t>(address));
      }
      for (int round = 0; round < 3; ++round) {
        EXPECT_TRUE(all_hold(++value, {})) << "the silent ones carry out what nobody hears of";
      }
      for (const auto address : read) {
        const auto before = half.asked(static_cast<std::uint16_t>(address));
        EXPECT_TRUE(soon([&] { return half.asked(static_cast<std::uint16_t>(address)) > before + 2; }));
      }
      for (const std::uint32_t address : silent) {
        half.silent_at(static_cast<std::uint16_t>(address), false);
      }
    }
    EXPECT_TRUE(soon([&] { return device.has_taken(0, value) && device.has_taken(3, value); }));
  }
}

TEST(HalfDevice, AllFailuresTogetherLeaveEveryBlockItsTurn) {
  constexpr std::array<std::uint16_t, 5> all{0, 10, 50, 60, 70};
  HalfDevice half;
  Device device(blocks(half, {0, 10}, {50, 60, 70}));
  device.write(0, 1.0);
  device.write(1, 1.0);
  ASSERT_TRUE(soon([&] { return device.has_taken(1, 1.0); }));
  for (const std::uint16_t address : all) {
    half.silent_at(address);
  }
  for (const std::uint16_t address : all) {
    const auto before = half.asked(address);
    EXPECT_TRUE(soon([&] { return half.asked(address) > before + 1; })) << address;
  }
}

TEST(HalfDevice, WhatIsReadComesFirstWhileAllIsWell) {
  HalfDevice half;
  Device device(blocks(half, {0}, {50}), {.own_thread = false});
  EXPECT_TRUE(device.round());
  device.write(0, 5.0);
  half.flaw_of_reads(HalfDevice::Flaw::silent);
  EXPECT_FALSE(device.round());
  EXPECT_EQ(half.holds(0), 0) << "the link was up: what is read came first";
  EXPECT_FALSE(device.round());
  EXPECT_EQ(half.holds(0), 5) << "and on a new one, what is written";
}

}  // namespace
}  // namespace hysteron::runtime::modbus
