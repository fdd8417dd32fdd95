// What a run file says and does not mean: keys without effect, paths for a shell, a server that is open to all.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/runtime/config/run_file.hpp"

namespace hysteron::runtime {
namespace {

/// Number and line of each warning, and the first cause.
std::string warnings_of(const std::string& text) {
  std::string list;
  const RunConfig config = parse_run_config("RUN.toml", text, plant());
  for (const Diagnostic& one : config.warnings.all()) {
    list += fmt::format("{}@{} ", one.number, one.place.line);
  }
  return list;
}

const std::string idle_safe = "[outputs.Y]\nsafe = 0.0\n";
const std::string idle_device = "[devices.stage]\nhost = \"10.0.0.7\"\n";

struct Idle {
  const char* name;
  std::string without;  ///< the key is the last line, and does nothing
  std::string with;     ///< the same key, and what it belongs to
};

class IdleKeys : public testing::TestWithParam<Idle> {};

TEST_P(IdleKeys, AreOneLineEachAndNoneWhereTheyDoSomething) {
  const auto& [name, without, with] = GetParam();
  EXPECT_EQ(warnings_of(without), fmt::format("804@{} ", std::ranges::count(without, '\n'))) << without;
  EXPECT_EQ(warnings_of(with), "") << with;
}

INSTANTIATE_TEST_SUITE_P(
    Of, IdleKeys,
    testing::Values(
        Idle{"catch_up", idle_safe + "[task]\ncatch_up = 3\n",
             idle_safe + "[task]\nmissed = \"catch_up\"\ncatch_up = 3\n"},
        Idle{"priority", idle_safe + "[task]\nscheduling = \"other\"\npriority = 5\n",
             idle_safe + "[task]\npriority = 5\n"},
        Idle{"sensitivity", idle_safe + "[watchdog]\nsensitivity = 2\n",
             idle_safe + "[watchdog]\ntime = \"5ms\"\nsensitivity = 2\n"},
        Idle{"silence", idle_safe + "[watchdog]\nsilence = \"90ms\"\n",
             idle_device + idle_safe + "device = \"stage\"\n[watchdog]\nsilence = \"90ms\"\n"},
        Idle{"silence_unguarded",
             idle_device + idle_safe + "device = \"stage\"\n[watchdog]\nguard = false\nsilence = \"90ms\"\n",
             idle_device + idle_safe + "device = \"stage\"\n[watchdog]\nguard = true\nsilence = \"90ms\"\n"},
        Idle{"guard_wait", idle_safe + "[watchdog]\nguard_wait = \"9s\"\n",
             idle_device + idle_safe + "device = \"stage\"\n[watchdog]\nguard_wait = \"9s\"\n"},
        Idle{"ramp", idle_safe + "ramp = 2.0\n", idle_safe + "on_fault = \"ramp\"\nramp = 2.0\n"},
        Idle{"hold_cycles", idle_safe + "on_fault = \"hold\"\nhold_cycles = 5\n", idle_safe + "hold_cycles = 5\n"},
        Idle{"output_age", idle_safe + "longest_age = \"1s\"\n",
             idle_device + idle_safe + "device = \"stage\"\nlongest_age = \"1s\"\n"},
        Idle{"bump", idle_safe + "bump = 0.5\n",
             "[online_change]\nsocket = \"a.socket\"\n" + idle_safe + "bump = 0.5\n"},
        Idle{"told_age",
             idle_device + idle_safe +
                 "[inputs.X]\ndevice = \"stage\"\n[inputs.Z]\nage_of = \"X\"\nlongest_age = \"1s\"\n",
             idle_device + idle_safe +
                 "[inputs.Z]\nage_of = \"X\"\n[inputs.X]\ndevice = \"stage\"\nlongest_age = \"1s\"\n"},
        Idle{"heartbeat_time", idle_safe + "[modbus]\nheartbeat_time = \"2s\"\n",
             idle_safe + "[modbus]\nheartbeat = \"any\"\nheartbeat_time = \"2s\"\n"},
        Idle{"after_loss", idle_safe + "[modbus]\nafter_loss = \"reset\"\n",
             idle_safe + "[modbus]\nheartbeat = \"any\"\nafter_loss = \"reset\"\n"},
        Idle{"own_writes", idle_safe + "[modbus]\nread_only = true\nown_writes = true\n",
             idle_safe + "[modbus]\nown_writes = true\n"},
        Idle{"connections_per_address", idle_safe + "[modbus]\nconnections = 8\nconnections_per_address = 9\n",
             idle_safe + "[modbus]\nconnections = 8\nconnections_per_address = 8\n"},
        Idle{"evict", idle_safe + "[modbus]\nidle = \"3s\"\nevict = \"4s\"\n",
             idle_safe + "[modbus]\nidle = \"5s\"\nevict = \"4s\"\n"}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(IdleKeys, EvictionBesideAShortIdleIsNoWarningWhereNobodyWroteIt) {
  EXPECT_EQ(warnings_of(idle_safe + "[modbus]\nidle = \"1s\"\n"), "");
}

TEST(ShellPaths, AreToldOfEachFileThatARunFileNames) {
  for (const auto& [table, key] : std::vector<std::pair<std::string, std::string>>{{"[retain]", "folder"},
                                                                                   {"[trace]", "file"},
                                                                                   {"[history]", "file"},
                                                                                   {"[modbus]", "lock_file"},
                                                                                   {"[online_change]", "socket"},
                                                                                   {"[web]", "token_file"},
                                                                                   {"[web]", "read_token_file"}}) {
    const auto with = [&](const std::string& path) {
      return warnings_of(fmt::format("{}{}\n{} = \"{}\"\n", idle_safe, table, key, path));
    };
    EXPECT_EQ(with("~/kept"), "804@4 ") << table << key;
    EXPECT_EQ(with("~"), "804@4 ") << table << key;
    EXPECT_EQ(with("kept~"), "") << table << key;
    EXPECT_EQ(with("/var/lib/kept"), "") << table << key;
  }
  EXPECT_EQ(warnings_of(idle_safe + "[mqtt]\nbroker = \"a\"\nca = \"~/ca.pem\"\nfile = \"~/rows\"\n"), "804@5 804@6 ");
}

TEST(OpenServer, IsRefusedWhereNobodySaidWhomItServes) {
  const auto errors = [](const std::string& keys) { return errors_of(idle_safe + "[modbus]\n" + keys); };
  for (const char* const all : {"0.0.0.0", "::", "0:0::0", "::ffff:0.0.0.0"}) {
    const std::string listen = fmt::format("listen = \"{}\"\n", all);
    EXPECT_EQ(errors(listen), "829@4:10 ") << all;
    EXPECT_EQ(errors(listen + "read_only = true\n"), "829@4:10 ") << "values are read all the same";
    EXPECT_EQ(errors(listen + "allow = [\"0.0.0.0/0\", \"::/0\"]\n"), "") << "who says it may";
    EXPECT_EQ(errors(listen + "[tls]\ncertificate = \"a\"\nkey = \"b\"\nclients = \"c\"\n[roles]\nr = [\"read\"]\n"),
              "");
  }
  EXPECT_EQ(errors("listen = \"192.168.10.5\"\n"), "") << "one network was chosen";
  EXPECT_EQ(errors(""), "");
}

}  // namespace
}  // namespace hysteron::runtime
