// The client role against a server that goes wrong in one way, many times, and is sound again between.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string_view>
#include <utility>

#include "runtime/modbus/device.hpp"
#include "tests/runtime/modbus/bad_server.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::test {

inline constexpr std::array<std::pair<Fault, std::string_view>, 14> link_faults{
    {{Fault::late, "late"},
     {Fault::never, "never"},
     {Fault::wrong_id, "wrong id"},
     {Fault::wrong_unit, "wrong unit"},
     {Fault::wrong_function, "wrong function"},
     {Fault::wrong_protocol, "wrong protocol"},
     {Fault::too_short, "short"},
     {Fault::too_long, "long"},
     {Fault::lying_length, "lying length"},
     {Fault::close, "close"},
     {Fault::reset, "reset"},
     {Fault::black_hole, "black hole"},
     {Fault::duplicate, "duplicate"},
     {Fault::drip, "drip"}}};

inline runtime::modbus::DeviceOptions one_register(std::uint16_t port, std::chrono::milliseconds response) {
  using std::chrono::milliseconds;
  namespace modbus = runtime::modbus;
  return {.name = "DEVICE",
          .link = modbus::TcpLink{.port = port},
          .values = {{.at = {modbus::Area::holding_register, 0, 1}, .longest_age = std::chrono::minutes(1)}},
          .period = milliseconds(2),
          .response = response,
          .first_wait = milliseconds(2),
          .longest_wait = milliseconds(20)};
}

struct BadDeviceResult {
  std::uint64_t met = 0;    ///< requests that met the fault
  std::uint64_t wrong = 0;  ///< looks at the value that found another than the right one
  std::uint64_t rounds = 0;
  std::uint64_t recovered = 0;  ///< rounds after which the value was good again
  runtime::modbus::DeviceStatus status{};
};

/// In rounds: sound, then wrong for `at_once` requests and more.
inline BadDeviceResult meet(Fault fault, std::uint8_t exception, std::uint64_t rounds, std::uint64_t at_once,
                            std::chrono::milliseconds response) {
  BadServer server(response);
  const runtime::modbus::Device device(one_register(server.port(), response));
  BadDeviceResult result{.rounds = rounds};
  const auto met = [&] {
    const auto status = device.status();
    return fault == Fault::black_hole ? status.timeouts + status.no_link : server.faults();
  };
  const auto is_good = [&] {
    const auto now = device.read(0);
    result.wrong += now.quality != runtime::modbus::Quality::never && now.value != right_value ? 1 : 0;
    return now.quality == runtime::modbus::Quality::good;
  };
  (void)soon(is_good);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    const auto before = met();
    server.set(fault, exception);
    (void)soon([&] {
      (void)is_good();
      return met() >= before + at_once;
    });
    result.met += met() - before;
    server.set(Fault::none);
    result.recovered += soon(is_good) ? 1 : 0;
  }
  result.status = device.status();
  return result;
}

}  // namespace hysteron::test
