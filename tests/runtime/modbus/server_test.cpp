#include "runtime/modbus/server.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/modbus/listen.hpp"
#include "support/errors.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/error_page.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using test::ask;
using test::Bytes;
using test::ClientSocket;
using test::framed;

struct ServerBench {
  explicit ServerBench(ServerOptions options = {})
      : door(test::registers_to_serve()), server(map_of(door), door, free_port(std::move(options))) {}
  static RegisterMap map_of(const PointDoor& door) { return make_register_map(door.points(), {.title = "T"}); }
  static ServerOptions free_port(ServerOptions options) {
    options.port = 0;
    return options;
  }
  test::MemoryDoor door;
  Server server;
};

const Bytes write_one = framed(2, {6, 0, 3, 0, 9});

TEST(Server, AnswersAndCounts) {
  ServerBench bench;
  {
    const ClientSocket client(bench.server.port());
    EXPECT_EQ(ask(client, write_one), write_one);
    EXPECT_EQ(ask(client, framed(3, {3, 0, 3, 0, 1})), framed(3, {3, 2, 0, 9}));
    EXPECT_EQ(ask(client, framed(4, {99})), framed(4, {227, 1}));
  }
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 0; }));
  const ServerStatus status = bench.server.status();
  EXPECT_EQ(status.accepted, 1U);
  EXPECT_EQ(status.requests, 3U);
  EXPECT_EQ(status.exceptions, 1U);
  EXPECT_EQ(status.writes, 1U);
  EXPECT_EQ(status.closed_by_client, 1U);
}

TEST(Server, SaysWhyTheProgramRefusedARequest) {
  std::mutex mutex;
  std::vector<std::string> lines;
  ServerBench bench({.tell = [&](const std::string& line) {
    const std::scoped_lock lock(mutex);
    lines.push_back(line);
  }});
  bench.door.refuse("L.MX = 1 must be at least L.MN = 5.");
  const ClientSocket client(bench.server.port());
  EXPECT_EQ(ask(client, write_one), framed(2, {0x86, 4}));
  EXPECT_EQ(ask(client, write_one), framed(2, {0x86, 4}));
  bench.door.refuse("");
  EXPECT_EQ(ask(client, write_one), write_one);
  EXPECT_EQ(ask(client, framed(4, {99})), framed(4, {227, 1}));
  const std::scoped_lock lock(mutex);
  EXPECT_EQ(lines, std::vector<std::string>{"127.0.0.1 is refused by the program: L.MX = 1 must be at least L.MN = 5."})
      << "one a second at the most";
}

TEST(Server, ListensOnLoopbackUnlessToldOtherwise) {
  EXPECT_EQ(ServerOptions{}.listen, "127.0.0.1");
}

/// What a server tells, from its thread.
struct Told {
  std::mutex mutex{};
  std::vector<std::string> lines{};
  [[nodiscard]] std::function<void(const std::string&)> taker() {
    return [this](const std::string& line) {
      const std::scoped_lock lock(mutex);
      lines.push_back(line);
    };
  }
  [[nodiscard]] std::string first() {
    const std::scoped_lock lock(mutex);
    return lines.empty() ? "" : lines.front();
  }
};

TEST(Server, TheThirtyThirdIsRefusedWithoutHarmAndToldOf) {
  Told told;
  ServerBench bench({.tell = told.taker()});
  std::vector<std::unique_ptr<ClientSocket>> clients;
  for (int i = 0; i < 32; ++i) {
    clients.push_back(std::make_unique<ClientSocket>(bench.server.port()));
    ASSERT_EQ(ask(*clients.back(), test::read_one).size(), 11U);
  }
  EXPECT_TRUE(ClientSocket(bench.server.port()).sees_the_end());
  for (const auto& client : clients) {
    EXPECT_EQ(ask(*client, test::read_one).size(), 11U);
  }
  EXPECT_EQ(bench.server.status().refused_full, 1U);
  EXPECT_EQ(told.first(),
            "127.0.0.1 is refused a connection: the 32 of connections are taken, each by a client that asks.");
  clients.pop_back();
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 31; }));
  EXPECT_EQ(ask(ClientSocket(bench.server.port()), test::read_one).size(), 11U)
      << "a place that is free is given again";
}

TEST(Server, ConnectionsThatWereForgottenGiveWayToTheirOwner) {
  ServerBench bench({.connections_per_address = 8, .evict = milliseconds(300)});
  std::vector<std::unique_ptr<ClientSocket>> leaked;
  for (int i = 0; i < 8; ++i) {
    leaked.push_back(std::make_unique<ClientSocket>(bench.server.port()));
    ASSERT_EQ(ask(*leaked.back(), test::read_one).size(), 11U);
  }
  std::unique_ptr<ClientSocket> again;
  bool is_served = false;
  EXPECT_TRUE(test::soon([&] {
    if (!is_served) {
      again = std::make_unique<ClientSocket>(bench.server.port());
      is_served = ask(*again, test::read_one).size() == 11U;
    }
    return is_served;
  })) << "not 60 s later";
  EXPECT_EQ(bench.server.status().evicted, 1U);
  EXPECT_TRUE(leaked.front()->sees_the_end()) << "who has been silent for longest";
  EXPECT_EQ(bench.server.status().idle, 0U);
  EXPECT_EQ(bench.server.status().open, 8U);
}

TEST(Server, WhoAsksAndWhoOwnsTheWritesKeepTheirPlaces) {
  ServerBench bench({.connections = 2, .evict = milliseconds(200), .heartbeat = {.own_writes = true}});
  const ClientSocket owner(bench.server.port());
  ASSERT_EQ(ask(owner, write_one), write_one);
  const ClientSocket busy(bench.server.port());
  const auto until = std::chrono::steady_clock::now() + milliseconds(600);
  while (std::chrono::steady_clock::now() < until) {
    EXPECT_EQ(ask(busy, test::read_one).size(), 11U);
    EXPECT_TRUE(ClientSocket(bench.server.port()).sees_the_end());
  }
  EXPECT_EQ(ask(owner, write_one), write_one);
  EXPECT_EQ(bench.server.status().evicted, 0U);
}

TEST(Server, IdleIsWhatTheOptionsSay) {
  ServerBench bench({.limits = {.idle = milliseconds(150)}});
  const ClientSocket client(bench.server.port());
  EXPECT_TRUE(client.sees_the_end());
  EXPECT_EQ(bench.server.status().idle, 1U);
}

TEST(Server, AValueBeyondItsFormatIsToldOnceAMinute) {
  std::mutex mutex;
  std::vector<std::string> lines;
  test::MemoryDoor door({{.name = "FLOW"}});
  const Server server(
      make_register_map(door.points(),
                        {.title = "T", .given = {{.name = "FLOW", .format = GivenFormat{.type = PointType::int16}}}}),
      door, {.port = 0, .tell = [&](const std::string& line) {
               const std::scoped_lock lock(mutex);
               lines.push_back(line);
             }});
  door.set(0, 40000.0);
  const ClientSocket client(server.port());
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(ask(client, framed(5, {4, 0, 0, 0, 1})), framed(5, {4, 2, 0x7F, 0xFF}));
  }
  EXPECT_TRUE(test::soon([&] { return server.status().saturated == 3U; }));  // counted behind the answer
  const std::scoped_lock lock(mutex);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines.front().starts_with("FLOW is beyond what its registers hold")) << lines.front();
}

TEST(Server, OneAddressHasItsShareAndLeavesTheRestToOthers) {
  Told told;
  ServerBench bench({.connections = 8, .connections_per_address = 3, .tell = told.taker()});
  const auto client_of = [&](unsigned host) {
    return std::make_unique<ClientSocket>(bench.server.port(), std::chrono::seconds(5), nullptr,
                                          INADDR_LOOPBACK + host);
  };
  std::vector<std::unique_ptr<ClientSocket>> clients;
  for (const unsigned host : {0U, 1U}) {
    for (int i = 0; i < 3; ++i) {
      clients.push_back(client_of(host));
      ASSERT_EQ(ask(*clients.back(), test::read_one).size(), 11U);
    }
    for (int i = 0; i < 5; ++i) {
      EXPECT_TRUE(client_of(host)->sees_the_end());
    }
  }
  EXPECT_EQ(bench.server.status().refused_share, 10U);
  EXPECT_EQ(bench.server.status().refused_full, 0U);
  EXPECT_EQ(ask(*client_of(2), test::read_one).size(), 11U) << "there is room for others";
  clients.erase(clients.begin());
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 5; }));
  EXPECT_EQ(ask(*client_of(0), test::read_one).size(), 11U) << "a place that is free is given again";
  EXPECT_EQ(told.first(), "127.0.0.1 is refused a connection beyond the 3 of connections_per_address.");
}

TEST(Server, TheAllowListIsAskedBeforeAByteIsRead) {
  Told told;
  ServerBench bench({.allow = {"10.0.0.0/8"}, .tell = told.taker()});
  const ClientSocket client(bench.server.port());
  client.send(write_one);
  EXPECT_TRUE(client.sees_the_end());
  EXPECT_EQ(told.first(), "127.0.0.1 is refused by allow: no network there has this address.");
  EXPECT_EQ(bench.server.status().refused_address, 1U);
  EXPECT_EQ(bench.server.status().requests, 0U);
  EXPECT_EQ(bench.door.writes(), 0U);
  ServerBench open({.allow = {"10.0.0.0/8", "127.0.0.1"}});
  EXPECT_EQ(ask(ClientSocket(open.server.port()), write_one), write_one);
}

TEST(Server, ReadOnly) {
  ServerBench bench({.read_only = true});
  const ClientSocket client(bench.server.port());
  EXPECT_EQ(ask(client, write_one), framed(2, {134, 1}));
  EXPECT_EQ(ask(client, test::read_one), framed(1, {3, 2, 0, 0}));
  EXPECT_EQ(bench.door.writes(), 0U);
}

TEST(Server, DeadlinesEndAConnection) {
  ServerBench bench({.limits = {.frame_deadline = milliseconds(50), .idle = milliseconds(300)}});
  const ClientSocket slow(bench.server.port());
  slow.send(std::span(test::read_one).first(5));
  EXPECT_TRUE(slow.sees_the_end());
  EXPECT_EQ(bench.server.status().frame_late, 1U);
  EXPECT_TRUE(ClientSocket(bench.server.port()).sees_the_end());
  EXPECT_EQ(bench.server.status().idle, 1U);
}

TEST(Server, WhatIsNoFrameEndsAConnectionAndWritesNothing) {
  ServerBench bench;
  for (const auto& [at, value] : {std::pair{3, 1}, {2, 9}, {4, 1}, {5, 0}, {5, 1}, {5, 255}}) {
    Bytes frame = write_one;
    frame[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(value);
    const ClientSocket client(bench.server.port());
    client.send(frame);
    EXPECT_TRUE(client.sees_the_end()) << at << " " << value;
  }
  EXPECT_EQ(bench.server.status().wrong_protocol, 2U);
  EXPECT_EQ(bench.server.status().wrong_length, 4U);
  EXPECT_EQ(bench.door.writes(), 0U);
}

TEST(Server, OneClientOwnsTheWrites) {
  ServerBench bench({.heartbeat = {.own_writes = true}});
  const ClientSocket guest(bench.server.port());
  {
    const ClientSocket owner(bench.server.port());
    EXPECT_EQ(ask(owner, write_one), write_one);
    EXPECT_EQ(ask(guest, write_one), framed(2, {134, 6}));
    EXPECT_EQ(ask(guest, test::read_one).size(), 11U);
  }
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 1; }));
  EXPECT_EQ(ask(guest, write_one), write_one);
}

/// Before the answer to the write that makes it so: who writes by another way is refused from then on.
TEST(Server, WhetherAClientOwnsTheWritesIsTold) {
  ServerBench bench(
      {.heartbeat = {.mode = HeartbeatMode::write_telegram, .time = milliseconds(100), .own_writes = true}});
  {
    const ClientSocket reader(bench.server.port());
    EXPECT_EQ(ask(reader, test::read_one).size(), 11U);
    EXPECT_FALSE(bench.door.is_owned());
  }
  const ClientSocket owner(bench.server.port());
  EXPECT_EQ(ask(owner, write_one), write_one);
  EXPECT_TRUE(bench.door.is_owned());
  EXPECT_TRUE(test::soon([&] { return !bench.door.is_owned(); })) << "it is lost";
  {
    const ClientSocket next(bench.server.port());
    EXPECT_EQ(ask(next, write_one), write_one);
    EXPECT_TRUE(bench.door.is_owned());
  }
  EXPECT_TRUE(test::soon([&] { return !bench.door.is_owned(); })) << "it is gone";
  ServerBench free;
  const ClientSocket writer(free.server.port());
  EXPECT_EQ(ask(writer, write_one), write_one);
  EXPECT_FALSE(free.door.is_owned());
}

TEST(Server, ALostClientIsTold) {
  std::atomic<int> lost{0};
  std::atomic<int> back{0};
  ServerBench bench({.heartbeat = {.mode = HeartbeatMode::write_telegram, .time = milliseconds(100)},
                     .client_lost = [&](bool is_lost) { ++(is_lost ? lost : back); }});
  const ClientSocket client(bench.server.port());
  EXPECT_EQ(ask(client, write_one), write_one);
  EXPECT_TRUE(test::soon([&] { return bench.server.status().client_lost; }));
  EXPECT_EQ(lost, 1);
  EXPECT_EQ(ask(client, write_one), write_one);
  EXPECT_TRUE(test::soon([&] { return back == 1; }));
}

std::ptrdiff_t open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

TEST(Server, ConnectAndCloseLosesNoDescriptor) {
  const auto before = open_descriptors();
  {
    ServerBench bench;
    const auto serving = open_descriptors();
    for (int i = 0; i < 2000; ++i) {
      ClientSocket client(bench.server.port());
      ASSERT_TRUE(client.connected());
      if (i % 2 == 0) {
        client.reset();
      }
    }
    EXPECT_TRUE(test::soon([&] {
      const ServerStatus status = bench.server.status();
      return status.open == 0 && open_descriptors() == serving;
    }));
  }
  EXPECT_EQ(open_descriptors(), before);
}

int number_of_refusal(const ServerOptions& options) {
  test::MemoryDoor door(test::registers_to_serve());
  try {
    const Server server(ServerBench::map_of(door), door, options);
    return 0;
  } catch (const InputError& refused) {
    return refused.diagnostics().all().front().number;
  }
}

/// What a page says in TOML. Ports of pages are those of real servers; here any that is free does.
ServerOptions options_of(const test::FencedBlock& block, std::uint16_t busy) {
  const auto table = toml::parse(block.text);
  ServerOptions options{.port = 0};
  options.listen = table["modbus"]["listen"].value_or(options.listen);
  const auto port = table["modbus"]["port"].value_or(std::int64_t{0});
  options.port = port == 502 ? 502 : port == 1502 ? busy : 0;
  if (const auto* allow = table["modbus"]["allow"].as_array()) {
    for (const auto& one : *allow) {
      options.allow.push_back(one.value<std::string>().value());
    }
  }
  return options;
}

TEST(ServerErrorPages, FailAndMend) {
  const Descriptor other = listen_on("127.0.0.1", 0, {});
  for (const int number : {error::port_in_use, error::unusable_listen_address, error::malformed_allow_list}) {
    const auto page = test::read_error_page("HY" + std::to_string(number));
    EXPECT_EQ(number_of_refusal(options_of(page.fails, port_of(other))), number);
    EXPECT_EQ(number_of_refusal(options_of(page.mended, port_of(other))), 0) << number;
  }
  EXPECT_EQ(number_of_refusal({.listen = "localhost"}), error::unusable_listen_address) << "a name is no address";
}

/// In a process without rights, since tests may be run by root.
TEST(ServerErrorPages, APrivilegedPort) {
  const auto page = test::read_error_page("HY828");
  const ServerOptions fails = options_of(page.fails, 0);
  const ServerOptions mended = options_of(page.mended, 0);
  EXPECT_EXIT(
      {
        const bool unprivileged = ::getuid() != 0 || (::setgid(65534) == 0 && ::setuid(65534) == 0);
        const bool as_said = number_of_refusal(fails) == error::privileged_port && number_of_refusal(mended) == 0;
        ::_exit(unprivileged && as_said ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace hysteron::runtime::modbus
