// Registers through online changes, as a client of the Modbus server has them: none moves, and parameters that came
// with a change are found, read, staged and committed without a restart.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/discovery.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "tests/runtime/host/running_plant.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/task/integrators.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using hysteron::test::Bytes;
using hysteron::test::soon;
using test::Integrator;
using test::integrators;
using test::Plant;
using test::refusal_by;
using test::value;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A client that knows nothing but what the discovery chain tells it.
class Client {
 public:
  explicit Client(const modbus::Server& server) : socket_(server.port()) {}

  /// The answer's PDU.
  Bytes ask(const Bytes& pdu) {
    Bytes frame{0, 1, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), 1};
    frame.insert(frame.end(), pdu.begin(), pdu.end());
    EXPECT_TRUE(socket_.send(frame));
    const Bytes head = socket_.receive(7);
    return head.size() == 7 ? socket_.receive(std::size_t{head[4]} * 256 + head[5] - 1) : Bytes{};
  }
  void discover() {
    std::vector<std::uint16_t> chain;
    std::optional<modbus::DiscoveredMap> found;
    while (!(found = modbus::read_chain(chain)) && chain.size() < 20'000) {
      const auto more = words(modbus::chain_address + static_cast<std::uint32_t>(chain.size()), 1);
      ASSERT_EQ(more.size(), 1U) << "the chain ends after " << chain.size();
      chain.push_back(more[0]);
    }
    map_ = found.value();
  }
  [[nodiscard]] const modbus::DiscoveredPoint* find(std::string_view name) const {
    const auto found =
        std::ranges::find(map_.points, name, [](const auto& one) -> std::string_view { return one.point.name; });
    return found == map_.points.end() ? nullptr : &*found;
  }
  [[nodiscard]] std::string address(std::string_view name) const {
    const auto* const found = find(name);
    return found == nullptr ? "none" : modbus::address_text(found->at);
  }
  [[nodiscard]] const std::string& hash() const { return map_.hash; }

  /// Empty where the server answers by an exception.
  std::vector<std::uint16_t> words(std::uint32_t address, std::uint32_t count) {
    const Bytes answer = ask({3, high(address), low(address), 0, static_cast<std::uint8_t>(count)});
    std::vector<std::uint16_t> words;
    for (std::size_t i = 2; !answer.empty() && answer[0] == 3 && i + 1 < answer.size(); i += 2) {
      words.push_back(static_cast<std::uint16_t>(answer[i] << 8U | answer[i + 1]));
    }
    return words;
  }
  /// Of an LREAL.
  double value(std::string_view name) {
    const auto read = words(find(name)->at.address, 4);
    return read.size() == 4 ? std::bit_cast<double>(modbus::from_registers(read, modbus::WordOrder::abcd)) : -1e300;
  }
  /// The exception, or 0.
  int write(std::string_view name, double value) {
    const auto& at = find(name)->at;
    std::vector<std::uint16_t> words(at.count);
    modbus::to_registers(at.count == 4 ? std::bit_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value),
                         modbus::WordOrder::abcd, words);
    Bytes pdu{16,
              high(at.address),
              low(at.address),
              0,
              static_cast<std::uint8_t>(at.count),
              static_cast<std::uint8_t>(2 * at.count)};
    for (const std::uint16_t word : words) {
      pdu.push_back(high(word));
      pdu.push_back(low(word));
    }
    const Bytes answer = ask(pdu);
    return answer.at(0) == 16 ? 0 : answer.at(1);
  }
  int commit() { return write("task.commit", 1.0); }

 private:
  static std::uint8_t high(std::uint32_t number) { return static_cast<std::uint8_t>(number >> 8U); }
  static std::uint8_t low(std::uint32_t number) { return static_cast<std::uint8_t>(number & 0xFFU); }

  hysteron::test::ClientSocket socket_;
  modbus::DiscoveredMap map_{};
};

std::vector<std::string> texts(const std::vector<PointRegister>& registers) {
  std::vector<std::string> all;
  for (const PointRegister& one : registers) {
    all.push_back(one.name + " " + one.address + (one.after_restart.empty() ? "" : " -> " + one.after_restart));
  }
  return all;
}

constexpr int illegal_address = 2;
constexpr int illegal_value = 3;
constexpr int refused = 4;

TEST(OnlineRegisters, AParameterThatCameWithTheChangeIsFoundReadAndCommittedAtOnce) {
  Plant plant(integrators({{"A", 0.5}, {"B", 0.25}}), 1e9);
  plant.serve({});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  Client client(plant.server());
  client.discover();
  const std::string a = client.address("A.K");
  const std::string b = client.address("B.K");
  const std::string hash = client.hash();
  const auto next = [] { return integrators({{"NEW", 3.0}, {"B", 9.0}, {"A", 9.0}}); };
  const ChangeReport checked = plant.change().change_to(next(), {.only_check = true});
  ASSERT_EQ(checked.registers.added.size(), 1U);
  client.discover();
  EXPECT_EQ(client.hash(), hash) << "a check changes nothing";
  const ChangeReport report = plant.change().change_to(next(), {});
  EXPECT_EQ(texts(report.registers.added), texts(checked.registers.added));
  EXPECT_THAT(report.registers.without, IsEmpty());
  client.discover();
  EXPECT_NE(client.hash(), hash);
  EXPECT_EQ(client.address("A.K"), a);
  EXPECT_EQ(client.address("B.K"), b);
  EXPECT_EQ(client.address("NEW.K"), report.registers.added[0].address);
  EXPECT_EQ(client.find("NEW.K")->point.high, 100.0);

  EXPECT_EQ(client.value("NEW.K"), 3.0);
  EXPECT_EQ(client.value("A.K"), 0.5);
  EXPECT_EQ(client.write("NEW.K", 500.0), illegal_value) << "its range is known";
  EXPECT_EQ(client.write("NEW.K", 2.0), 0);
  EXPECT_EQ(client.value("NEW.K"), 2.0) << "staged values are read back";
  plant.run(5);
  LiveValues live;
  plant.door().read_live(live);
  const auto view = plant.door().view();
  const auto at = std::ranges::find(view->points, "NEW.K", &Point::name) - view->points.begin();
  EXPECT_EQ(live.values.at(static_cast<std::size_t>(at)), 3.0) << "and do not count yet";
  EXPECT_EQ(client.commit(), 0);
  EXPECT_TRUE(soon([&] {
    plant.door().read_live(live);
    return live.values.at(static_cast<std::size_t>(at)) == 2.0;
  }));
}

TEST(OnlineRegisters, WhatIsGoneKeepsItsAddressItsLastValueAndRefusesWrites) {
  Plant plant(integrators({{"A", 0.5}, {"B", 0.25}}), 1e9);
  plant.serve({});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  (void)plant.change().change_to(integrators({{"NEW", 3.0}, {"A", 9.0}}), {});
  Client client(plant.server());
  client.discover();
  const std::string known = client.address("NEW.K");
  EXPECT_EQ(client.value("B.K"), 0.25);
  EXPECT_EQ(client.write("B.K", 1.0), refused);
  EXPECT_EQ(client.write("NEW.K", 4.0), 0);
  EXPECT_EQ(client.commit(), 0);
  plant.run(5);

  // A third version has neither NEW nor B, but another one, which gets nobody's address.
  const ChangeReport third = plant.change().change_to(integrators({{"A", 9.0}, {"OTHER", -1.0}}), {});
  client.discover();
  EXPECT_EQ(client.address("NEW.K"), known);
  EXPECT_THAT(texts(third.registers.added), ElementsAre("OTHER.K " + client.address("OTHER.K")));
  EXPECT_EQ(client.value("NEW.K"), 4.0);
  EXPECT_EQ(client.write("NEW.K", 5.0), refused);
  EXPECT_EQ(client.value("OTHER.K"), -1.0);
  EXPECT_EQ(client.write("OTHER.K", 1.5), 0);

  // Back, it is written again; what only the third had is refused.
  const ChangeReport back = plant.change().change_back({});
  EXPECT_THAT(back.registers.added, IsEmpty());
  plant.run(5);
  client.discover();
  EXPECT_EQ(client.address("NEW.K"), known);
  EXPECT_EQ(client.value("NEW.K"), 4.0);
  EXPECT_EQ(client.write("NEW.K", 5.0), 0);
  EXPECT_EQ(client.commit(), 0);
  plant.run(5);
  EXPECT_EQ(client.value("NEW.K"), 5.0);
  EXPECT_EQ(client.write("OTHER.K", 1.0), refused);

  // To the first version, which knows neither: also then each of them answers.
  (void)plant.change().change_to(integrators({{"A", 9.0}, {"B", 9.0}}), {});
  plant.run(5);
  EXPECT_EQ(client.value("NEW.K"), 5.0);
  EXPECT_EQ(client.value("B.K"), 9.0) << "it was gone for two versions, and begins as the files have it";
  EXPECT_EQ(client.write("B.K", 1.0), 0);
  EXPECT_EQ(client.write("NEW.K", 1.0), refused);
}

/// A register that a client knows in ms must not become one in s.
TEST(OnlineRegisters, AnotherUnitOrTypeGetsNoRegisterThatClientsKnowOtherwise) {
  Plant plant(integrators({{"A", 0.5}}), 1e9);
  plant.serve({});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  auto next = integrators({{"A", 2.0}});
  next->mutable_shape().parameters[0].unit = "s";
  const ChangeReport report = plant.change().change_to(std::move(next), {});
  EXPECT_THAT(report.registers.added, IsEmpty());
  EXPECT_THAT(report.registers.without, ElementsAre("A.K (its name has had another type or unit since the start)"));
  Client client(plant.server());
  client.discover();
  EXPECT_EQ(client.find("A.K")->point.unit, "1");
  EXPECT_EQ(client.value("A.K"), 0.5);
  EXPECT_EQ(client.write("A.K", 1.0), refused);
  EXPECT_THAT(plant.change().change_back({}).registers.without, IsEmpty());
  EXPECT_EQ(client.write("A.K", 1.0), 0);
}

TEST(OnlineRegisters, ARangeThatTheVersionWidensIsThatOfTheRegister) {
  Plant plant(integrators({{"A", 0.5}}), 1e9);
  plant.serve({});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  Client client(plant.server());
  client.discover();
  EXPECT_EQ(client.write("A.K", 150.0), illegal_value);
  auto next = integrators({{"A", 0.5}});
  next->mutable_shape().parameters[0].high = 200.0;
  (void)plant.change().change_to(std::move(next), {});
  EXPECT_EQ(client.write("A.K", 150.0), 0);
  EXPECT_EQ(client.commit(), 0);
  client.discover();
  EXPECT_EQ(client.find("A.K")->point.high, 200.0);
}

TEST(OnlineRegisters, ExposeDecidesOfNewOnesToo) {
  Plant plant(integrators({{"A", 0.5}}), 1e9);
  plant.serve({.expose = {"A*", "task.commit"}});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  const ChangeReport report = plant.change().change_to(integrators({{"A", 0.5}, {"AFTER", 1.0}, {"HIDDEN", 2.0}}), {});
  EXPECT_THAT(report.registers.without, ElementsAre("HIDDEN.K (expose does not name it)"));
  Client client(plant.server());
  client.discover();
  EXPECT_EQ(client.find("HIDDEN.K"), nullptr);
  EXPECT_EQ(client.value("AFTER.K"), 1.0);
}

/// What a restart of the running version serves, by its own code.
modbus::RegisterMap map_after_restart(const ModbusConfig& modbus, const StepProgram& program) {
  RunConfig config;
  config.task = test::plant_settings();
  config.modbus = modbus;
  return register_map_of(config, program);
}

std::string address_in(const modbus::RegisterMap& map, std::string_view name) {
  for (const modbus::MapEntry& entry : map.entries()) {
    if (map.point_of(entry).name == name) {
      return modbus::address_text(entry.at);
    }
  }
  return "none";
}

TEST(OnlineRegisters, WithALockFileARestartServesTheSame) {
  const hysteron::test::ScratchFolder folder;
  const ModbusConfig modbus{.lock_file = (folder / "plant.lock")};
  Plant plant(integrators({{"A", 0.5}, {"B", 0.25}}), 1e9);
  plant.serve(modbus);
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  const std::string before = hysteron::test::contents_of(modbus.lock_file);
  const auto next = [] { return integrators({{"NEW", 3.0}, {"A", 9.0}}); };
  (void)plant.change().change_to(next(), {.only_check = true});
  EXPECT_EQ(hysteron::test::contents_of(modbus.lock_file), before) << "a check writes nothing";
  const ChangeReport report = plant.change().change_to(next(), {});
  EXPECT_THAT(report.registers.until_restart, IsEmpty());
  const modbus::RegisterMap later = map_after_restart(modbus, *next());
  Client client(plant.server());
  client.discover();
  for (const char* const name : {"X", "Y", "A.K", "NEW.K", "task.commit", "task.version"}) {
    EXPECT_EQ(address_in(later, name), client.address(name)) << name;
  }
}

TEST(OnlineRegisters, WithoutALockFileItIsSaidWhatARestartMoves) {
  Plant plant(integrators({{"A", 0.5}, {"B", 0.25}}), 1e9);
  plant.serve({});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  const auto next = [] { return integrators({{"NEW", 3.0}, {"A", 9.0}, {"B", 9.0}}); };
  const ChangeReport report = plant.change().change_to(next(), {});
  Client client(plant.server());
  client.discover();
  const modbus::RegisterMap later = map_after_restart({}, *next());
  std::size_t moved = 0;
  for (const modbus::MapEntry& entry : later.entries()) {
    const std::string& name = later.point_of(entry).name;
    if (client.address(name) == modbus::address_text(entry.at)) {
      continue;
    }
    ++moved;
    const auto said = std::ranges::find(report.registers.until_restart, name, &PointRegister::name);
    ASSERT_NE(said, report.registers.until_restart.end()) << name;
    EXPECT_EQ(said->address, client.address(name));
    EXPECT_EQ(said->after_restart, modbus::address_text(entry.at));
  }
  EXPECT_GE(moved, 3U);
  EXPECT_EQ(report.registers.until_restart.size(), moved);
}

TEST(OnlineRegisters, ALockFileThatCannotBeWrittenIsALineAndTheChangeStands) {
  const hysteron::test::ScratchFolder folder;
  std::filesystem::create_directory(folder / "sub");
  Plant plant(integrators({{"A", 0.5}}), 1e9);
  plant.serve({.lock_file = (folder / "sub/plant.lock")});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  std::filesystem::remove_all(folder / "sub");
  (void)folder.write("sub", "a file is in the way");
  testing::internal::CaptureStderr();
  const ChangeReport report = plant.change().change_to(integrators({{"A", 0.5}, {"NEW", 3.0}}), {});
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr(" After a restart, registers that came with the online change may be elsewhere.\n"));
  EXPECT_TRUE(report.is_done);
  Client client(plant.server());
  client.discover();
  EXPECT_EQ(client.value("NEW.K"), 3.0);
}

/// No address is left: that refuses the change before anything happens.
TEST(OnlineRegisters, AChangeWhoseParametersFindNoAddressIsRefused) {
  Plant plant(integrators({{"A", 0.5}}), 1e9);
  plant.serve({.placing = modbus::Placing::openplc});
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  std::vector<Integrator> many{{"A", 0.5}};
  for (int i = 0; i < 1030; ++i) {
    many.push_back({fmt::format("P{}", i), 0.0});
  }
  EXPECT_THAT(refusal_by([&] { return plant.change().change_to(integrators(many), {}); }),
              HasSubstr(": No address is left for P"));
  Client client(plant.server());
  EXPECT_EQ(value(plant.door(), "task.version"), 1.0);
  EXPECT_THAT(client.ask({3, 0x13, 0x88, 0, 1}), ElementsAre(0x83, illegal_address));
}

}  // namespace
}  // namespace hysteron::runtime
