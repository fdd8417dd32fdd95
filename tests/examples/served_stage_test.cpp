// Example 8 as a user runs it: two processes over Modbus, the record of the run, and what it says of the stage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "examples/08_served_stage/stage.hpp"
#include "examples/example.hpp"
#include "records/read.hpp"
#include "tests/examples/printed.hpp"
#include "tests/examples/programs.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::examples {
namespace {

using test::contents_of;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ServedStage, IsDrivenReplayedAndDiagnosed) {
  const test::ScratchFolder folder;
  const std::string printed = folder / "printed";
  ASSERT_EQ(run(programs + "/example_08_served_stage " + folder / "out" + " > " + printed + " 2>&1"), 0)
      << contents_of(printed);
  const std::string text = contents_of(printed);
  EXPECT_THAT(text, HasSubstr("1000 steps replayed, 0 with other bits; 0 dropped while recording\n"));
  EXPECT_THAT(text, HasSubstr("20000 steps replayed, 0 with other bits; 0 dropped while recording\n"));
  // What the feedforward does not know of the stage: the relays make no symmetric loop, and the stage creeps.
  EXPECT_THAT(text, HasSubstr(" names even_nonlinearity, creep:\n"));
  expect_readme_shows("08_served_stage", text.substr(0, std::min(text.find("No picture"), text.find("Records and"))));
  const records::Record record = records::read_record((folder / "out/record.csv"));
  ASSERT_EQ(record.size(), 20'000U);
  const auto y = column(record, "Y");
  const auto ref = column(record, "REF");
  EXPECT_LT(rms(column(record, "ERR")), 0.02 * range(ref));
  // In every cycle the sensor is read, then the voltage of the cycle before is written: the model alone gives the same
  // bits, two cycles behind the voltage.
  simulated::Stage stage;
  const auto u = column(record, "U");
  EXPECT_EQ(y[0], stage.reading());
  for (std::size_t k = 1; k < u.size(); ++k) {
    ASSERT_EQ(y[k], stage.reading()) << k;
    stage.advance(u[k - 1]);
  }
  if (run("command -v gnuplot > " + folder / "where") == 0) {
    EXPECT_THAT(contents_of(folder / "out/08_served_stage.png"), StartsWith("\x89PNG"));
  } else {
    EXPECT_THAT(text, HasSubstr("No picture: gnuplot is not installed"));
  }
}

TEST(ServedStage, HasALoopThatCreepsUnderASensorWithNoise) {
  simulated::Stage stage;
  EXPECT_NEAR(stage.reading(), 0.0, 0.2);
  const auto settle = [&](double u, int periods) {
    double sum = 0.0;
    for (int k = 0; k < periods; ++k) {
      stage.advance(u);
      sum += stage.reading();
    }
    return sum / periods;
  };
  (void)settle(0.9, 100);
  const double rising = settle(0.9, 100);
  (void)settle(1.8, 100);
  (void)settle(0.9, 100);
  EXPECT_GT(settle(0.9, 100) - rising, 1.0) << "the falling branch lies above the rising one";
  const double early = settle(3.0, 500);
  (void)settle(3.0, 4000);
  EXPECT_GT(settle(3.0, 500) - early, 0.1) << "it creeps on under the same voltage";
  EXPECT_EQ(std::remainder(stage.reading(), 100.0 / 65536.0), 0.0) << "in steps of the converter";
}

}  // namespace
}  // namespace hysteron::examples
