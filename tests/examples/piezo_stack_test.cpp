// Example 4 on the real records: the published figures, and ours. Where there is a folder of measured data, records
// that are missing are a failure, not a skip.
#include "examples/04_piezo_stack/piezo_stack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "examples/example.hpp"
#include "tests/support/measured_records.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::examples {
namespace {

class PiezoStack : public test::OnMeasuredRecords<> {
 protected:
  void SetUp() override {
    OnMeasuredRecords::SetUp();
    if (IsSkipped()) {
      return;
    }
    identification = stack_record("identify_1hz.csv");
    test = stack_record("feedforward_test.csv");
    ASSERT_TRUE(identification && test) << "the data folder lacks piezo-picma-dbo";
  }
  std::optional<records::Record> identification{};
  std::optional<records::Record> test{};
};

TEST_F(PiezoStack, PublishedFiguresAreReproduced) {
  const auto& ref = test->column("ref").values;
  const auto& y = test->column("y").values;
  EXPECT_NEAR(tracking_error(ref, y, row_without_inverse), 1.68, 0.005);
  EXPECT_NEAR(tracking_error(ref, y, row_with_inverse), 0.58, 0.005);
}

TEST_F(PiezoStack, ModelsOnHeldOutCycles) {
  EXPECT_NEAR(tune("line", "line", *identification).test_share(), 0.074, 0.0005);
  const TunedDiagram plant = tune("plant", "plant", *identification);
  EXPECT_TRUE(plant.fit.solution.converged()) << plant.fit.solution.message;
  EXPECT_LT(plant.test_share(), 0.0116);
  EXPECT_LT(tune("plant", "late_plant", *identification).test_share(), 0.009);
  EXPECT_LT(tune("bent_plant", "bent_plant", *identification).test_share(), 0.0061);
}

TEST_F(PiezoStack, GeneratedFeedforwardInvertsThePlantItWasTunedOn) {
  const TunedDiagram plant = tune("plant", "one_sample", *identification);
  const Program feedforward = feedforward_of("feedforward", plant);
  const test::ScratchFolder scratch;
  const auto u = run_generated(feedforward, *test, scratch.path() / "generated");
  EXPECT_EQ(u, simulate(feedforward, *test).front());  // the same bits
  // The plant itself, driven by that voltage, gives the reference and its bias one sample later.
  records::Record driven = records::Record::even(0.0, test->sample_time(), test->size());
  driven.add({.name = "U", .unit = "V", .values = u});
  const auto y = simulate(plant.program, driven).front();
  const auto& ref = test->column("ref").values;
  const std::int64_t bias = find_parameter(feedforward.graph, "BIAS");
  double worst = 0.0;
  for (std::size_t k = 0; k + 1 < ref.size(); ++k) {
    const double wanted = ref[k] + feedforward.graph.parameters[static_cast<std::size_t>(bias)].value.front();
    worst = std::max(worst, std::fabs(y[k + 1] - wanted));
  }
  EXPECT_LT(worst, 1e-9);  // um
}

TEST_F(PiezoStack, PredictionIsCalibratedOnThePublishedVoltage) {
  const TunedDiagram judge = tune("judge", "judge", *test);
  EXPECT_LT(judge.fit.scores.front().train, 0.2);  // um, of a range of 40 um
  const Prediction theirs = predict(judge.program, test->column("u").values, *test);
  EXPECT_NEAR(theirs.without_inverse, 1.68, 0.06);
  EXPECT_NEAR(theirs.with_inverse, 0.58, 0.06);
  const TunedDiagram plant = tune("plant", "one_sample", *identification);
  const auto u = simulate(feedforward_of("feedforward", plant), *test).front();
  EXPECT_LT(difference(u, test->column("u").values, first_row_of_inverse), 0.1);  // V
  EXPECT_LT(predict(judge.program, u, *test).with_inverse, 0.5 * 1.68);
}

}  // namespace
}  // namespace hysteron::examples
