// Rows as JSON, read by another hand.
#include "runtime/mqtt/json_dialect.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

namespace hysteron::runtime {
namespace {

using nlohmann::json;

std::vector<MqttPoint> json_points() {
  return {{.name = "U", .unit = "V"},
          {.name = "N", .unit = "1", .type = PointType::int32},
          {.name = "ON", .unit = "1", .type = PointType::boolean},
          {.name = "A\"B\\", .unit = "\xB0 \xC2\xB0"}};
}

TEST(JsonRows, SayValueUnitQualityAndTime) {
  JsonDialect dialect("plant/stage", 1, json_points());
  const MqttMessage message =
      dialect.data({.utc_ms = 1'795'867'200'123,
                    .cycle = 1'000'000'007,
                    .values = {{.point = 0, .value = 0.1 + 0.2},
                               {.point = 1, .value = -2147483648.0, .quality = ValueQuality::Uncertain},
                               {.point = 2, .value = 1.0},
                               {.point = 3, .value = 1e300, .quality = ValueQuality::Bad}}},
                   false, 0);
  EXPECT_EQ(message.topic, "plant/stage/data");
  EXPECT_EQ(message.qos, 1);
  EXPECT_FALSE(message.retain);
  const json read = json::parse(message.payload);
  EXPECT_EQ(read.at("timestamp"), 1'795'867'200'123);
  EXPECT_EQ(read.at("cycle"), 1'000'000'007);
  const json& values = read.at("values");
  EXPECT_EQ(values.size(), 4U);
  EXPECT_EQ(values.at("U"), (json{{"value", 0.1 + 0.2}, {"unit", "V"}, {"quality", "good"}})) << "to the bit";
  EXPECT_EQ(values.at("N"), (json{{"value", -2147483648}, {"unit", "1"}, {"quality", "uncertain"}}));
  EXPECT_EQ(values.at("ON"), (json{{"value", true}, {"unit", "1"}, {"quality", "good"}}));
  EXPECT_EQ(values.at("A\"B\\").at("unit"), "\xEF\xBF\xBD \xC2\xB0") << "what is no UTF-8 is replaced";
  EXPECT_EQ(values.at("A\"B\\").at("value"), 1e300);
}

TEST(JsonRows, HaveNoNumberWhereThereIsNone) {
  JsonDialect dialect("t", 0, json_points());
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const MqttMessage message =
        dialect.data({.values = {{.point = 0, .value = value, .quality = ValueQuality::Bad}}}, false, 0);
    EXPECT_EQ(message.qos, 0);
    EXPECT_TRUE(json::parse(message.payload).at("values").at("U").at("value").is_null());
  }
}

TEST(JsonRows, AreBetweenOnlineAndOffline) {
  JsonDialect dialect("t", 1, json_points());
  for (const MqttMessage& message : {dialect.will(), dialect.birth({}, 5), dialect.farewell(6)}) {
    EXPECT_EQ(message.topic, "t/state");
    EXPECT_TRUE(message.retain);
    EXPECT_EQ(message.qos, 1);
  }
  EXPECT_EQ(json::parse(dialect.will().payload), (json{{"online", false}}));
  EXPECT_EQ(json::parse(dialect.birth({}, 5).payload), (json{{"online", true}, {"timestamp", 5}}));
  EXPECT_EQ(json::parse(dialect.farewell(6).payload), (json{{"online", false}, {"timestamp", 6}}));
  EXPECT_EQ(dialect.commands(), "") << "nothing is taken from the broker";
}

}  // namespace
}  // namespace hysteron::runtime
