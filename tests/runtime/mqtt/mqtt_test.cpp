// Rows on their way to a real broker: each arrives, in order, with the time of its sample, whatever becomes of the
// broker; and what cannot arrive is counted.
#include "runtime/mqtt/mqtt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>

#include "runtime/modbus/listen.hpp"
#include "runtime/mqtt/sparkplug.hpp"
#include "tests/runtime/modbus/test_certificates.hpp"
#include "tests/runtime/mqtt/mqtt_bench.hpp"
#include "tests/runtime/mqtt/sparkplug_decoder.hpp"

namespace hysteron::runtime {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using test::Broker;
using test::MqttBench;
using test::numbers_in;
using test::soon;
using test::Subscriber;
using testing::AllOf;
using testing::HasSubstr;

class Publishing : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_broker()) {
      GTEST_SKIP() << "no broker is installed: apt install mosquitto mosquitto-clients";
    }
  }
};

/// What somebody makes of rows that may come twice: those that are newer than all before.
std::vector<std::int64_t> without_repetitions(const std::vector<std::int64_t>& numbers) {
  std::vector<std::int64_t> list;
  for (const std::int64_t one : numbers) {
    if (list.empty() || one > list.back()) {
      list.push_back(one);
    }
  }
  return list;
}

/// 1, 10, 20, … up to `last`: one for each tenth cycle.
std::vector<std::int64_t> grid(std::int64_t last) {
  std::vector<std::int64_t> list{1};
  for (std::int64_t i = 10; i <= last; i += 10) {
    list.push_back(i);
  }
  return list;
}

TEST_F(Publishing, GivesEachRowWithItsTime) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  for (const int qos : {0, 1}) {
    const std::size_t before = subscriber.on("plant/data").size();
    MqttBench bench(broker.port());
    bench.qos = qos;
    bench.start();
    bench.run(1000);
    ASSERT_TRUE(bench.until_confirmed()) << bench.remarks().problem();
    EXPECT_EQ(bench.count().done, 101U);
    EXPECT_EQ(bench.count().lost, 0U);
    EXPECT_EQ(bench.count().fault, 0U);
    bench.finish();
    EXPECT_FALSE(bench.count().is_connected);
    EXPECT_EQ(bench.said(), "");
    ASSERT_TRUE(soon([&] { return subscriber.heard().back().payload.find("false") != std::string::npos; }));
    auto rows = subscriber.on("plant/data");
    rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(before));
    EXPECT_EQ(numbers_in(rows), grid(1000));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const json row = json::parse(rows[i]);
      const auto cycle = row.at("cycle").get<std::int64_t>();
      EXPECT_EQ(row.at("timestamp"), MqttBench::noon_ms + cycle) << "of the sample, not of the sending";
      EXPECT_EQ(row.at("values").at("Y").at("value"), 0.5 * static_cast<double>(cycle));
    }
  }
  const auto states = subscriber.on("plant/state");
  ASSERT_EQ(states.size(), 4U);
  EXPECT_TRUE(json::parse(states[0]).at("online").get<bool>());
  EXPECT_FALSE(json::parse(states[3]).at("online").get<bool>());
}

TEST_F(Publishing, AStoredRowKeepsItsPlaceAndItsTime) {
  Broker broker;
  MqttBench bench(broker.port());
  bench.start();
  bench.run(500);
  ASSERT_TRUE(bench.until([&] { return bench.count().fault != 0; }));
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(MqttFault::Unreachable));
  EXPECT_EQ(bench.count().waiting, 51U);
  EXPECT_THAT(bench.said(), AllOf(HasSubstr("nothing reaches 127.0.0.1:"), HasSubstr("Connection refused"),
                                  HasSubstr("The task goes on.")));
  for (int i = 0; i < 20; ++i) {
    bench.run(100);
    bench.turn();
  }
  EXPECT_EQ(bench.said(), "") << "it is said once";
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  bench.pass(60'000 * MqttBench::ms);
  ASSERT_TRUE(bench.until_confirmed());
  EXPECT_EQ(bench.count().fault, 0U);
  EXPECT_THAT(bench.said(), AllOf(HasSubstr("connected to 127.0.0.1:"), HasSubstr("0 are lost")));
  bench.finish();
  ASSERT_TRUE(soon([&] { return subscriber.on("plant/data").size() >= 251; }));
  const auto rows = subscriber.on("plant/data");
  EXPECT_EQ(numbers_in(rows), grid(2500));
  EXPECT_EQ(json::parse(rows[50]).at("timestamp"), MqttBench::noon_ms + 500) << "what waited for a minute";
}

/// The broker dies as rows are on their way, again and again.
TEST_F(Publishing, AKilledBrokerLosesNothingThatWasConfirmedAndReordersNothing) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  std::mt19937 random(5);
  std::vector<std::int64_t> heard;
  for (const int qos : {1, 0}) {
    heard.clear();
    MqttBench bench(broker.port());
    bench.qos = qos;
    bench.start();
    std::uint64_t cycles = 0;
    for (int round = 0; round < 6; ++round) {
      const Subscriber subscriber(broker);
      const auto confirmed_before = bench.count().done;
      const auto deaths = confirmed_before + 20 + random() % 300;
      bench.pass(60'000 * MqttBench::ms);
      (void)bench.until([&] {
        bench.run(100);
        cycles += 100;
        return bench.count().done >= deaths;
      });
      broker.kill();
      const auto confirmed = bench.count().done;
      // What was confirmed has been handed to whoever listened.
      ASSERT_TRUE(soon([&] { return subscriber.on("plant/data").size() >= confirmed - confirmed_before; }));
      for (const std::int64_t one : numbers_in(subscriber.on("plant/data"))) {
        heard.push_back(one);
      }
      EXPECT_GE(without_repetitions(heard).size(), confirmed) << "of quality " << qos << ", round " << round;
      bench.run(200);
      cycles += 200;
      (void)bench.until([&] { return bench.count().fault != 0; });
      ASSERT_TRUE(broker.start());
    }
    const Subscriber subscriber(broker);
    bench.pass(60'000 * MqttBench::ms);
    ASSERT_TRUE(bench.until_confirmed());
    EXPECT_EQ(bench.count().lost, 0U);
    EXPECT_EQ(bench.count().done, cycles / 10 + 1);
    const auto expected = grid(static_cast<std::int64_t>(cycles));
    ASSERT_TRUE(soon([&] {
      const auto last = numbers_in(subscriber.on("plant/data"));
      return !last.empty() && last.back() == expected.back();
    }));
    for (const std::int64_t one : numbers_in(subscriber.on("plant/data"))) {
      heard.push_back(one);
    }
    EXPECT_EQ(without_repetitions(heard), expected) << "of quality " << qos;
    bench.finish();
  }
}

TEST_F(Publishing, WhatIsTooMuchIsCountedAndSaidOnce) {
  Broker broker;
  MqttBench bench(broker.port());
  bench.settings.bytes = 20'000;
  bench.start();
  for (int i = 0; i < 20; ++i) {
    bench.run(1000);
    bench.turn();
  }
  const auto waiting = bench.count().waiting;
  EXPECT_GT(waiting, 50U);
  EXPECT_LT(waiting, 200U);
  EXPECT_EQ(bench.count().lost + waiting, 2001U);
  const std::string said = bench.said();
  EXPECT_THAT(said, HasSubstr("the oldest of the rows that wait for 127.0.0.1:"));
  EXPECT_EQ(said.find("the oldest"), said.rfind("the oldest"));
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  bench.pass(60'000 * MqttBench::ms);
  ASSERT_TRUE(bench.until_confirmed());
  ASSERT_TRUE(soon([&] { return subscriber.on("plant/data").size() >= waiting; }));
  const auto numbers = numbers_in(subscriber.on("plant/data"));
  EXPECT_EQ(numbers.size(), waiting);
  EXPECT_EQ(numbers.back(), 20'000) << "the newest stay";
  EXPECT_THAT(bench.said(), HasSubstr(fmt::format("{} are lost since the start", bench.count().lost)));
  bench.finish();
  EXPECT_THAT(bench.remarks().problem(), HasSubstr("since the start"));
}

TEST_F(Publishing, WhatIsTooOldIsCounted) {
  Broker broker;
  MqttBench bench(broker.port());
  bench.settings.keep = 5000 * MqttBench::ms;
  bench.start();
  bench.run(1000);
  bench.turn();
  bench.pass(4500 * MqttBench::ms);
  bench.turn();
  EXPECT_LT(bench.count().lost, 101U);
  bench.pass(2000 * MqttBench::ms);
  bench.turn();
  EXPECT_EQ(bench.count().lost, 101U);
  EXPECT_EQ(bench.count().waiting, 0U);
}

TEST_F(Publishing, AWrongPasswordIsRefusedAndTriedAgain) {
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
  EXPECT_THAT(said, HasSubstr("not authorised"));
  EXPECT_EQ(said.find("secret"), std::string::npos);
  bench.finish();
  EXPECT_EQ(bench.count().lost, 11U) << "nothing was sent";
  bench.settings.link.password = "right";
  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until_confirmed()) << bench.remarks().problem();
  bench.finish();
}

class PublishingOverTls : public Publishing {
 protected:
  void SetUp() override {
    Publishing::SetUp();
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

TEST_F(Publishing, ABrokerThatHangsIsLeftAndTheEndIsQuick) {
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
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
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
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1)) << "there is nobody to say farewell to";
  EXPECT_EQ(bench.count().lost, 11U);
  EXPECT_THAT(bench.remarks().problem(), HasSubstr("11 since the start"));
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

TEST_F(Publishing, ChangesAloneWhereTheyAreAskedFor) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  MqttBench bench(broker.port());
  bench.settings.rows.on_change = true;
  bench.settings.rows.points[0].dead_band = 45.0;
  bench.settings.rows.points[1].dead_band = 1e9;
  bench.start();
  bench.run(1);
  ASSERT_TRUE(bench.until_confirmed());
  bench.run(999);
  ASSERT_TRUE(bench.until_confirmed());
  bench.finish();
  ASSERT_TRUE(soon([&] { return subscriber.heard().back().payload.find("false") != std::string::npos; }));
  const auto rows = subscriber.on("plant/data");
  EXPECT_EQ(json::parse(rows[0]).at("values").size(), 2U) << "the first is whole";
  const auto numbers = numbers_in(rows);
  ASSERT_EQ(numbers.size(), 21U) << "the first, that of 10 after the connection, and each fifth";
  EXPECT_EQ(json::parse(rows[1]).at("values").size(), 2U) << "what is first after a connection is whole";
  for (std::size_t i = 2; i < numbers.size(); ++i) {
    EXPECT_EQ(json::parse(rows[i]).at("values").size(), 1U);
    EXPECT_EQ(numbers[i] - numbers[i - 1], 50);
  }
}

TEST_F(Publishing, SparkplugIsBornAgainWhenItIsAskedAndDiesOfACrash) {
  if (!test::has_protoc()) {
    GTEST_SKIP() << "no protoc is installed: apt install protobuf-compiler";
  }
  Broker broker;
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  const std::string base = "spBv1.0/g/";
  const auto count = [&](const std::string& kind) { return subscriber.on(base + kind + "/n").size(); };
  MqttBench bench(broker.port());
  bench.start(std::make_unique<SparkplugNode>("g", "n", bench.settings.rows.points));
  bench.run(100);
  ASSERT_TRUE(bench.until_confirmed());
  bench.run(50);
  ASSERT_TRUE(bench.until_confirmed());
  EXPECT_EQ(bench.count().done, 16U);
  ASSERT_TRUE(soon([&] { return count("NDATA") == 16; }));
  EXPECT_EQ(count("NBIRTH"), 1U);
  const auto data = subscriber.on(base + "NDATA/n");
  for (std::size_t i = 0; i < data.size(); ++i) {
    const std::string text = test::decoded_sparkplug(data[i]);
    EXPECT_THAT(text, testing::EndsWith(fmt::format("\nseq: {}\n", i + 1)));
    EXPECT_EQ(text.find("is_historical: true") != std::string::npos, i < 11) << "from before the connection";
  }
  // Another program asks for a birth.
  const std::string command =
      test::encoded_sparkplug("metrics { name: \"Node Control/Rebirth\" datatype: 11 boolean_value: true }");
  const std::string file = broker.folder().write("command", command);
  const auto ask = fmt::format("mosquitto_pub -h 127.0.0.1 -p {} -t spBv1.0/g/NCMD/n -f '{}'", broker.port(), file);
  ASSERT_EQ(std::system(ask.c_str()), 0);
  bench.pass(1000 * MqttBench::ms);
  ASSERT_TRUE(bench.until([&] { return count("NBIRTH") == 2; }));
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(std::system(ask.c_str()), 0);
  }
  bench.turn();
  EXPECT_EQ(count("NBIRTH"), 2U);
  bench.pass(1000 * MqttBench::ms);
  ASSERT_TRUE(bench.until([&] { return count("NBIRTH") == 3; }));
  EXPECT_LT(count("NBIRTH"), 6U) << "one a second, however often it is asked for";
  EXPECT_EQ(count("NDEATH"), 0U);
  bench.stop();  // without a farewell
  ASSERT_TRUE(soon([&] { return count("NDEATH") == 1; })) << "the broker says it";
  EXPECT_THAT(test::decoded_sparkplug(subscriber.on(base + "NDEATH/n")[0]), HasSubstr("long_value: 0\n"));
  bench.start(std::make_unique<SparkplugNode>("g", "n", bench.settings.rows.points));
  bench.run(10);
  ASSERT_TRUE(bench.until_confirmed());
  bench.finish();
  ASSERT_TRUE(soon([&] { return count("NDEATH") == 2; })) << "its own farewell, once";
}

/// The thread itself, as a task has it.
TEST_F(Publishing, TheThreadEndsInTimeWhateverTheBrokerDoes) {
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
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(hangs ? 5 : 2));
    EXPECT_EQ(counter.read().done, hangs ? 10U : 20U);
    EXPECT_EQ(counter.read().lost, hangs ? 10U : 0U);
  }
}

}  // namespace
}  // namespace hysteron::runtime
