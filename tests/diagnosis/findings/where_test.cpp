// Where the gap lies: the edge of what is missing has the largest share, whatever kind of signal is missing there.
#include "diagnosis/findings/where.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

double share_of(const Diagnosis& found, std::string_view edge) {
  for (const EdgeFinding& one : found.edges) {
    if (one.edge == edge) {
      return one.share;
    }
  }
  return 0.0;
}

Diagnosis of_warm_sensor(std::vector<std::string> effects) {
  return diagnose(test::input_of(test::axis(), test::axis_parameters, {test::warm_sensor()}),
                  {.effects = std::move(effects)});
}

TEST(Where, AColumnThatCouplesIsAmongTheTestSignals) {
  EXPECT_GT(share_of(of_warm_sensor({"drift"}), "SPEED.XOUT"), 0.9);
}

TEST(Where, AnEdgeHasAtLeastTheShareThatAnEffectClosesThere) {
  // A single jump of the output is none of the test signals.
  const records::Record record =
      test::measured(test::program_of(test::stack({"HY_QUANTIZER := (QUANTUM := 1.5)", "HYST.XOUT"})),
                     test::record_of("U", test::rich_voltage()), 0.02);
  const Diagnosis found =
      diagnose(test::input_of(test::stack(), test::stack_parameters, {record}), {.effects = {"quantization", "drift"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "quantization");
  EXPECT_GE(share_of(found, found.effects[0].edge), found.effects[0].share);
  EXPECT_GT(found.effects[0].share, 0.9);
}

}  // namespace
}  // namespace hysteron::diagnosis
