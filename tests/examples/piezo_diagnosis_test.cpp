// Example 6 on the real record: the effects of one round take the held-out cycles below what 12 play operators and a
// cubic leave. Where there is a folder of measured data, a missing record is a failure, not a skip.
#include "examples/06_piezo_diagnosis/piezo_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "examples/04_piezo_stack/piezo_stack.hpp"
#include "tests/support/measured_records.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::examples {
namespace {

using testing::AnyOf;
using testing::Eq;

class PiezoDiagnosis : public test::OnMeasuredRecords<> {};

TEST_F(PiezoDiagnosis, NamedEffectsBeatPlayOperators) {
  const auto identification = stack_record("identify_1hz.csv");
  ASSERT_TRUE(identification) << "the data folder lacks piezo-picma-dbo";
  const StackCycles cycles = cycles_of(*identification);
  const test::ScratchFolder scratch;
  const Round paper = tuned_model("04_piezo_stack/plant.st", "04_piezo_stack/plant.toml", *identification);
  EXPECT_NEAR(gap_of(paper, cycles).held_out, 0.0113, 0.0005);

  const Round first = next_round(paper, cycles.fitted, effects_of_a_stack(), scratch.path() / "first");
  ASSERT_TRUE(first.named()) << first.found.summary;
  EXPECT_THAT(first.found.effects.front().id, AnyOf(Eq("even_nonlinearity"), Eq("asymmetry")));
  EXPECT_LT(gap_of(first, cycles).held_out, 0.0040) << "12 play operators and a cubic leave 0.0076";
}

}  // namespace
}  // namespace hysteron::examples
