// verdict.json: the keys and types that programs rely on, in version 1.
#include "diagnosis/report/verdict_json.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

Diagnosis full() {
  Diagnosis found;
  found.verdict = Verdict::Named;
  found.summary = "creep at HYST.XOUT (…).";
  found.effects = {{.id = "creep",
                    .edge = "HYST.XOUT",
                    .same_edges = {"Y"},
                    .drivers = {"V"},
                    .share = 0.93,
                    .inverse = Inverse::Exact,
                    .parameters = {{.name = "GAIN", .value = 0.1, .low = 0.09, .high = 0.11, .unit = "1"}},
                    .settings = {{.name = "T_ONSET", .value = 0.01, .unit = "s"}}},
                   {.id = "rate_limit", .edge = "U", .share = 0.05, .inverse = Inverse::Avoidable}};
  found.rivals = {{.effects = {"creep"}, .edges = {"HYST.XOUT"}, .improved_rms = 0.2, .probability = 0.9},
                  {.effects = {"drift", "relaxation"}, .edges = {"U", "Y"}, .improved_rms = 0.3, .probability = 0.1}};
  found.confidence = 0.97;
  found.unknown_score = 0.02;
  found.gap = {.signal = "Y",
               .unit = "um",
               .nominal = 1.0,
               .calibrated = 0.8,
               .improved = 0.2,
               .floor = {.value = 0.19, .evidence = "repeats"},
               .closed = 0.99,
               .closed_low = 0.98,
               .closed_high = 1.0};
  found.gaps = {found.gap};
  found.edges = {{.edge = "U", .share = 0.4, .group = {"AMP.XOUT"}}};
  for (const char* over : {"amplitude", "frequency", "run time"}) {
    found.maps.push_back(
        {.over = over, .unit = "V", .places = {0.0, 1.0}, .before = {1.0, 2.0}, .after = {0.1, 0.2}, .share = 0.3});
  }
  found.cannot_tell = {"a delay before or behind the hysteresis"};
  found.next = {.title = "Staircase", .reason = "creep or drift", .input = "U", .unit = "V", .separation = 3.0};
  found.next.steps = {{"step to 1 V", "10 s"}};
  found.seconds = 1.5;
  return found;
}

/// Every key of the schema with the type that its example has.
TEST(VerdictJson, HasTheKeysAndTypesOfVersion1) {
  const json schema = json::parse(R"({"schema":"hysteron-verdict/1","verdict":"named",
    "effects":[{"id":"creep","edge":"HYST.XOUT","share":0.93,"invertible":true,
                "parameters":{"GAIN":{"value":0.1,"low":0.09,"high":0.11,"unit":"1"}},
                "settings":{"T_ONSET":{"value":0.01,"unit":"s"}}}],
    "rivals":[["creep"],["drift","relaxation"]],"confidence":0.97,"unknown_score":0.02,
    "gap":{"signal":"Y","unit":"um","nominal_rms":1.0,"calibrated_rms":0.8,"improved_rms":0.2,"floor_rms":0.19,
           "closed":0.99,"closed_low":0.98,"closed_high":1.0},
    "where":{"edges":[],"regions":[],"bands":[],"times":[]},"cannot_tell":["a delay before or behind the hysteresis"],
    "next_experiment":{},"seconds":1.5})");
  const json verdict = json::parse(verdict_json(full()));
  const std::function<void(const json&, const json&, const std::string&)> holds =
      [&](const json& wanted, const json& found, const std::string& path) {
        EXPECT_STREQ(wanted.type_name(), found.type_name()) << path;
        if (wanted.is_object() && found.is_object()) {
          for (const auto& [key, value] : wanted.items()) {
            ASSERT_TRUE(found.contains(key)) << path + "/" + key;
            holds(value, found[key], path + "/" + key);
          }
        } else if (wanted.is_array() && !wanted.empty()) {
          ASSERT_FALSE(found.empty()) << path;
          holds(wanted[0], found[0], path + "/0");
        } else if (!wanted.is_array()) {
          EXPECT_EQ(wanted, found) << path;
        }
      };
  holds(schema, verdict, "");
  EXPECT_EQ(verdict["rivals"], schema["rivals"]);
  EXPECT_EQ(verdict["refused"], false);
}

TEST(VerdictJson, MapsStandWhereTheyBelong) {
  const json where = json::parse(verdict_json(full()))["where"];
  ASSERT_EQ(where["edges"].size(), 1U);
  EXPECT_EQ(where["edges"][0]["group"], json::array({"AMP.XOUT"}));
  ASSERT_EQ(where["regions"].size(), 1U);
  ASSERT_EQ(where["bands"].size(), 1U);
  ASSERT_EQ(where["times"].size(), 1U);
  EXPECT_EQ(where["regions"][0]["over"], "amplitude");
  EXPECT_EQ(where["bands"][0]["over"], "frequency");
  EXPECT_EQ(where["times"][0]["over"], "run time");
}

TEST(VerdictJson, SplitsTheGapAndHasTheControllerWhereThereIsATrace) {
  Diagnosis found = full();
  found.split = {.input_output = 0.25, .plant = 0.7, .open = 0.05};
  found.cuts = {{.signal = "H1_MEASURED", .agrees = true}};
  json verdict = json::parse(verdict_json(found));
  EXPECT_EQ(verdict["split"]["input_output"], 0.25);
  EXPECT_EQ(verdict["where"]["cuts"][0]["signal"], "H1_MEASURED");
  EXPECT_EQ(verdict["where"]["cuts"][0]["agrees"], true);
  EXPECT_FALSE(verdict["split"].contains("controller"));
  found.controller = ControllerFinding{.steps = 7, .different = 2, .first_different = 3};
  verdict = json::parse(verdict_json(found));
  EXPECT_EQ(verdict["split"]["controller"]["same_bits"], false);
  EXPECT_EQ(verdict["split"]["controller"]["first_different"], 3);
}

TEST(VerdictJson, SaysWhatDrivesAnEffect) {
  const json effects = json::parse(verdict_json(full()))["effects"];
  EXPECT_EQ(effects[0]["drivers"], json({"V"}));
  EXPECT_TRUE(effects[1]["drivers"].empty());
}

TEST(VerdictJson, OnlyAnExactInverseIsInvertible) {
  const json effects = json::parse(verdict_json(full()))["effects"];
  EXPECT_EQ(effects[0]["invertible"], true);
  EXPECT_EQ(effects[1]["invertible"], false);
}

TEST(VerdictJson, NumbersWithoutASignInJsonBecomeNull) {
  Diagnosis found = full();
  found.gap.closed = std::numeric_limits<double>::quiet_NaN();
  found.effects[0].parameters[0].high = std::numeric_limits<double>::infinity();
  found.maps[0].before[1] = std::numeric_limits<double>::quiet_NaN();
  const std::string text = verdict_json(found);
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_THAT(text, Not(HasSubstr("inf")));
  const json verdict = json::parse(text);
  EXPECT_TRUE(verdict["gap"]["closed"].is_null());
  EXPECT_TRUE(verdict["effects"][0]["parameters"]["GAIN"]["high"].is_null());
  EXPECT_TRUE(verdict["where"]["regions"][0]["before"][1].is_null());
}

TEST(VerdictJson, ARefusalHasAllKeysAsWell) {
  Diagnosis refused;
  refused.refusals = {"No input moves."};
  refused.cannot_tell = refused.refusals;
  const json verdict = json::parse(verdict_json(refused));
  const json named = json::parse(verdict_json(full()));
  for (const auto& [key, value] : named.items()) {
    EXPECT_TRUE(verdict.contains(key)) << key;
  }
  EXPECT_EQ(verdict["verdict"], "unknown");
  EXPECT_EQ(verdict["refused"], true);
  EXPECT_EQ(verdict["effects"], json::array());
  EXPECT_EQ(verdict["rivals"], json::array());
  EXPECT_EQ(verdict["next_experiment"], json::object());
  EXPECT_EQ(verdict["confidence"], 0.0);
}

TEST(VerdictJson, EveryVerdictHasItsName) {
  const std::pair<Verdict, const char*> names[] = {{Verdict::None, "none"},       {Verdict::Calibration, "calibration"},
                                                   {Verdict::Named, "named"},     {Verdict::Group, "group"},
                                                   {Verdict::Partial, "partial"}, {Verdict::Unknown, "unknown"}};
  for (const auto& [verdict, name] : names) {
    EXPECT_EQ(name_of(verdict), name);
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
