// What a broker or a network can do to those who publish: refuse, hang, swallow, show another's certificate. It is
// said, tried again, and holds up nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <filesystem>

#include "runtime/modbus/listen.hpp"
#include "runtime/mqtt/mqtt.hpp"
#include "tests/runtime/modbus/test_certificates.hpp"
#include "tests/runtime/mqtt/mqtt_bench.hpp"

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;
using test::Broker;
using test::MqttBench;
using test::soon;
using testing::HasSubstr;

/// Less than anything that hangs would take, and enough for a machine that is busy.
constexpr std::chrono::seconds prompt{8};

class PublishingTrouble : public test::WithBroker {};

TEST_F(PublishingTrouble, AWrongPasswordIsRefusedAndTriedAgain) {
  test::ScratchFolder passwords;
  passwords.write("passwords", "");
  ASSERT_EQ(std::system(
                fmt::format("mosquitto_passwd -b '{}' stage right > /dev/null 2>&1", passwords / "passwords").c_str()),
            0);
  std::filesystem::permissions(passwords / "passwords", std::filesystem::perms(0600));
  Broker broker("allow_anonymous false\npassword_file " + (passwords / "passwords") + "\n");
  ASSERT_TRUE(broker.start());
  MqttBench bench(broker.port());
  bench.settings.link.user = "stage";
  bench.settings.link.password = "wrong-and-secret";
  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until([&] { return bench.count().fault != 0; }));
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(MqttFault::Refused));
  const std::string said = bench.said();
  EXPECT_THAT(said, HasSubstr(": Connection Refused: not authorised. Rows wait"));
  EXPECT_EQ(said.find("secret"), std::string::npos);
  bench.finish();
  EXPECT_EQ(bench.count().lost, 11U) << "nothing was sent";
  bench.settings.link.password = "right";
  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until_confirmed()) << bench.remarks().problem();
  bench.finish();
}

class PublishingOverTls : public test::WithBroker {
 protected:
  void SetUp() override {
    test::WithBroker::SetUp();
    files.write("ca.pem", authority.certificate_pem());
    files.write("broker.pem", named.certificate_pem());
    files.write("broker.key", named.key_pem());
    files.write("other.pem", other_authority.certificate_pem());
    files.write("client.pem", client.certificate_pem());
    files.write("client.key", client.key_pem());
  }
  [[nodiscard]] std::string settings(const std::string& more = "") const {
    return fmt::format("allow_anonymous true\ncafile {}\ncertfile {}\nkeyfile {}\n{}", files / "ca.pem",
                       files / "broker.pem", files / "broker.key", more);
  }
  /// The fault of a try, and what was said.
  std::pair<MqttFault, std::string> fault_of(const Broker& broker, const std::function<void(MqttLink&)>& change) {
    MqttBench bench(broker.port());
    bench.settings.link.broker = "localhost";
    bench.settings.link.authority = files / "ca.pem";
    change(bench.settings.link);
    bench.start();
    bench.run(100);
    (void)bench.until([&] { return bench.count().fault != 0 || bench.count().done == 11; });
    const auto fault = static_cast<MqttFault>(bench.count().fault);
    return {fault, bench.said()};
  }

  test::ScratchFolder files{};
  test::Certificate authority{{.name = "authority"}, nullptr};
  test::Certificate other_authority{{.name = "other"}, nullptr};
  test::Certificate named{{.name = "localhost", .for_clients = false}, &authority};
  test::Certificate client{{.name = "stage"}, &authority};
};

TEST_F(PublishingOverTls, KnowsTheBrokerByItsCertificate) {
  Broker broker(settings());
  ASSERT_TRUE(broker.start());
  EXPECT_EQ(fault_of(broker, [](MqttLink&) {}), std::pair(MqttFault::None, std::string()));
  const auto stranger = fault_of(broker, [&](MqttLink& link) { link.authority = files / "other.pem"; });
  EXPECT_EQ(stranger.first, MqttFault::Tls) << stranger.second;
  EXPECT_THAT(stranger.second, HasSubstr("certificate verify failed"));
  const auto elsewhere = fault_of(broker, [](MqttLink& link) { link.broker = "127.0.0.1"; });
  EXPECT_EQ(elsewhere.first, MqttFault::Tls) << "its certificate is of another name: " << elsewhere.second;
  const auto missing = fault_of(broker, [&](MqttLink& link) { link.authority = files / "none.pem"; });
  EXPECT_EQ(missing.first, MqttFault::Tls) << missing.second;
  const auto clear = fault_of(broker, [](MqttLink& link) { link.authority.clear(); });
  EXPECT_NE(clear.first, MqttFault::None) << "it speaks TLS alone";
}

TEST_F(PublishingOverTls, ShowsItsOwnWhereTheBrokerAsksForOne) {
  Broker broker(settings("require_certificate true\n"));
  ASSERT_TRUE(broker.start());
  EXPECT_NE(fault_of(broker, [](MqttLink&) {}).first, MqttFault::None);
  const auto known = fault_of(broker, [&](MqttLink& link) {
    link.certificate = files / "client.pem";
    link.key = files / "client.key";
  });
  EXPECT_EQ(known.first, MqttFault::None) << known.second;
}

TEST_F(PublishingTrouble, ABrokerThatHangsIsLeftAndTheEndIsQuick) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  MqttBench bench(broker.port());
  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until_confirmed());
  broker.halt();
  bench.run(1000);
  bench.turn();
  const auto begin = std::chrono::steady_clock::now();
  bench.finish(milliseconds(300));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, prompt);
  EXPECT_EQ(bench.count().done + bench.count().lost, 111U);
  EXPECT_GE(bench.count().lost, 100U) << "whoever does not confirm has not got them";
  broker.go_on();
  bench.stop();

  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until_confirmed());
  broker.halt();
  bench.run(100);
  bench.turn();
  bench.pass(11'000 * MqttBench::ms);
  bench.turn();
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(MqttFault::Lost));
  EXPECT_THAT(bench.said(), HasSubstr("it confirms nothing any more"));
}

/// A port where nobody answers: the connection is taken by the kernel, and no word comes.
TEST(PublishingToNobody, ASilentPortIsLeft) {
  const auto listener = modbus::listen_on("127.0.0.1", 0, {});
  MqttBench bench(modbus::port_of(listener));
  bench.settings.link.patience = milliseconds(200);
  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until([&] { return bench.count().fault != 0; }));
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(MqttFault::Unreachable));
  EXPECT_THAT(bench.said(), HasSubstr("no answer to the greeting"));
  bench.pass(60'000 * MqttBench::ms);
  bench.turn();  // it is tried again
  const auto begin = std::chrono::steady_clock::now();
  bench.finish();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, prompt) << "there is nobody to say farewell to";
  EXPECT_EQ(bench.count().lost, 11U);
  EXPECT_THAT(bench.remarks().problem(), HasSubstr("11 since the start"));
}

/// A network that swallows packets: the system's own connect waits for minutes. A queue of connections that is full
/// does the same.
TEST(PublishingToNobody, AConnectThatHangsIsSaidAndHoldsUpNothing) {
  const Descriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* const general = reinterpret_cast<sockaddr*>(&address);
  socklen_t length = sizeof address;
  ASSERT_EQ(::bind(listener.number(), general, length), 0);
  ASSERT_EQ(::getsockname(listener.number(), general, &length), 0);
  ASSERT_EQ(::listen(listener.number(), 0), 0);
  std::vector<Descriptor> fillers;
  for (int i = 0; i < 3; ++i) {
    fillers.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    (void)::connect(fillers.back().number(), general, length);
  }
  MqttBench bench(ntohs(address.sin_port));
  bench.settings.link.patience = milliseconds(200);
  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until([&] { return bench.count().fault != 0; }));
  EXPECT_THAT(bench.said(), HasSubstr("does not answer"));
  bench.run(1000);
  auto begin = std::chrono::steady_clock::now();
  bench.turn();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, prompt);
  EXPECT_EQ(bench.count().waiting, 111U) << "rows are taken meanwhile";
  EXPECT_EQ(bench.said(), "") << "it is said once";
  begin = std::chrono::steady_clock::now();
  bench.finish();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, prompt);
  EXPECT_EQ(bench.count().lost, 111U);
}

TEST(PublishingToNobody, APauseGrowsToAMinute) {
  MqttBench bench(test::free_port());
  bench.start();
  bench.run(1);
  std::vector<std::int64_t> pauses;
  // A try begins where time has passed; the fault is said by each anew.
  for (int tries = 0; tries < 9; ++tries) {
    ASSERT_TRUE(bench.until([&] { return !bench.remarks().problem().empty(); }));
    bench.remarks().is_well("");
    std::int64_t waited = 0;
    while (bench.remarks().problem().empty() && waited < 120'000) {
      bench.pass(250 * MqttBench::ms);
      waited += 250;
      for (int i = 0; i < 4; ++i) {
        bench.turn();
      }
    }
    pauses.push_back(waited);
  }
  EXPECT_GE(pauses[0], 700);
  EXPECT_LE(pauses[0], 2500);
  EXPECT_GT(pauses[3], 5000);
  EXPECT_GE(pauses.back(), 45'000);
  EXPECT_LE(pauses.back(), 62'000);
}

/// The thread itself, as a task has it.
TEST_F(PublishingTrouble, TheThreadEndsInTimeWhateverTheBrokerDoes) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  MqttBench bench(broker.port());
  for (const bool hangs : {false, true}) {
    KeptCounter counter;
    SampleTap tap({0, 1, 2}, 1, 1000, counter);
    Mqtt mqtt(
        bench.settings, std::make_unique<JsonDialect>("plant", 1, bench.settings.rows.points), tap, counter,
        {.utc = [] { return std::int64_t{0}; },
         .steady = [] { return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count(); },
         .elapsed = [] { return std::uint64_t{1}; }});
    for (std::uint64_t i = 1; i <= 10; ++i) {
      tap.offer(i, i, std::vector<double>{1.0, 2.0, 0.0});
    }
    ASSERT_TRUE(soon([&] { return counter.read().done == 10; }));
    if (hangs) {
      broker.halt();
    }
    for (std::uint64_t i = 11; i <= 20; ++i) {
      tap.offer(i, i, std::vector<double>{1.0, 2.0, 0.0});
    }
    const auto begin = std::chrono::steady_clock::now();
    mqtt.finish();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, prompt);
    EXPECT_EQ(counter.read().done, hangs ? 10U : 20U);
    EXPECT_EQ(counter.read().lost, hangs ? 10U : 0U);
  }
}

}  // namespace
}  // namespace hysteron::runtime
