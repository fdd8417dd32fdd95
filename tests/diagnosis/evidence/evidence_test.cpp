#include "diagnosis/evidence/evidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/evidence/laws.hpp"
#include "diagnosis/evidence/missing_space.hpp"
#include "diagnosis/evidence/open_loop.hpp"
#include "diagnosis/evidence/summed_edge.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/search/expansion.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// A mass with viscous friction, driven by a voltage; its speed is measured.
constexpr std::string_view axis = R"(FUNCTION_BLOCK AXIS  (* @ts 5ms *)
  VAR_INPUT
    U : LREAL;  (* @unit V *)
  END_VAR
  VAR_OUTPUT
    V : LREAL;  (* @unit m/s *)
  END_VAR
  VAR
    DRIVE : HY_GAIN := (K := 0.4);
    DAMP  : HY_GAIN := (K := 2.0);
    SPEED : HY_INTEGRAL_FORWARD;
  END_VAR
  DRIVE(XIN := U);
  DAMP(XIN := SPEED.XOUT);
  V := SPEED.XOUT;
  SPEED(XIN := DRIVE.XOUT - DAMP.XOUT);
END_FUNCTION_BLOCK
)";

struct Measured {
  std::vector<double> input{};
  std::vector<double> output{};
  std::string name = "v";
  double resolution = 1e-4;
};

/// The same machine with dry friction, with a bend and a wandering gain that no effect of the library is, and a sensor
/// that resolves a ten-thousandth of its stroke.
Measured messy_axis(double dry, std::uint64_t seed) {
  constexpr std::size_t samples = 3000;
  constexpr int substeps = 20;
  constexpr double step = 0.005 / substeps;
  test::Noise noise(seed);
  Measured result;
  double v = 0.0;
  double wander = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = 0.005 * static_cast<double>(k);
    const double u = 3.0 * std::sin(2.1 * t) + 1.5 * std::sin(5.3 * t + 1.0);
    result.input.push_back(u);
    result.output.push_back(std::round((v + 2e-5 * noise()) / 1e-4) * 1e-4);
    wander = 0.995 * wander + 0.003 * noise();
    for (int i = 0; i < substeps; ++i) {
      const double force = 0.4 * (1.0 + wander) * u - 2.0 * v - 0.06 * std::atan(9.0 * v * v * v);
      v += step * (force - dry * std::tanh(v / 1e-3));
    }
  }
  return result;
}

struct Asked {
  Task task{};
  Footing footing{};
  Evidence evidence{};
};

Asked asked(const Measured& measured, std::string text, double to_unit = 1.0) {
  Asked result;
  DiagnosisInput input{.program = compile_text(text, {.any_order = true}), .text = std::move(text)};
  input.file =
      parameters::parse_parameter_file("start.toml", "[fit.DRIVE]\nK = {min = 0.0}\n[fit.DAMP]\nK = {min = 0.0}\n");
  records::Record record = records::Record::even(0.0, 0.005, measured.input.size());
  record.add({.name = "u", .values = measured.input});
  std::vector<double> output = measured.output;
  for (double& value : output) {
    value *= to_unit;
  }
  record.add({.name = measured.name, .values = std::move(output)});
  input.records.push_back(std::move(record));
  result.task = task_of(input);
  result.task.scales = {measured.resolution * to_unit};
  result.footing = footing_of(result.task, {.text = input.text, .program = std::make_shared<Program>(input.program)});
  result.evidence = Weighing(result.task, "AXIS", result.footing.calibrated, {}).told();
  return result;
}

/// The level of the dry friction of the best set, the mean of both directions where they differ.
double level_of(const Evidence& evidence) {
  double sum = 0.0;
  double count = 0.0;
  for (const LawFinding& law : evidence.sets.front().laws) {
    for (const LawValue& value : law.values) {
      if (law.effect.ends_with("friction") && (value.name == "LEVEL" || value.name == "UP" || value.name == "DOWN")) {
        sum += value.value;
        count += 1.0;
      }
    }
  }
  return sum / count;
}

TEST(Evidence, DryFrictionIsSureBesideWhatNoEffectExplains) {
  const Asked found = asked(messy_axis(0.2, 1), std::string(axis));
  ASSERT_FALSE(found.evidence.families.empty());
  EXPECT_EQ(found.evidence.families.front().family, "dry_friction");
  EXPECT_GT(found.evidence.families.front().probability, 0.9);
  EXPECT_GT(found.evidence.families.front().closed, 0.5);
  EXPECT_NEAR(level_of(found.evidence), 0.2, 0.03);
  EXPECT_EQ(found.evidence.picture.over, "V");
  EXPECT_EQ(found.evidence.picture.places.size(), found.evidence.picture.missing.size());
}

/// A smoother spreads what is open near a turn over the whole record. Where all of that had counted, only rows before
/// the first turn, where it was 0 by underflow, were a test of a friction, and a record cut in mid-motion had none.
TEST(Evidence, AFrictionIsTestedWhereverTheMachineMoves) {
  const Asked found = asked(messy_axis(0.2, 1), std::string(axis));
  const Explanation& calibrated = found.footing.calibrated;
  const auto space = MissingSpace::of_bottleneck(found.task, "AXIS", calibrated, {}, 1);
  ASSERT_TRUE(space);
  const Blocks blocks(found.task, space->outputs(), 15, 4000);
  const std::vector<Law> laws = laws_of(found.task, *space, calibrated, blocks, {.effects = {"coulomb_friction"}});
  ASSERT_FALSE(laws.empty());
  for (const Law& law : laws) {
    ASSERT_GT(law.slacks.cols(), 0);
    const auto open = (law.slacks.rowwise().squaredNorm().array() > 0.0).count();
    EXPECT_GT(open, 0);
    EXPECT_LT(static_cast<double>(open), 0.3 * static_cast<double>(law.slacks.rows()));
  }
}

TEST(Evidence, WithoutFrictionNoneIsSure) {
  const Asked found = asked(messy_axis(0.0, 2), std::string(axis));
  for (const FamilyFinding& one : found.evidence.families) {
    if (one.family == "dry_friction") {
      EXPECT_LT(one.probability * one.closed, 0.35);
    }
  }
}

/// The axis with a spring, and an encoder that resolves a hundredth of its stroke or less. Dry friction of a small
/// drive holds it for most of the time; a dead zone in the drive lets it settle at zero.
constexpr std::string_view sprung_axis = R"(FUNCTION_BLOCK AXIS  (* @ts 5ms *)
  VAR_INPUT
    U : LREAL;  (* @unit V *)
  END_VAR
  VAR_OUTPUT
    X : LREAL;  (* @unit m *)
  END_VAR
  VAR
    DRIVE  : HY_GAIN := (K := 6.0);
    DAMP   : HY_GAIN := (K := 5.0);
    SPRING : HY_GAIN := (K := 60.0);
    SPEED  : HY_INTEGRAL_FORWARD;
    PLACE  : HY_INTEGRAL_FORWARD;
    FORCE  : LREAL;
  END_VAR
  DRIVE(XIN := U);
  DAMP(XIN := SPEED.XOUT);
  SPRING(XIN := PLACE.XOUT);
  X := PLACE.XOUT;
  FORCE := DRIVE.XOUT - DAMP.XOUT - SPRING.XOUT;
  PLACE(XIN := SPEED.XOUT);
  SPEED(XIN := FORCE);
END_FUNCTION_BLOCK
)";

struct Sprung {
  double friction = 0.0;
  double dead_zone = 0.0;
};
Measured resting_axis(const Sprung& sprung, std::uint64_t seed) {
  constexpr std::size_t samples = 2400;
  constexpr int substeps = 50;
  constexpr double step = 0.005 / substeps;
  test::Noise noise(seed);
  Measured result{.name = "x", .resolution = 2e-3};
  double v = 0.0;
  double x = 0.0;
  double wander = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = 0.005 * static_cast<double>(k);
    const double u = 1.5 * std::sin(1.3 * t) + 1.0 * std::sin(3.7 * t + 1.0);
    result.input.push_back(u);
    result.output.push_back(std::round(x / result.resolution) * result.resolution);
    wander = 0.99 * wander + 0.01 * noise();
    for (int i = 0; i < substeps; ++i) {
      const double command = u - std::clamp(u, -sprung.dead_zone, sprung.dead_zone);
      const double force = 10.0 * (1.0 + wander) * command - 5.0 * v - 60.0 * x;
      v += step * (force - sprung.friction * std::tanh(v / 2e-3));
      x += step * v;
    }
  }
  return result;
}

TEST(Evidence, AMachineThatRestsMostOfTheTimeIsHeldByDryFriction) {
  const Asked found = asked(resting_axis({.friction = 10.0}, 1), std::string(sprung_axis));
  ASSERT_FALSE(found.evidence.families.empty());
  EXPECT_EQ(found.evidence.families.front().family, "dry_friction");
  EXPECT_GT(found.evidence.families.front().probability, 0.7);
  // Of two frictions on two edges the slack is that of their sum: none hides behind another that takes it back.
  for (const LawFinding& law : found.evidence.sets.front().laws) {
    for (const LawValue& value : law.values) {
      if (value.name == "LEVEL" || value.name == "UP" || value.name == "DOWN") {
        EXPECT_LT(std::abs(value.value), 20.0) << law.effect << " at " << law.edge;
      }
    }
  }
}

TEST(Evidence, AMachineThatRestsForAnotherReasonIsNotHeldByDryFriction) {
  const Asked found = asked(resting_axis({.dead_zone = 1.0}, 2), std::string(sprung_axis));
  ASSERT_FALSE(found.evidence.families.empty());
  EXPECT_NE(found.evidence.families.front().family, "dry_friction");
}

/// Siblings change what is told by as much as they say, and what the record says by itself stays the same.
TEST(Evidence, SiblingsMakeTheirFamiliesMoreProbable) {
  const Asked found = asked(messy_axis(0.02, 4), std::string(axis));
  const auto probability = [](const Evidence& evidence, const std::string& family) {
    const auto one = std::ranges::find(evidence.families, family, &FamilyFinding::family);
    return one == evidence.families.end() ? std::pair(0.0, 0.0) : std::pair(one->probability, one->by_record);
  };
  const Prior prior(std::vector<Prior::Probabilities>(10, {{"dry_friction", 1.0}}));
  const Evidence with = Weighing(found.task, "AXIS", found.footing.calibrated, {.prior = prior}).told();
  const Evidence without = Weighing(found.task, "AXIS", found.footing.calibrated, {}).told();
  double sum = 0.0;
  for (const SetFinding& set : with.sets) {
    sum += set.probability;
  }
  EXPECT_NEAR(sum, 1.0, 0.02) << "sets that are not listed have little";
  for (const FamilyFinding& one : without.families) {
    EXPECT_DOUBLE_EQ(one.probability, one.by_record) << one.family;
    EXPECT_DOUBLE_EQ(probability(with, one.family).second, one.by_record) << one.family;
  }
  const auto [alone, same] = probability(without, "dry_friction");
  const auto [told, record] = probability(with, "dry_friction");
  ASSERT_GT(alone, 0.0);
  if (alone < 1.0) {
    EXPECT_GT(told, alone);
  }
}

TEST(Evidence, AnotherUnitOrAnotherSeedIsTheSameEvidence) {
  const Measured measured = messy_axis(0.2, 3);
  const Asked first = asked(measured, std::string(axis));
  std::string millimetres(axis);
  millimetres.replace(millimetres.find("@unit m/s"), 9, "@unit mm/s");
  millimetres.replace(millimetres.find("K := 0.4"), 8, "K := 400.0");
  const Asked second = asked(measured, millimetres, 1000.0);
  EXPECT_EQ(first.evidence.families.front().family, second.evidence.families.front().family);
  EXPECT_NEAR(first.evidence.families.front().closed, second.evidence.families.front().closed, 0.02);
  EXPECT_NEAR(1000.0 * level_of(first.evidence), level_of(second.evidence), 5.0);
  const Evidence other = Weighing(first.task, "AXIS", first.footing.calibrated, {.seed = 17}).told();
  EXPECT_EQ(other.families.front().family, first.evidence.families.front().family);
  EXPECT_NEAR(other.families.front().probability, first.evidence.families.front().probability, 0.05);
}

TEST(Evidence, IsBitForBitTheSameOnOneThreadAndOnThree) {
  const Asked first = asked(messy_axis(0.2, 4), std::string(axis));
  const Evidence one = Weighing(first.task, "AXIS", first.footing.calibrated, {.threads = 1}).told();
  const Evidence three = Weighing(first.task, "AXIS", first.footing.calibrated, {.threads = 3}).told();
  ASSERT_EQ(one.sets.size(), three.sets.size());
  for (std::size_t i = 0; i < one.sets.size(); ++i) {
    EXPECT_EQ(one.sets[i].probability, three.sets[i].probability);
    EXPECT_EQ(one.sets[i].closed, three.sets[i].closed);
  }
}

TEST(Bottleneck, IsWhereForcesAreSummedBeforeTheFirstIntegral) {
  const Asked found = asked(messy_axis(0.2, 5), std::string(axis));
  const auto bottleneck = bottleneck_of(found.task, "AXIS", found.footing.calibrated.variant, {"U"}, 1);
  ASSERT_TRUE(bottleneck);
  EXPECT_EQ(bottleneck->edge.edge.name, "SPEED.XIN");
}

TEST(Bottleneck, AStaticDiagramHasNone) {
  const std::string text = R"(FUNCTION_BLOCK AXIS  (* @ts 5ms *)
  VAR_INPUT U : LREAL; END_VAR
  VAR_OUTPUT V : LREAL; END_VAR
  VAR DRIVE : HY_GAIN := (K := 0.4); DAMP : HY_GAIN := (K := 2.0); END_VAR
  DRIVE(XIN := U);
  DAMP(XIN := DRIVE.XOUT);
  V := DAMP.XOUT;
END_FUNCTION_BLOCK
)";
  const Asked found = asked(messy_axis(0.2, 6), text);
  EXPECT_FALSE(bottleneck_of(found.task, "AXIS", found.footing.calibrated.variant, {"U"}, 1));
}

TEST(OpenLoop, APlantWhoseEffortWasMeasuredIsTakenOutOfItsLoop) {
  const std::string text = R"(FUNCTION_BLOCK LOOP  (* @ts 5ms *)
  VAR_INPUT REF : LREAL; END_VAR
  VAR_OUTPUT U : LREAL; V : LREAL; END_VAR
  VAR LATE : HY_DELAY; P : HY_GAIN := (K := 5.0); SPEED : HY_INTEGRAL_FORWARD; END_VAR
  P(XIN := REF - LATE.XOUT);
  U := P.XOUT;
  SPEED(XIN := U);
  V := SPEED.XOUT;
  LATE(XIN := SPEED.XOUT);
END_FUNCTION_BLOCK
)";
  DiagnosisInput input{.program = compile_text(text, {.any_order = true}), .text = text};
  records::Record record = records::Record::even(0.0, 0.005, 100);
  for (const char* name : {"ref", "u", "v"}) {
    record.add({.name = name, .values = std::vector<double>(100, 1.0)});
  }
  input.records.push_back(record);
  const Task task = task_of(input);
  const auto open = opened(task, "LOOP", {.text = text, .program = std::make_shared<Program>(input.program)});
  ASSERT_TRUE(open);
  EXPECT_EQ(open->cut, "U");
  EXPECT_EQ(open->task.outputs, std::vector<std::string>{"V"});
  // Driven by its own input, the integral of 1 is the time, whatever the reference does.
  const std::vector<Signal> outputs = simulate(*open->variant.program, open->task.records.front());
  const auto at = static_cast<std::size_t>(find_port(open->variant.program->graph.outputs, "V") -
                                           open->variant.program->graph.outputs.data());
  EXPECT_NEAR(outputs[at][99], 99 * 0.005, 1e-9);
}

}  // namespace
}  // namespace hysteron::diagnosis
