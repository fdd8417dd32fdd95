#include <gmock/gmock.h>

#include <limits>

#include "codegen/parameters/parameter_file.hpp"
#include "support/errors.hpp"
#include "tests/codegen/parameters/refusal.hpp"

namespace hysteron::parameters {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::string_view whole = R"(# piezo
[parameters]
GAIN = 2
[parameters.INV]
C1 = 0.05
C2 = 1.3
[parameters.loop.LIM]
ON = true
X = [0.0, 1, 2.5]

[fit.INV.C1]
min = 0.0
max = inf
start = 0.1
scale = 1e-3
[fit.INV.C2]
[fit]
GAIN = {min = 1}

[tune]
outputs = ["Y", "DRV.XOUT"]
loss = "huber"
train = [[12.0, 21], [1.0, 9.0]]
test = [21.0, 40.0]
initial_states = ["HYST.P"]
)";

std::vector<std::string> paths(const auto& items) {
  std::vector<std::string> result;
  result.reserve(items.size());
  for (const auto& item : items) {
    result.push_back(item.path);
  }
  return result;
}

TEST(ParameterReader, ReadsEverythingInTheOrderOfTheFile) {
  const auto file = parse_parameter_file("plant.toml", whole);
  EXPECT_EQ(file.file, "plant.toml");
  EXPECT_THAT(paths(file.values), ElementsAre("GAIN", "INV.C1", "INV.C2", "loop.LIM.ON", "loop.LIM.X"));
  EXPECT_EQ(file.values[0].value, Value(std::int64_t{2}));
  EXPECT_EQ(file.find("inv.c1")->value, Value(0.05));
  EXPECT_EQ(file.find("LOOP.LIM.ON")->value, Value(true));
  EXPECT_EQ(file.find("LOOP.LIM.X")->value, Value(std::vector<double>{0.0, 1.0, 2.5}));
  EXPECT_EQ(file.find("INV.C3"), nullptr);

  EXPECT_THAT(paths(file.fits), ElementsAre("INV.C1", "INV.C2", "GAIN"));
  EXPECT_EQ(file.fits[0].minimum->value, 0.0);
  EXPECT_EQ(file.fits[0].maximum->value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(file.fits[0].start->value, 0.1);
  EXPECT_EQ(file.fits[0].scale->value, 1e-3);
  EXPECT_FALSE(file.fits[1].minimum || file.fits[1].maximum || file.fits[1].start || file.fits[1].scale);
  EXPECT_EQ(file.fits[2].minimum->value, 1.0);

  ASSERT_EQ(file.tune.outputs.size(), 2U);
  EXPECT_EQ(file.tune.outputs[1].text, "DRV.XOUT");
  EXPECT_EQ(file.tune.loss, Loss::Huber);
  ASSERT_EQ(file.tune.train.size(), 2U);
  EXPECT_EQ(file.tune.train[0].begin, 1.0) << "in the order of time";
  EXPECT_EQ(file.tune.train[1].end, 21.0);
  ASSERT_EQ(file.tune.test.size(), 1U);
  EXPECT_EQ(file.tune.test[0].end, 40.0);
  EXPECT_EQ(file.tune.initial_states[0].text, "HYST.P");
}

TEST(ParameterReader, DottedKeysAndInlineTablesSayTheSame) {
  const auto file = parse_parameter_file(
      "plant.toml",
      "parameters.INV = {C1 = 0.05, C2 = 1.3}\nparameters.\"LIM.MX\" = 3\nfit.INV = {C1 = {}, C2 = {min = 0}}\n");
  EXPECT_THAT(paths(file.values), ElementsAre("INV.C1", "INV.C2", "LIM.MX"));
  EXPECT_THAT(paths(file.fits), ElementsAre("INV.C1", "INV.C2"));
}

TEST(ParameterReader, WhatEachRecordHasForItselfStandsUnderFitRecord) {
  const auto file = parse_parameter_file("plant.toml",
                                         "[fit.record]\nZERO = {}\n[fit.record.SENSOR]\nOFFSET = {min = -1}\n"
                                         "[fit.SENSOR]\nK = {}\n[fit.RECORD]\nGAIN = {}\n");
  EXPECT_THAT(paths(file.fits), ElementsAre("ZERO", "SENSOR.OFFSET", "SENSOR.K", "RECORD.GAIN"));
  std::vector<bool> own;
  for (const FitSetting& fit : file.fits) {
    own.push_back(fit.by_record);
  }
  EXPECT_THAT(own, ElementsAre(true, true, false, false)) << "an instance RECORD is written in capitals";
  EXPECT_EQ(file.fits[1].minimum->value, -1.0);
}

TEST(ParameterReader, ColumnsToBeIgnoredMayHaveAnyName) {
  const auto file = parse_parameter_file("plant.toml", "[diagnose]\nignore = [\"SP\", \"Tank level\"]\n");
  ASSERT_EQ(file.diagnose.ignore.size(), 2U);
  EXPECT_EQ(file.diagnose.ignore[1].text, "Tank level");
  EXPECT_EQ(file.diagnose.ignore[1].place.column, 17U);
}

TEST(ParameterReader, AnEmptyFileSaysNothing) {
  const auto file = parse_parameter_file("plant.toml", "");
  EXPECT_TRUE(file.values.empty() && file.fits.empty() && file.tune.outputs.empty() && file.tune.train.empty());
  EXPECT_EQ(file.tune.loss, Loss::Squares);
}

TEST(ParameterReader, EveryValueHasItsPlace) {
  const auto file = parse_parameter_file("plant.toml", "# µ\n[parameters.INV]\n  C1 = 0.05\n");
  const auto& value = file.values.front();
  EXPECT_EQ(value.place.line, 3U);
  EXPECT_EQ(value.place.column, 3U);
  EXPECT_EQ(value.place.length, 2U);
  EXPECT_EQ(value.value_place.line, 3U);
  EXPECT_EQ(value.value_place.column, 8U);
  EXPECT_EQ(value.value_place.length, 4U);
  EXPECT_EQ(value.value_place.file, "plant.toml");
}

TEST(ParameterReader, SaysWhatIsWrongWhereAndHowToMendIt) {
  EXPECT_EQ(refusal_of("[fit.INV.C1]\nmin = 0.0\nmxa = 1.0\n"),
            "HY603 error: plant.toml:3:1: There is no key mxa in the fit of INV.C1.\n"
            "    3 | mxa = 1.0\n"
            "      | ^^^\n"
            "mend: did you mean max?\n");
  EXPECT_EQ(refusal_of("[parameters.INV]\nC1 = 0.05\n  C1 = 0.06\n"),
            "HY602 error: plant.toml:3:3: This key or table has been given before.\n"
            "    3 |   C1 = 0.06\n"
            "      |   ^^^^^^^^^\n"
            "mend: keep one of the two; a table may be opened only once.\n");
  EXPECT_EQ(refusal_of("[parameters.INV]\nC1 = 0.05\n[parameters.inv]\nc1 = 0.06\n"),
            "HY602 error: plant.toml:4:1: inv.c1 has been given before.\n"
            "    4 | c1 = 0.06\n"
            "      | ^^\n"
            "mend: keep one of the two; case makes no difference.\n"
            "note: plant.toml:2:1: the first\n"
            "    2 | C1 = 0.05\n"
            "      | ^^\n");
}

struct Refused {
  std::string text;
  std::string beginning;  ///< of the first diagnostic
  std::string mend;       ///< part of it
};

TEST(ParameterReader, RefusesWhatIsNoParameterFile) {
  const Refused cases[] = {
      {"[parameters\n", "HY601 error: plant.toml:1:", ""},
      {"[parameters.INV]\nC1 = 0,05\n", "HY601 error: plant.toml:2:7: ", "decimal point"},
      {"[parameters.INV]\nC1 = .5\n", "HY601 error: plant.toml:2:6: ", "both sides"},
      {"[parameters.INV]\nON = TRUE\n", "HY601 error: plant.toml:2:6: ", "small letters"},
      {"[parameters.INV]\nC1 = 1e999\n", "HY601 error: plant.toml:2:", "LREAL"},
      {"[parameters.INV]\nC1 = 99999999999999999999\n", "HY601 error: plant.toml:2:", "18 digits"},
      {"[parameters.INV]\nC1 = ", "HY601 error: plant.toml:2:", "cut off"},
      {"C1 = \"\xB5\"\n", "HY601 error: plant.toml:1:", "UTF-8"},
      {"[parameters]\n[parameters]\n", "HY602 error: plant.toml:2:1: This key or table", "keep one"},
      {"[parameters]\nA = 1\nA.B = 2\n", "HY602 error: plant.toml:3:1: This key or table", "keep one"},
      {"[fit.INV]\nC1 = {}\nc1 = {}\n", "HY602 error: plant.toml:3:1: INV.c1 has been given before", "case"},
      {"[tune]\noutputs = [\"Y\", \"y\"]\n", "HY602 error: plant.toml:2:17: y stands in the list twice", "case"},
      {"[INV]\nC1 = 0.05\n", "HY603 error: plant.toml:1:2: There is no table or key INV", "[parameters.INV]"},
      {"C1 = 0.05\n", "HY603 error: plant.toml:1:1: There is no table or key C1", "[parameters]"},
      {"[paramters.INV]\nC1 = 0.05\n", "HY603 error: plant.toml:1:2: ", "did you mean parameters?"},
      {"[tune]\nouputs = [\"Y\"]\n", "HY603 error: plant.toml:2:1: There is no key ouputs in [tune]",
       "did you mean outputs?"},
      {"[tune]\nsolver = 1\n", "HY603 error: plant.toml:2:1: ", "outputs, loss, train"},
      {"[parameters.INV]\n\"C 1\" = 0.05\n", "HY603 error: plant.toml:2:1: \"C 1\" is no name", "letters"},
      {"[parameters.INV]\n\".\" = 0.05\n", "HY603 error: plant.toml:2:1: \".\" is no name", "letters"},
      {"[fit.INV.C1]\nmin = 0\nC2 = {}\n", "HY603 error: plant.toml:3:1: There is no key C2 in the fit of INV.C1",
       "min, max"},
      {"parameters = 1\n", "HY604 error: plant.toml:1:14: parameters must be a table, but is a whole number",
       "[parameters]"},
      {"[parameters.INV]\nC1 = \"0.05\"\n",
       "HY604 error: plant.toml:2:6: C1 must be a number, true or false, or a list of numbers, but is a text",
       "C1 = 0.05"},
      {"[parameters.INV]\nC1 = []\n", "HY604 error: plant.toml:2:6: ", "[0.0, 0.5, 1.0]"},
      {"[parameters.INV]\nC1 = [1.0, true]\n",
       "HY604 error: plant.toml:2:12: Each element of C1 must be a number, but here is true or false", "[0.0"},
      {"[[parameters.INV]]\nC1 = 1\n", "HY604 error: plant.toml:1:", ""},
      {"[parameters.INV]\nC1 = 2024-01-01\n", "HY604 error: plant.toml:2:6: ", "C1 = 0.05"},
      {"[fit.INV]\nC1 = 0.05\n", "HY604 error: plant.toml:2:6: INV.C1 must be a table of settings, but is a number",
       "C1 = {}"},
      {"[fit]\nINV = true\n", "HY604 error: plant.toml:2:7: INV must be a table of settings", "INV = {}"},
      {"[fit.INV.C1]\nmin = \"0\"\n", "HY604 error: plant.toml:2:7: min must be a number, but is a text", "min = 0.05"},
      {"[tune]\nloss = \"hubert\"\n", "HY604 error: plant.toml:2:8: There is no loss \"hubert\"", "\"huber\"?"},
      {"[tune]\nloss = 2\n", "HY604 error: plant.toml:2:8: ", "loss = "},
      {"[tune]\noutputs = \"Y\"\n", "HY604 error: plant.toml:2:11: outputs must be a list of names, but is a text",
       "[\"Y\"]"},
      {"[tune]\noutputs = []\n", "HY604 error: plant.toml:2:11: ", "[\"Y\"]"},
      {"[tune]\noutputs = [\"\"]\n", "HY604 error: plant.toml:2:12: ", "[\"Y\"]"},
      {"[tune]\ntrain = 1.0\n", "HY604 error: plant.toml:2:9: ", "[1.0, 21.0]"},
      {"[tune]\ntrain = [1.0, 2.0, 3.0]\n", "HY604 error: plant.toml:2:9: ", "[1.0, 21.0]"},
      {"[tune]\ntrain = [[1.0, 2.0], 3.0]\n", "HY604 error: plant.toml:2:22: ", "[1.0, 21.0]"},
      {"[parameters.INV]\nC1 = nan\n", "HY605 error: plant.toml:2:6: C1 is not a number", "finite"},
      {"[parameters.INV]\nC1 = [0.0, -inf]\n", "HY605 error: plant.toml:2:12: C1 is infinite", "finite"},
      {"[fit.INV.C1]\nmin = inf\n", "HY605 error: plant.toml:2:7: min is infinite", "leave the key out"},
      {"[fit.INV.C1]\nmax = nan\n", "HY605 error: plant.toml:2:7: max is not a number", "leave the key out"},
      {"[fit.INV.C1]\nstart = inf\n", "HY605 error: plant.toml:2:9: start is infinite", "finite"},
      {"[tune]\ntest = [0.0, inf]\n", "HY605 error: plant.toml:2:14: test is infinite", "finite"},
      {"[fit.INV.C1]\nmin = 1.0\nmax = 1.0\n", "HY606 error: plant.toml:3:7: The max of INV.C1 is not above its min",
       "exchange"},
      {"[fit.INV.C1]\nscale = 0.0\n", "HY606 error: plant.toml:2:9: The scale of INV.C1 is not above 0", "notable"},
      {"[fit.INV.C1]\nmin = 0.0\nstart = -1.0\n",
       "HY606 error: plant.toml:3:9: The fit of INV.C1 would start at -1, outside of 0 to inf", "widen"},
      {"[parameters.INV]\nC1 = 5\n[fit.inv.c1]\nmax = 1.0\n",
       "HY606 error: plant.toml:2:6: The fit of inv.c1 would start at 5, outside of -inf to 1", "widen"},
      {"[tune]\ntrain = [21.0, 1.0]\n", "HY606 error: plant.toml:2:9: The interval of train ends before it begins",
       "exchange"},
      {"[tune]\ntrain = [[1.0, 9.0], [8.0, 12.0]]\n", "HY606 error: plant.toml:2:22: Two intervals of train overlap",
       "join"},
      {"[fit.record]\nC1 = 1\n", "HY604 error: plant.toml:2:6: C1 must be a table of settings", "C1 = {}"},
      {"[fit.INV]\nC1 = {}\n[fit.record.INV]\nC1 = {}\n", "HY602 error: plant.toml:4:1: INV.C1 has been given before",
       "keep one"},
      {"[diagnose]\nignor = [\"SP\"]\n", "HY603 error: plant.toml:2:1: There is no key ignor in [diagnose]",
       "did you mean ignore?"},
      {"[diagnose]\nignore = \"SP\"\n", "HY604 error: plant.toml:2:10: ", "[\"SP\"]"},
      {"[diagnose]\nignore = [\"\"]\n", "HY604 error: plant.toml:2:11: ", "[\"SP\"]"},
      {"[diagnose]\nignore = [\"SP\", \"sp\"]\n", "HY602 error: plant.toml:2:17: sp stands in the list twice", "case"},
  };
  for (const auto& [text, beginning, mend] : cases) {
    SCOPED_TRACE(text);
    const auto said = refusal_of(text);
    EXPECT_THAT(said, StartsWith(beginning));
    EXPECT_THAT(said.substr(said.find("mend: ")), HasSubstr(mend));
  }
}

TEST(ParameterReader, AStartOfItsOwnFreesTheValue) {
  EXPECT_NO_THROW(
      (void)parse_parameter_file("plant.toml", "[parameters]\nK = 5\n[fit]\nK = {max = 1.0, start = 0.5}\n"));
}

TEST(ParameterReader, CollectsErrors) {
  const auto list = refusals_of("[parameters.INV]\nC1 = nan\nC2 = \"x\"\n[tun]\n[fit.INV.C1]\nmix = 1\n");
  std::vector<int> numbers;
  for (const auto& diagnostic : list.all()) {
    numbers.push_back(diagnostic.number);
  }
  EXPECT_THAT(numbers, ::testing::UnorderedElementsAre(error::parameter_not_finite, error::wrong_value_type,
                                                       error::unknown_key, error::unknown_key));
}

TEST(ParameterReader, NestingWithoutEndIsRefused) {
  std::string key = "a";
  for (int i = 0; i < 200000; ++i) {
    key += ".a";
  }
  EXPECT_THAT(refusal_of("[parameters]\n" + key + " = 1\n"), StartsWith("HY601 error: plant.toml:2:"));
  EXPECT_THAT(refusal_of("[" + key + "]\n"), StartsWith("HY601 error: plant.toml:1:"));
  EXPECT_THAT(refusal_of("[parameters]\nx = " + std::string(100000, '[')), StartsWith("HY601"));
  std::string inner = "1";
  const std::string dotted = "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a";
  const std::string opening = "{" + dotted + " = ";
  for (int i = 0; i < 250; ++i) {
    inner.insert(0, opening).append("}");
  }
  EXPECT_THAT(refusal_of("[parameters]\nx = " + inner), StartsWith("HY601"));
}

TEST(ParameterReader, AMissingFileIsHY100) {
  try {
    (void)read_parameter_file("/no/such/plant.toml");
    FAIL();
  } catch (const InputError& refused) {
    EXPECT_EQ(refused.diagnostics().all().front().number, error::unreadable_file);
  }
}

}  // namespace
}  // namespace hysteron::parameters
