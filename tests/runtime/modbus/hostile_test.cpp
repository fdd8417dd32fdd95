// Hostile clients beside a victim, short; tests/soak runs them long and beside a plain libmodbus server.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/tls_files.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Cases = ::testing::TestWithParam<std::string>;

void leave_the_victim_served(const std::string& attack, const ServerOptions& options, const test::Hostile& hostile) {
  test::MemoryDoor door(test::registers_to_serve());
  for (std::size_t i = 0; i < test::pattern_registers; ++i) {
    door.set(i, test::pattern_of(i));
  }
  const Server server(make_register_map(door.points(), {.title = "T"}), door, options);
  const auto result = test::victim_beside(attack, server.port(), milliseconds(1200), std::chrono::seconds(20), hostile);
  EXPECT_GT(result.requests, 0U);
  EXPECT_EQ(result.errors, 0U);
  EXPECT_EQ(result.wrong, 0U);
  for (std::size_t i = 0; i < test::pattern_registers; ++i) {
    EXPECT_EQ(door.value(i), test::pattern_of(i));
  }
  EXPECT_EQ(door.writes(), result.requests / 4) << "nobody wrote but the victim";
  ::testing::Test::RecordProperty("worst_ms", std::to_string(1e3 * *std::ranges::max_element(result.latencies)));
}

class HostileClients : public Cases {};

TEST_P(HostileClients, LeaveTheVictimServed) {
  leave_the_victim_served(GetParam(), {.port = 0}, {.connections = 200});
}

class HostileClientsOverTls : public Cases {};

/// Victim and attackers alike have certificates: what is inside must hold, too.
TEST_P(HostileClientsOverTls, LeaveTheVictimServed) {
  const test::TlsFiles files;
  const auto client = files.client_of("all");
  leave_the_victim_served(GetParam(), {.port = 0, .tls = std::make_shared<const TlsContext>(files.options())},
                          {.connections = 200, .tls = client.get()});
}

std::string name_of_case(const ::testing::TestParamInfo<std::string>& attack) {
  std::string name;
  for (const char c : attack.param) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name;
}

std::vector<std::string> all_names() {
  auto names = test::names_of(test::attacks());
  for (const std::string& name : test::names_of(test::tls_attacks())) {
    names.push_back(name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Attacks, HostileClients, ::testing::ValuesIn(test::names_of(test::attacks())), name_of_case);
INSTANTIATE_TEST_SUITE_P(Attacks, HostileClientsOverTls, ::testing::ValuesIn(all_names()), name_of_case);

}  // namespace
}  // namespace hysteron::runtime::modbus
