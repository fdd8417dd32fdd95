// Sparkplug B, read by protoc: an independent decoder of what is written by hand.
#include "runtime/mqtt/sparkplug.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "runtime/mqtt/wire_format.hpp"
#include "tests/runtime/mqtt/sparkplug_decoder.hpp"

namespace hysteron::runtime {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<MqttPoint> sparkplug_points() {
  return {{.name = "U", .unit = "V"},
          {.name = "B", .unit = "1", .type = PointType::boolean},
          {.name = "S", .unit = "1", .type = PointType::int16},
          {.name = "W", .unit = "1", .type = PointType::uint16},
          {.name = "I", .unit = "1", .type = PointType::int32},
          {.name = "D", .unit = "1", .type = PointType::uint32},
          {.name = "L", .unit = "1", .type = PointType::int64},
          {.name = "Q", .unit = "1", .type = PointType::uint64},
          {.name = "F", .unit = "um", .type = PointType::real32}};
}

MqttRow sparkplug_row() {
  MqttRow row{.utc_ms = 1'795'867'200'123, .cycle = 7};
  const std::vector<double> values{0.1, 1.0, -2.0, 65535.0, -2147483648.0, 4294967295.0, -5.0, 0x1p53, 0.25};
  for (std::size_t i = 0; i < values.size(); ++i) {
    row.values.push_back({.point = i, .value = values[i]});
  }
  return row;
}

class Sparkplug : public testing::Test {
 protected:
  void SetUp() override { test::skip_without_protoc(); }
  SparkplugNode node{"plant", "stage", sparkplug_points()};
};

TEST_F(Sparkplug, ABirthNamesEveryMetric) {
  const MqttMessage will = node.will();
  EXPECT_EQ(will.topic, "spBv1.0/plant/NDEATH/stage");
  EXPECT_EQ(will.qos, 1);
  EXPECT_FALSE(will.retain);
  EXPECT_EQ(test::decoded_sparkplug(will.payload), "metrics {\n  name: \"bdSeq\"\n  datatype: 4\n  long_value: 0\n}\n");
  const MqttMessage birth = node.birth(sparkplug_row(), 1'795'867'201'000);
  EXPECT_EQ(birth.topic, "spBv1.0/plant/NBIRTH/stage");
  EXPECT_EQ(birth.qos, 0);
  EXPECT_FALSE(birth.retain);
  const std::string text = test::decoded_sparkplug(birth.payload);
  EXPECT_THAT(text, testing::StartsWith("timestamp: 1795867201000\n"));
  EXPECT_THAT(text, testing::EndsWith("seq: 0\n"));
  EXPECT_THAT(text, HasSubstr("  name: \"bdSeq\"\n  timestamp: 1795867201000\n  datatype: 4\n  long_value: 0\n"));
  EXPECT_THAT(text, HasSubstr("  name: \"Node Control/Rebirth\"\n  timestamp: 1795867201000\n  datatype: 11\n"
                              "  boolean_value: false\n"));
  const auto metric = [&](const std::string& name, int alias, int type, const std::string& unit,
                          const std::string& value) {
    EXPECT_THAT(text, HasSubstr("  name: \"" + name + "\"\n  alias: " + std::to_string(alias) +
                                "\n  timestamp: 1795867200123\n  datatype: " + std::to_string(type) +
                                "\n  properties {\n    keys: \"engUnit\"\n    keys: \"Quality\"\n    values {\n"
                                "      type: 12\n      string_value: \"" +
                                unit + "\"\n    }\n    values {\n      type: 3\n      int_value: 192\n    }\n  }\n  " +
                                value + "\n}\n"));
  };
  metric("U", 1, 10, "V", "double_value: 0.1");
  metric("B", 2, 11, "1", "boolean_value: true");
  metric("S", 3, 2, "1", "int_value: 4294967294");
  metric("W", 4, 6, "1", "int_value: 65535");
  metric("I", 5, 3, "1", "int_value: 2147483648");
  metric("D", 6, 7, "1", "int_value: 4294967295");
  metric("L", 7, 4, "1", "long_value: 18446744073709551611");
  metric("Q", 8, 8, "1", "long_value: 9007199254740992");
  metric("F", 9, 9, "um", "float_value: 0.25");
}

TEST_F(Sparkplug, DataAreByAliasWithTheTimeOfTheSample) {
  (void)node.will();
  (void)node.birth(sparkplug_row(), 0);
  const MqttMessage live = node.data({.utc_ms = 55, .values = {{.point = 0, .value = -1.5}}}, false, 99);
  EXPECT_EQ(live.topic, "spBv1.0/plant/NDATA/stage");
  EXPECT_EQ(live.qos, 0);
  EXPECT_EQ(test::decoded_sparkplug(live.payload),
            "timestamp: 99\nmetrics {\n  alias: 1\n  timestamp: 55\n  datatype: 10\n  double_value: -1.5\n}\nseq: 1\n");
  const MqttMessage stored = node.data(
      {.utc_ms = 55,
       .values = {{.point = 0, .value = std::numeric_limits<double>::quiet_NaN(), .quality = ValueQuality::Bad},
                  {.point = 1, .value = 0.0, .quality = ValueQuality::Uncertain}}},
      true, 99);
  EXPECT_EQ(test::decoded_sparkplug(stored.payload),
            "timestamp: 99\nmetrics {\n  alias: 1\n  timestamp: 55\n  datatype: 10\n  is_historical: true\n"
            "  is_null: true\n  properties {\n    keys: \"Quality\"\n    values {\n      type: 3\n      int_value: 0\n"
            "    }\n  }\n}\nmetrics {\n  alias: 2\n  timestamp: 55\n  datatype: 11\n  is_historical: true\n"
            "  properties {\n    keys: \"Quality\"\n    values {\n      type: 3\n      int_value: 500\n    }\n  }\n"
            "  boolean_value: false\n}\nseq: 2\n");
}

TEST_F(Sparkplug, SequencesGoRoundAndBeginAnewWithABirth) {
  (void)node.will();
  (void)node.birth(sparkplug_row(), 0);
  for (unsigned i = 1; i < 600; ++i) {
    const MqttMessage data = node.data({.values = {{.point = 1, .value = 1.0}}}, false, 0);
    if (i < 3 || i % 256 < 2 || i % 256 > 253) {
      ASSERT_THAT(test::decoded_sparkplug(data.payload), testing::EndsWith("\nseq: " + std::to_string(i % 256) + "\n"));
    }
  }
  EXPECT_THAT(test::decoded_sparkplug(node.birth(sparkplug_row(), 0).payload), testing::EndsWith("\nseq: 0\n"));
  EXPECT_THAT(test::decoded_sparkplug(node.data(sparkplug_row(), false, 0).payload), testing::EndsWith("\nseq: 1\n"));
  // A death tells by its number which birth it ends.
  for (int connection = 1; connection < 300; ++connection) {
    const std::string death = node.will().payload;
    EXPECT_EQ(node.farewell(0).payload, death);
    if (connection > 253) {
      EXPECT_THAT(test::decoded_sparkplug(death), HasSubstr("long_value: " + std::to_string(connection % 256) + "\n"));
    }
  }
}

/// Written by protoc, as another program would.
TEST_F(Sparkplug, ARebirthIsToldFromOtherCommands) {
  EXPECT_EQ(node.commands(), "spBv1.0/plant/NCMD/stage");
  const auto asks = [&](const std::string& text) { return node.asks_for_birth(test::encoded_sparkplug(text)); };
  const std::string rebirth = "name: \"Node Control/Rebirth\" datatype: 11 boolean_value: ";
  EXPECT_TRUE(asks("timestamp: 5 metrics { " + rebirth + "true }"));
  EXPECT_TRUE(asks("metrics { alias: 1 double_value: 5.0 } metrics { timestamp: 7 " + rebirth + "true } seq: 3"));
  EXPECT_FALSE(asks("metrics { " + rebirth + "false }"));
  EXPECT_FALSE(asks("metrics { name: \"Node Control/Reboot\" boolean_value: true }"));
  EXPECT_FALSE(asks("metrics { name: \"U\" boolean_value: true } metrics { name: \"Node Control/Rebirth\" }"));
  EXPECT_FALSE(asks(""));
}

TEST(SparkplugCommands, AreTakenFromAnybodyWithoutHarm) {
  const SparkplugNode node("g", "n", sparkplug_points());
  std::mt19937 random(1);
  const std::string good = [] {
    WireWriter metric;
    metric.bytes(1, "Node Control/Rebirth");
    metric.varint(14, 1);
    WireWriter payload;
    payload.bytes(2, metric.written());
    return payload.written();
  }();
  EXPECT_TRUE(node.asks_for_birth(good));
  for (std::size_t cut = 0; cut < good.size(); ++cut) {
    EXPECT_FALSE(node.asks_for_birth(good.substr(0, cut))) << cut;
  }
  for (int i = 0; i < 100'000; ++i) {
    std::string bytes = i % 2 == 0 ? good : std::string(random() % 64, '\0');
    for (std::size_t change = 0; change < 1 + bytes.size() / 8 && !bytes.empty(); ++change) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    (void)node.asks_for_birth(bytes);
  }
}

TEST(WireFormat, ReadsBackWhatItWrites) {
  std::mt19937_64 random(2);
  WireWriter writer;
  std::vector<std::uint64_t> numbers;
  for (unsigned bits = 0; bits < 64; ++bits) {
    numbers.push_back(random() >> bits);
    writer.varint(bits + 1, numbers.back());
  }
  writer.real(70, -0.0);
  writer.real(71, 1.5F);
  writer.bytes(72, std::string(300, 'x'));
  WireReader reader(writer.written());
  for (unsigned bits = 0; bits < 64; ++bits) {
    const auto field = reader.next();
    ASSERT_TRUE(field);
    EXPECT_EQ(field->number, bits + 1);
    EXPECT_EQ(field->value, numbers[bits]);
  }
  EXPECT_EQ(reader.next()->value, std::uint64_t{1} << 63U);
  EXPECT_EQ(reader.next()->value, 0x3FC00000U);
  EXPECT_EQ(reader.next()->bytes.size(), 300U);
  EXPECT_FALSE(reader.next());
}

}  // namespace
}  // namespace hysteron::runtime
