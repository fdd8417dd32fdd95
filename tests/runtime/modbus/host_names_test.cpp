// A name server that gives no answer keeps nobody waiting longer than he can: each test here would never end if it did.
#include "runtime/modbus/host_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/config/output_claims.hpp"
#include "runtime/modbus/device.hpp"
#include "tests/runtime/modbus/silent_name_server.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using std::chrono::milliseconds;
using test::soon;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class HostNames : public testing::Test {
 protected:
  HostNames() {
    test::name_server_is_silent = true;
    test::name_server_asked = 0;
  }
  ~HostNames() override { test::name_server_is_silent = false; }  // threads that still ask end
  HostNames(const HostNames&) = delete;
  HostNames& operator=(const HostNames&) = delete;
};

/// The first that comes, and not one more.
std::string first_address(HostName& name) {
  std::string found;
  (void)soon([&] {
    found = found.empty() ? name.next_address(milliseconds(10)) : found;
    return !found.empty();
  });
  return found;
}

TEST_F(HostNames, OfManyThoseThatAnswerInTime) {
  const std::vector<std::string> hosts{"silent.test", "127.0.0.1", "known.test", "::1", "localhost"};
  const auto found = addresses_within(hosts, milliseconds(300));
  EXPECT_THAT(found[0], IsEmpty());
  EXPECT_THAT(found[1], ElementsAre("127.0.0.1"));
  EXPECT_THAT(found[2], ElementsAre("127.0.0.8"));
  EXPECT_THAT(found[3], ElementsAre("::1"));
  EXPECT_THAT(found[4], testing::Contains(testing::AnyOf("127.0.0.1", "::1")));
}

TEST_F(HostNames, ANameIsAskedForOnceAndItsAnswerTakenWhenItComes) {
  HostName name("silent.test");
  for (int tries = 0; tries < 3; ++tries) {
    EXPECT_EQ(name.next_address(milliseconds(10)), "");
  }
  EXPECT_TRUE(soon([] { return test::name_server_asked == 1; }));
  test::name_server_is_silent = false;
  EXPECT_EQ(first_address(name), "127.0.0.9");
  EXPECT_EQ(test::name_server_asked, 1);
}

/// What was known before is tried first, and again, while nothing newer is known.
TEST_F(HostNames, KnownAddressesNeedNoNameServer) {
  HostName name("silent.test", {"127.0.0.5", "127.0.0.6"});
  EXPECT_EQ(name.next_address(milliseconds(10)), "127.0.0.5");
  EXPECT_EQ(name.next_address(milliseconds(10)), "127.0.0.6");
  EXPECT_EQ(test::name_server_asked, 0);
  name.was_reached();
  EXPECT_EQ(name.next_address(milliseconds(10)), "127.0.0.6") << "the one that leads there";
  EXPECT_EQ(name.next_address(milliseconds(10)), "127.0.0.5");
  EXPECT_TRUE(soon([] { return test::name_server_asked == 1; }));
  test::name_server_is_silent = false;
  EXPECT_TRUE(soon([&] { return name.next_address(milliseconds(10)) == "127.0.0.9"; }));
}

TEST_F(HostNames, ADeviceBeginsAndEndsWhileTheNameServerIsSilent) {
  {
    const Device device({.link = TcpLink{.host = "silent.test", .port = 1},
                         .values = {{.at = {.address = 0}}},
                         .response = milliseconds(50)});
    EXPECT_TRUE(soon([&] { return device.status().no_link > 0; }));
  }
  EXPECT_TRUE(test::name_server_is_silent);
}

/// A start asks for the addresses of all devices, and goes on without those that it does not get.
TEST_F(HostNames, AStartClaimsOutputsWhileTheNameServerIsSilent) {
  const ProgramShape shape{.name = "PLANT", .period = 1'000'000, .outputs = {{.name = "Y"}, {.name = "Z"}}};
  RunConfig config = parse_run_config(
      "RUN.toml",
      "[devices.a]\nhost = \"silent.test\"\nport = 51999\n[devices.b]\nhost = \"known.test\"\nport = 51999\n"
      "[outputs.Y]\nsafe = 0.0\ndevice = \"a\"\n[outputs.Z]\nsafe = 0.0\ndevice = \"b\"\n",
      shape);
  look_up_hosts(config, milliseconds(300));
  EXPECT_THAT(std::get<TcpLink>(config.devices[0].link).known, IsEmpty());
  EXPECT_THAT(std::get<TcpLink>(config.devices[1].link).known, ElementsAre("127.0.0.8"));
  OutputClaims claims(config);
  EXPECT_FALSE(claims.claim());
}

}  // namespace
}  // namespace hysteron::runtime::modbus
