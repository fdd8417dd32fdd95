// A server whose address is not there yet: it waits for it beside its work, says so, and is never refused for it.
#include "runtime/modbus/listener.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "runtime/modbus/listen.hpp"
#include "support/errors.hpp"
#include "tests/runtime/modbus/late_network.hpp"

namespace hysteron::runtime::modbus {
namespace {

using std::chrono::milliseconds;

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

/// The network came up, and something else is in the way: the first reason would lead astray.
TEST(Listener, AnotherReasonIsSaidWhenItComes) {
  std::vector<std::string> told;
  Listener listener("192.0.2.1", 1502, {}, [&](const std::string& line) { told.push_back(line); });
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  rlimit none = limit;
  none.rlim_cur = 0;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  (void)listener.try_again(*listener.next_try());
  (void)listener.try_again(*listener.next_try());
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  ASSERT_EQ(told.size(), 2U) << "once";
  EXPECT_NE(told[1].find("192.0.2.1 port 1502 cannot be listened on yet: Too many open files."), std::string::npos)
      << told[1];
  (void)listener.try_again(*listener.next_try());
  EXPECT_EQ(told.size(), 3U);
  EXPECT_EQ(told[2], told[0]);
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

TEST(Listener, AServerListensAsSoonAsItsAddressIsThere) {
  const auto met = test::meet_a_late_network();
  if (met != test::LateNetwork::none) {  // this machine lets a process have a network of its own
    EXPECT_EQ(met, test::LateNetwork::served);
  }
}

}  // namespace
}  // namespace hysteron::runtime::modbus
