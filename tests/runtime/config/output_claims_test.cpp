// Who writes an output: by what it leads to, not by how a run file spells it, and for every register that it covers.
#include "runtime/config/output_claims.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/config/run_config.hpp"
#include "runtime/host/output_turn.hpp"
#include "support/errors.hpp"
#include "tests/runtime/modbus/free_port.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

RunConfig config_of(const std::string& link, const std::string& place, const std::string& more = "") {
  const ProgramShape shape{
      .name = "PLANT", .period = 1'000'000, .outputs = {{.name = "Y"}, {.name = "Z", .type = PointType::real64}}};
  RunConfig config = parse_run_config("RUN.toml",
                                      fmt::format("[devices.stage]\n{}\n[outputs.Y]\nsafe = 0\ndevice = \"stage\"\n{}\n"
                                                  "[outputs.Z]\nsafe = 0\n{}",
                                                  link, place, more),
                                      shape);
  look_up_hosts(config, std::chrono::seconds(30));
  return config;
}

std::string at(std::string_view host, int port) {
  return fmt::format("host = \"{}\"\nport = {}", host, port);
}

TEST(OutputClaims, AHostIsTheSameHoweverItIsSpelt) {
  const auto port = test::free_port();
  OutputClaims first(config_of(at("127.0.0.1", port), "register = 0"));
  ASSERT_FALSE(first.claim());
  for (const std::string_view host :
       {"localhost", "127.1", "0.0.0.0", "::ffff:127.0.0.1", "LOCALHOST", "127.000.000.001"}) {
    EXPECT_TRUE(OutputClaims(config_of(at(host, port), "register = 0")).claim()) << host;
  }
  EXPECT_FALSE(OutputClaims(config_of(at("127.0.0.2", port), "register = 0")).claim());
  EXPECT_FALSE(OutputClaims(config_of(at("no.such.host.invalid", port), "register = 0")).claim());
}

TEST(OutputClaims, ASerialLineIsTheSameBehindALink) {
  const hysteron::test::ScratchFolder folder;
  const std::string line = folder.write("line", "");
  const std::string by_name = folder / "by-name";
  std::filesystem::create_symlink(line, by_name);
  const auto serial = [](const std::string& path) { return fmt::format("serial = \"{}\"", path); };
  OutputClaims first(config_of(serial(line), "register = 0"));
  ASSERT_FALSE(first.claim());
  EXPECT_TRUE(OutputClaims(config_of(serial(by_name), "register = 0")).claim());
  EXPECT_FALSE(OutputClaims(config_of(serial(by_name) + "\nunit = 2", "register = 0")).claim());
}

TEST(OutputClaims, EveryRegisterThatAnOutputCovers) {
  const auto link = at("127.0.0.1", test::free_port());
  OutputClaims first(config_of(link, "register = 10"));
  ASSERT_FALSE(first.claim());
  for (int address = 7; address < 15; ++address) {
    const auto holder = OutputClaims(config_of(link, fmt::format("register = {}\ntype = \"uint16\"", address))).claim();
    EXPECT_EQ(holder.has_value(), address >= 10 && address < 14) << address;
    EXPECT_EQ(holder.value_or(OutputClaims::Holder{.address = static_cast<std::uint32_t>(address)}).address,
              static_cast<std::uint32_t>(address));
  }
  EXPECT_TRUE(OutputClaims(config_of(link, "register = 7")).claim()) << "a real64 from register 7 to 10";
  EXPECT_FALSE(OutputClaims(config_of(link, "register = 6")).claim());
  EXPECT_FALSE(OutputClaims(config_of(link, "register = 14")).claim());
}

TEST(OutputClaims, TwoOutputsOfOneRunFileThatMeetAreRefused) {
  const auto port = test::free_port();
  const auto config = config_of(at("127.0.0.1", port), "register = 0",
                                "device = \"other\"\nregister = 3\n[devices.other]\n" + at("localhost", port));
  OutputClaims claims(config);
  const std::atomic<bool> stop{false};
  try {
    (void)claim_outputs(claims, config, "PLANT", stop, [](std::string_view) {});
    FAIL() << "it was not refused";
  } catch (const InputError& refused) {
    const Diagnostic& first = refused.diagnostics().all().front();
    EXPECT_EQ(first.number, error::device_register_twice);
    EXPECT_NE(first.cause.find("holding register 3 of other"), std::string::npos) << first.cause;
  }
}

/// A guard never answers, so what asks for it fills its queue, 4,096 places here: it stays a guard for the one who
/// waits, who asks once, and for every later start.
TEST(OutputClaims, AGuardIsAGuardHoweverOftenItIsAsked) {
  const auto config = config_of(at("127.0.0.1", test::free_port()), "register = 0");
  auto first = std::make_unique<OutputClaims>(config);
  ASSERT_FALSE(first->claim());
  first->guard_listens();
  OutputClaims waiting(config);
  for (int tries = 0; tries < 10'000; ++tries) {
    const auto holder = waiting.claim();
    ASSERT_TRUE(holder) << tries;
    ASSERT_EQ(holder->guard, ::getpid()) << tries;
  }
  for (int starts = 0; starts < 5000; ++starts) {
    const auto holder = OutputClaims(config).claim();
    ASSERT_TRUE(holder) << starts;
    ASSERT_TRUE(holder->guard) << starts;
  }
  EXPECT_EQ(waiting.claim()->guard, ::getpid());
  first.reset();
  EXPECT_FALSE(waiting.claim()) << "its turn, as soon as the guard is gone";
}

}  // namespace
}  // namespace hysteron::runtime
