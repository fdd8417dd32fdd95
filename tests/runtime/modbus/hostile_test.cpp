// Hostile clients beside a victim, short; tests/soak runs them long and beside a plain libmodbus server.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"
#include "tests/runtime/modbus/memory_door.hpp"

namespace hysteron::runtime::modbus {
namespace {

class HostileClients : public ::testing::TestWithParam<std::string> {};

TEST_P(HostileClients, LeaveTheVictimServed) {
  test::MemoryDoor door(test::registers_to_serve());
  for (std::size_t i = 0; i < test::pattern_registers; ++i) {
    door.set(i, test::pattern_of(i));
  }
  const Server server(make_register_map(door.points(), {.title = "T"}), door, {.port = 0});
  const auto result = test::victim_beside(GetParam(), server.port(), milliseconds(1200), std::chrono::seconds(20),
                                          {.connections = 200});
  EXPECT_GT(result.requests, 0U);
  EXPECT_EQ(result.errors, 0U);
  EXPECT_EQ(result.wrong, 0U);
  for (std::size_t i = 0; i < test::pattern_registers; ++i) {
    EXPECT_EQ(door.value(i), test::pattern_of(i));
  }
  EXPECT_EQ(door.writes(), result.requests / 4) << "nobody wrote but the victim";
  RecordProperty("worst_ms", std::to_string(1e3 * *std::ranges::max_element(result.latencies)));
}

INSTANTIATE_TEST_SUITE_P(Attacks, HostileClients, ::testing::ValuesIn(test::attack_names()), [](const auto& attack) {
  std::string name;
  for (const char c : attack.param) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name;
});

}  // namespace
}  // namespace hysteron::runtime::modbus
