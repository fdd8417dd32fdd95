#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "codegen/parameters/parameter_file.hpp"
#include "support/names.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::parameters {
namespace {

ParameterValue value(const std::string& path, Value held) {
  return {.path = path, .value = std::move(held)};
}
PlacedNumber number(double held) {
  return {.value = held};
}

TEST(ParameterWriter, WritesAFileThatAPersonCanRead) {
  ParameterFile file;
  file.values = {value("INV.C1", 0.05),          value("INV.C2", 1.25e-11),
                 value("GAIN", std::int64_t{2}), value("LOOP.LIM.ON", true),
                 value("inv.C3", 1.0),           value("TAB.X", std::vector<double>{0.0, 0.5, 1e6})};
  file.fits = {{.path = "INV.C1",
                .minimum = number(0.0),
                .maximum = number(std::numeric_limits<double>::infinity()),
                .start = number(0.1),
                .scale = number(1e-3)},
               {.path = "INV.C2"}};
  file.tune.outputs = {{.text = "Y"}};
  file.tune.loss = Loss::Huber;
  file.tune.train = {{.begin = 1.0, .end = 21.0}};
  file.tune.test = {{.begin = 21.0, .end = 30.0}, {.begin = 31.0, .end = 40.5}};
  file.tune.initial_states = {{.text = "HYST.P"}, {.text = "LAG.XOUT"}};
  const Remarks remarks{
      {"PARAMETERS.INV.C1", {.unit = "um/V", .meaning = "slope at a branching point", .standard_error = 0.000123}},
      {"PARAMETERS.INV.C2", {.unit = "um/V^2.7", .meaning = "", .standard_error = {}}},
      {"PARAMETERS.INV.C3", {.unit = "", .meaning = "exponent\n[evil]", .standard_error = {}}}};
  EXPECT_EQ(parameter_text(file, remarks, "Tuned by hysteron\n\nfrom log.csv"),
            R"(# Tuned by hysteron
#
# from log.csv

[parameters]
GAIN = 2

[parameters.INV]
C1 = 0.05      # um/V, slope at a branching point, standard error 0.00012
C2 = 1.25e-11  # um/V^2.7
C3 = 1.0       # exponent [evil]

[parameters.LOOP.LIM]
ON = true

[parameters.TAB]
X = [0.0, 0.5, 1000000.0]

[fit.INV]
C1 = {min = 0.0, max = inf, start = 0.1, scale = 0.001}
C2 = {}

[tune]
outputs = ["Y"]
loss = "huber"
train = [1.0, 21.0]
test = [[21.0, 30.0], [31.0, 40.5]]
initial_states = ["HYST.P", "LAG.XOUT"]
)");
}

TEST(ParameterWriter, KeepsTheCommentsOfTheUser) {
  ParameterFile file = parse_parameter_file("p.toml", R"(# Stage 7, axis X
# serial number 4711

# from the data sheet
[parameters] # of the machine
GAIN = 2 # do not touch

[parameters.INV]  # the inverse
# measured on Monday
# at 20 degC
C1 = 0.05   # um/V, slope, standard error 0.5
C2 = 1.25 # "growth" # twice
TAB = [0.0,   # first
       1.0]
LIST = [  # by the foot
  # cold
  1.0, 2.0,   # both
  3.0  # warm
  # no more
]  # done

# bounds
[fit.INV.C1]
min = 0.0  # by physics
[tune]
# the ramp is left out
train = [1.0, 21.0]
loss = "squares"  # no outliers
# the end
)");
  file.values[1].value = 0.0625;
  const Remarks remarks{{"PARAMETERS.INV.C1", {.unit = "um/V", .meaning = "slope", .standard_error = 0.25}},
                        {"PARAMETERS.INV.C2", {.unit = "um", .meaning = "growth", .standard_error = 1.0}}};
  constexpr std::string_view expected = R"(# Tuned

# Stage 7, axis X
# serial number 4711

# from the data sheet
[parameters]  # of the machine
GAIN = 2  # do not touch

[parameters.INV]  # the inverse
# measured on Monday
# at 20 degC
C1 = 0.0625  # um/V, slope, standard error 0.25
# "growth" # twice
C2 = 1.25    # um, growth, standard error 1
TAB = [
  0.0,  # first
  1.0,
]
LIST = [  # by the foot
  # cold
  1.0,
  2.0,  # both
  3.0,  # warm
  # no more
]  # done

[fit.INV]
# bounds
# by physics
C1 = {min = 0.0}

# no outliers
[tune]
# the ramp is left out
train = [1.0, 21.0]

# the end
)";
  const std::string text = parameter_text(file, remarks, "Tuned");
  EXPECT_EQ(text, expected);
  EXPECT_EQ(parameter_text(parse_parameter_file("again.toml", text), remarks), text) << "and once more";
}

TEST(ParameterWriter, WritesWhereStatesBegin) {
  const std::string text = "[parameters.LAG]\nT1 = 0.5\n\n[initial.LAG]\nXOUT = 0.25  # begin, standard error 0.1\n";
  const Remarks remarks{{"INITIAL.LAG.XOUT", {.unit = "", .meaning = "begin", .standard_error = 0.1}}};
  EXPECT_EQ(parameter_text(parse_parameter_file("p.toml", text), remarks), text);
}

TEST(ParameterWriter, WritesWhatEachRecordHasAndWhatIsIgnored) {
  const std::string_view text =
      "[fit.INV]\nC1 = {min = 0.0}\n\n[fit.record]\nZERO = {}  # of the day\n\n[fit.record.SENSOR]\n"
      "OFFSET = {max = 1.0}\n\n[diagnose]\nignore = [\"SP\", \"Tank level\"]\n";
  EXPECT_EQ(parameter_text(parse_parameter_file("plant.toml", text)), text);
}

TEST(ParameterWriter, AnEmptyFileIsEmpty) {
  EXPECT_EQ(parameter_text({}), "");
}

TEST(ParameterWriter, ReadsBackToTheSameBits) {
  std::mt19937_64 random(7);
  ParameterFile file;
  for (int i = 0; i < 2000; ++i) {
    const auto real = std::bit_cast<double>(random());
    if (std::isfinite(real)) {
      file.values.push_back(value("A" + std::to_string(i % 17) + ".C" + std::to_string(i), real));
    }
  }
  file.values.push_back(value("Z.MIN", std::int64_t{std::numeric_limits<std::int64_t>::min()}));
  file.values.push_back(value("Z.MINUS", -0.0));
  const test::ScratchFolder folder;
  const auto read = read_parameter_file(folder.write("out.toml", parameter_text(file)));
  ASSERT_EQ(read.values.size(), file.values.size());
  for (const auto& written : file.values) {
    const auto* const found = read.find(written.path);
    ASSERT_NE(found, nullptr) << written.path;
    ASSERT_EQ(found->value.index(), written.value.index()) << written.path;
    if (const auto* const real = std::get_if<double>(&written.value)) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(std::get<double>(found->value)), std::bit_cast<std::uint64_t>(*real));
    } else {
      ASSERT_EQ(found->value, written.value);
    }
  }
  EXPECT_EQ(parameter_text(read), parameter_text(file)) << "the same contents give the same bytes";
}

TEST(ParameterWriter, RefusesWhatNoFileSays) {
  ParameterFile file;
  file.values = {value("A.B", 1.0), value("a.b", 2.0)};
  EXPECT_THROW((void)parameter_text(file), std::invalid_argument);
  file.values = {value("A", 1.0), value("A.B", 2.0)};
  EXPECT_THROW((void)parameter_text(file), std::invalid_argument);
  file.values = {value("A", 1.0), value("A.B.C", 2.0)};
  EXPECT_THROW((void)parameter_text(file), std::invalid_argument);
  file.values = {value("A", std::nan(""))};
  EXPECT_THROW((void)parameter_text(file), std::invalid_argument);
}

TEST(ParameterWriter, HowRecordsAreReadStaysInTheFile) {
  const std::string text =
      "[parameters]\nK = 1.0\n\n[record]\nrate = \"1 kHz\"\nskip = 3\ntime = \"a \\\"b\\\\c[ms]\"\n\n[record.columns]\n"
      "U = \"MAIN.u\"\nY = 2\n";
  const ParameterFile file = parse_parameter_file("p.toml", text);
  const std::string written = parameter_text(file);
  const ParameterFile again = parse_parameter_file("p.toml", written);
  ASSERT_EQ(again.record.settings.size(), 3U);
  EXPECT_EQ(again.record.settings[0].key, "rate");
  EXPECT_EQ(again.record.settings[1].value.text, "3");
  EXPECT_EQ(again.record.settings[2].value.text, "a \"b\\c[ms]");
  ASSERT_EQ(again.record.columns.size(), 2U);
  EXPECT_EQ(again.record.columns[1].value.text, "2");
  EXPECT_EQ(parameter_text(again), written);
}

TEST(ParameterWriter, WaysOfResamplingStayInTheFile) {
  const auto again = [](const std::string& text) { return parameter_text(parse_parameter_file("p.toml", text)); };
  const std::string of_all = "[record]\nrate = \"1 kHz\"\nresample = \"hold\"\n";
  EXPECT_EQ(again(of_all), of_all);
  const std::string table = "[record.resample]\nQ = \"hold\"\n\"MAIN.u\" = \"linear\"\n\"*\" = \"average\"\n";
  EXPECT_EQ(again(table), table);
  EXPECT_EQ(again("[record]\nresample = {Q = \"hold\", \"MAIN.u\" = \"linear\", \"*\" = \"average\"}\n"), table);
  const ParameterFile file = parse_parameter_file("p.toml", table);
  ASSERT_EQ(file.record.settings.size(), 3U);
  EXPECT_EQ(file.record.settings[0].value.text, "Q=hold");
  EXPECT_EQ(file.record.settings[2].value.text, "average");
}

}  // namespace
}  // namespace hysteron::parameters
