// Example 7 on the real record: wide loops by lags alone, so that no round may name a hysteresis.
#include "examples/07_heater_diagnosis/heater_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/measured_records.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::examples {
namespace {

class HeaterDiagnosis : public test::OnMeasuredRecords<> {};

TEST_F(HeaterDiagnosis, WideLoopsAreNoHysteresis) {
  const auto record = heater_record();
  ASSERT_TRUE(record) << "the data folder lacks tclab-thermal";
  EXPECT_GT(left_by_a_line(*record, "u1", "y1"), 0.1);
  const test::ScratchFolder scratch;
  for (const std::string name : {"heater1", "heater2"}) {
    const Round tuned = tuned_model("07_heater_diagnosis/" + name + ".st", "07_heater_diagnosis/heater.toml", *record);
    const Round first = next_round(tuned, *record, effects_of_heaters(), scratch.path() / name);
    ASSERT_TRUE(first.named()) << first.found.summary;
    EXPECT_EQ(first.found.effects.front().id, "cross_coupling") << first.found.summary;
    EXPECT_LT(first.found.gap.improved, 0.7 * first.found.gap.calibrated);
    constexpr double likely = 0.1;  // slow lags have a twin in a creep
    for (const diagnosis::Rival& rival : first.found.rivals) {
      if (rival.probability < likely) {
        continue;
      }
      for (const std::string& effect : rival.effects) {
        EXPECT_THAT(hysteretic_effects(), testing::Not(testing::Contains(effect))) << first.found.summary;
      }
    }
  }
}

}  // namespace
}  // namespace hysteron::examples
