// A server whose address is not there yet: it waits for it beside its work, says so, and is never refused for it.
#include "runtime/modbus/listener.hpp"

#include <gtest/gtest.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

#include "runtime/modbus/device.hpp"
#include "runtime/modbus/listen.hpp"
#include "runtime/modbus/server.hpp"
#include "support/errors.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::soon;

TEST(Listener, AnAddressThatIsNotThereYetIsTriedAgainWithGrowingPauses) {
  std::vector<std::string> told;
  // Of RFC 5737: no machine has it.
  Listener listener("192.0.2.1", 1502, {}, [&](const std::string& line) { told.push_back(line); });
  EXPECT_FALSE(listener.is_open());
  EXPECT_EQ(listener.port(), 1502);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].find("192.0.2.1 port 1502 cannot be listened on yet: "), 0U) << told[0];
  auto now = *listener.next_try();
  EXPECT_FALSE(listener.try_again(now - milliseconds(1)));
  EXPECT_EQ(*listener.next_try(), now) << "not before its time";
  std::vector<milliseconds> pauses;
  for (int tries = 0; tries < 8; ++tries) {
    EXPECT_FALSE(listener.try_again(now));
    pauses.push_back(std::chrono::duration_cast<milliseconds>(*listener.next_try() - now));
    now = *listener.next_try();
  }
  EXPECT_EQ(pauses.front(), milliseconds(100));
  EXPECT_EQ(pauses.back(), milliseconds(2000));
  EXPECT_TRUE(std::is_sorted(pauses.begin(), pauses.end()));
  EXPECT_EQ(told.size(), 1U) << "it is said once";
}

TEST(Listener, WhatDoesNotPassIsRefused) {
  const Descriptor other = listen_on("127.0.0.1", 0, {});
  const auto number_of = [](const std::string& address, std::uint16_t port) {
    try {
      const Listener listener(address, port, {}, {});
      return 0;
    } catch (const InputError& refused) {
      return refused.diagnostics().all().front().number;
    }
  };
  EXPECT_EQ(number_of("127.0.0.1", port_of(other)), error::port_in_use);
  EXPECT_EQ(number_of("localhost", 0), error::unusable_listen_address);
  EXPECT_EQ(number_of("127.0.0.1", 0), 0);
}

class NotedDoor final : public test::MemoryDoor {
 public:
  NotedDoor() : MemoryDoor({{.name = "X"}}) {}
  void shortage(Shortage what, bool is_there) noexcept override {
    if (what == Shortage::address) {
      lacks_address = is_there;
    }
  }
  std::atomic<bool> lacks_address{false};
};

void bring_up_loopback() {
  const Descriptor any(::socket(AF_INET, SOCK_DGRAM, 0));
  ifreq request{};
  std::strncpy(static_cast<char*>(request.ifr_name), "lo", IFNAMSIZ - 1);
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  (void)::ioctl(any.number(), SIOCSIFFLAGS, &request);
}

/// In a network of its own, whose loopback comes up later than the server.
int serve_before_the_network() {
  if (::unshare(CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    return 77;  // this machine lets nobody have one
  }
  NotedDoor door;
  std::string told;
  const Server server(make_register_map(door.points(), {}), door,
                      {.listen = "127.0.0.1", .port = 1502, .tell = [&](const std::string& line) { told += line; }});
  if (!door.lacks_address || told.find("cannot be listened on yet") == std::string::npos) {
    return 1;
  }
  bring_up_loopback();
  if (!soon([&] { return !door.lacks_address; })) {
    return 2;
  }
  door.set(0, 4.5);
  Device client({.link = TcpLink{.port = 1502},
                 .values = {{.at = server.map().entries()[0].at, .format = server.map().entries()[0].format}},
                 .response = seconds(2)});
  return soon([&] { return client.read(0).value == 4.5; }) ? 0 : 3;
}

TEST(Listener, AServerListensAsSoonAsItsAddressIsThere) {
  const pid_t process = ::fork();
  if (process == 0) {
    ::_exit(serve_before_the_network());
  }
  int status = 0;
  ASSERT_EQ(::waitpid(process, &status, 0), process);
  const int code = test::exit_code(status);
  if (code == 77) {
    GTEST_SKIP() << "no network of its own";
  }
  EXPECT_EQ(code, 0) << "1 not told, 2 never listened, 3 not served";
}

}  // namespace
}  // namespace hysteron::runtime::modbus
