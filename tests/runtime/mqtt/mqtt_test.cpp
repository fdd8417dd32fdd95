// Rows on their way to a real broker: each arrives, in order, with the time of its sample, whatever becomes of the
// broker; and what cannot arrive is counted.
#include "runtime/mqtt/mqtt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "runtime/mqtt/sparkplug.hpp"
#include "tests/runtime/mqtt/mqtt_bench.hpp"
#include "tests/runtime/mqtt/sparkplug_decoder.hpp"

namespace hysteron::runtime {
namespace {

using nlohmann::json;
using test::Broker;
using test::MqttBench;
using test::numbers_in;
using test::soon;
using test::Subscriber;
using testing::AllOf;
using testing::HasSubstr;

class Publishing : public test::WithBroker {};

class PublishingSparkplug : public test::WithBroker {
 protected:
  void SetUp() override {
    test::WithBroker::SetUp();
    test::skip_without_protoc();
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

/// Whether the last message that came, if one has come yet, has a word.
bool last_says(const Subscriber& subscriber, std::string_view word) {
  const auto heard = subscriber.heard();
  return !heard.empty() && heard.back().payload.find(word) != std::string::npos;
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
    ASSERT_TRUE(soon([&] { return last_says(subscriber, "false"); }));
    auto rows = subscriber.on("plant/data");
    rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(before));
    EXPECT_EQ(numbers_in(rows), grid(1000));
    for (const std::string& text : rows) {
      const json row = json::parse(text);
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

/// A power cut while the broker is away: what had waited for a second is there, before all that comes, in order.
TEST_F(Publishing, WhatWaitsOnTheDiskOutlivesTheProcess) {
  const hysteron::test::ScratchFolder folder;
  Broker broker;
  MqttBench bench(broker.port());
  bench.settings.file = folder / "rows.sqlite";
  bench.start();
  bench.turn();
  bench.run(500);
  ASSERT_TRUE(bench.until([&] { return bench.count().fault != 0; }));
  bench.run(2000);
  bench.turn();
  bench.pass(1100 * MqttBench::ms);
  bench.turn();
  bench.run(300);
  bench.turn();  // these are too young, and die with the process
  bench.stop();
  bench.start();
  bench.turn();
  EXPECT_THAT(bench.said(), HasSubstr(" rows of before wait for 127.0.0.1:"));
  bench.run(400);
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  bench.pass(60'000 * MqttBench::ms);
  ASSERT_TRUE(bench.until_confirmed());
  ASSERT_TRUE(soon([&] {
    const auto rows = numbers_in(subscriber.on("plant/data"));
    return !rows.empty() && rows.back() == 3200;
  }));
  const auto heard = without_repetitions(numbers_in(subscriber.on("plant/data")));
  auto expected = grid(3200);
  std::erase_if(expected, [](std::int64_t one) { return one > 2500 && one <= 2800; });
  EXPECT_EQ(heard, expected);
  bench.pass(1100 * MqttBench::ms);
  bench.turn();
  bench.stop();
  EXPECT_TRUE(OutboxFile(folder / "rows.sqlite", {"U", "Y"}).rows().empty()) << "the broker has them";
}

TEST_F(Publishing, AFileThatCannotBeWrittenIsSaidAndRowsGoByMemory) {
  const hysteron::test::ScratchFolder folder;
  folder.write("in_the_way", "");
  Broker broker;
  ASSERT_TRUE(broker.start());
  MqttBench bench(broker.port());
  bench.settings.file = folder / "in_the_way/rows.sqlite";
  bench.start();
  bench.run(100);
  ASSERT_TRUE(bench.until_confirmed());
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(MqttFault::File));
  EXPECT_THAT(bench.said(), HasSubstr("rows that wait are in memory alone: "));
  std::filesystem::remove(folder / "in_the_way");
  bench.pass(10'100 * MqttBench::ms);
  bench.turn();
  bench.pass(1100 * MqttBench::ms);
  bench.turn();
  EXPECT_EQ(bench.count().fault, 0U);
  EXPECT_THAT(bench.said(), HasSubstr("rows that wait are on the disk again."));
  bench.finish();
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

TEST_F(Publishing, AClockThatIsSetReordersNothing) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  MqttBench bench(broker.port());
  bench.start();
  bench.run(500);
  bench.turn();
  bench.set_clock(-3'600'000 * MqttBench::ms);
  bench.run(500);
  ASSERT_TRUE(bench.until_confirmed());
  EXPECT_THAT(bench.said(), HasSubstr("clock was set back by 3600.0 s"));
  bench.finish();
  ASSERT_TRUE(soon([&] { return subscriber.on("plant/data").size() >= 101; }));
  const auto rows = subscriber.on("plant/data");
  EXPECT_EQ(numbers_in(rows), grid(1000));
  EXPECT_EQ(json::parse(rows[50]).at("timestamp"), MqttBench::noon_ms + 500);
  EXPECT_EQ(json::parse(rows[100]).at("timestamp"), MqttBench::noon_ms + 1000 - 3'600'000);
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
  ASSERT_TRUE(soon([&] { return last_says(subscriber, "false"); }));
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

TEST_F(Publishing, AfterALossTheNextRowOfChangesIsWhole) {
  Broker broker;
  MqttBench bench(broker.port());
  bench.settings.rows.on_change = true;
  bench.settings.rows.points[1].dead_band = 1e9;
  bench.settings.rows.refresh = 1'000'000'000;
  bench.settings.bytes = 5'000;
  bench.start();
  for (int i = 0; i < 20; ++i) {
    bench.run(100);
    bench.turn();
  }
  EXPECT_GT(bench.count().lost, 100U);
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  bench.pass(60'000 * MqttBench::ms);
  ASSERT_TRUE(bench.until_confirmed());
  bench.run(20);
  ASSERT_TRUE(bench.until_confirmed());
  bench.finish();
  ASSERT_TRUE(soon([&] { return last_says(subscriber, "false"); }));
  const auto rows = subscriber.on("plant/data");
  ASSERT_GT(rows.size(), 3U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(json::parse(rows[i]).at("values").size(), i + 2 == rows.size() ? 2U : 1U) << rows[i];
  }
}

TEST_F(PublishingSparkplug, IsBornAgainWhenItIsAskedAndDiesOfACrash) {
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

}  // namespace
}  // namespace hysteron::runtime
