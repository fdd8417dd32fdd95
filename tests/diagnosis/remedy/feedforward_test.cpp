// The feedforward of a diagram: plant ∘ feedforward is the identity, for each effect.
#include "diagnosis/remedy/feedforward.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "codegen/trace/block_type.hpp"
#include "diagnosis/remedy/inverse.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double feedforward_sample_time = 0.001;

/// A plant from U in V to Y in um, of blocks in series.
std::string plant_of(const std::string& locals, const std::string& statements) {
  return fmt::format(
      "FUNCTION_BLOCK PLANT  (* @ts 1ms *)\n  VAR_INPUT\n    U : LREAL;  (* @unit V *)\n  END_VAR\n  VAR_OUTPUT\n"
      "    Y : LREAL;  (* @unit um *)\n  END_VAR\n  VAR\n{}  END_VAR\n{}END_FUNCTION_BLOCK\n",
      locals, statements);
}

/// A gain of 10 um/V behind one block.
std::string with_block(const std::string& block) {
  return plant_of(fmt::format("    EFFECT : {};\n    G : HY_GAIN := (K := 10.0);\n", block),
                  "  EFFECT(XIN := U);\n  G(XIN := EFFECT.XOUT);\n  Y := G.XOUT;\n");
}

/// Begins at rest at 0; loops of two sizes, none of whose samples lies on a reversal.
std::vector<double> smooth_reference(double size, double start = 0.0, std::size_t steps = 6000) {
  std::vector<double> reference(steps);
  for (std::size_t k = 0; k < steps; ++k) {
    const double t = static_cast<double>(k) * feedforward_sample_time;
    const double fade = std::min(1.0, t);
    const double in = fade * fade * fade * (10.0 + fade * (-15.0 + 6.0 * fade));
    reference[k] = start + size * in *
                               (0.6 * std::sin(2.0 * std::numbers::pi * 1.003 * t) +
                                0.4 * std::sin(2.0 * std::numbers::pi * 0.371 * t));
  }
  return reference;
}

struct Outcome {
  double worst = 0.0;  ///< |Y − REF| over the size of REF, from the second tenth on
  double rms = 0.0;
  Feedforward feedforward{};
};

Outcome outcome_of(const std::string& text, double size, std::size_t shift = 0, double start = 0.0) {
  const Program plant = compile_text(text);
  Outcome outcome{.feedforward = feedforward_of(plant, "U", "Y", feedforward_sample_time)};
  EXPECT_NE(outcome.feedforward.text, "") << outcome.feedforward.reason;
  if (outcome.feedforward.text.empty()) {
    return outcome;
  }
  const std::vector<double> reference = smooth_reference(size, start);
  records::Record given = records::Record::even(0.0, feedforward_sample_time, reference.size());
  given.add({.name = "REF", .unit = {}, .values = reference});
  records::Record driven = records::Record::even(0.0, feedforward_sample_time, reference.size());
  driven.add({.name = "U", .unit = {}, .values = simulate(compile_text(outcome.feedforward.text), given).front()});
  const std::vector<double> y = simulate(plant, driven).front();
  double sum = 0.0;
  for (std::size_t k = reference.size() / 10; k < reference.size(); ++k) {
    const double error = std::abs(y[k] - reference[k - shift]) / size;
    outcome.worst = std::max(outcome.worst, error);
    sum += error * error;
  }
  outcome.rms = std::sqrt(sum / (0.9 * static_cast<double>(reference.size())));
  return outcome;
}

struct Case {
  const char* name;
  std::string block;
  double worst;  ///< bound of the error, over the size of the reference
};

void PrintTo(const Case& one, std::ostream* out) {
  *out << one.name;
}

class Effect : public testing::TestWithParam<Case> {};

TEST_P(Effect, PlantBehindFeedforwardIsTheIdentity) {
  const Outcome outcome = outcome_of(with_block(GetParam().block), 20.0);
  RecordProperty("worst", fmt::format("{:.3g}", outcome.worst));
  EXPECT_LE(outcome.worst, GetParam().worst) << outcome.feedforward.text;
}

/// Without the effect's inverse, the error is that of the effect, far above the bound.
TEST_P(Effect, IsNotTheIdentityWithoutItsInverse) {
  const Program plant = compile_text(with_block(GetParam().block));
  records::Record driven = records::Record::even(0.0, feedforward_sample_time, 6000);
  std::vector<double> u = smooth_reference(2.0);
  driven.add({.name = "U", .unit = {}, .values = u});
  const std::vector<double> y = simulate(plant, driven).front();
  double worst = 0.0;
  for (std::size_t k = 600; k < u.size(); ++k) {
    worst = std::max(worst, std::abs(y[k] - 10.0 * u[k]) / 20.0);
  }
  EXPECT_GT(worst, 20.0 * GetParam().worst);
}

const std::string loop = "C1 := 1.0, C2 := 0.2, C3 := 0.8";

INSTANTIATE_TEST_SUITE_P(
    Blocks, Effect,
    testing::Values(
        Case{"offset", "HY_OFFSET := (BIAS := -0.3)", 1e-14}, Case{"drift", "HY_DRIFT := (RATE := 0.1)", 1e-14},
        Case{"thermal_drift", "HY_THERMAL_DRIFT := (SIZE := 0.4, T1 := 2.0)", 1e-14},
        Case{"gain_drift", "HY_GAIN_DRIFT := (RATE := 0.05)", 1e-14},
        Case{"periodic", "HY_PERIODIC_DISTURBANCE := (SINE := 0.1, COSINE := 0.2, FREQUENCY := 7.0)", 1e-14},
        Case{"load", "HY_LOAD := (SIZE := 0.5, T_ON := 2.0, T_OFF := 4.0)", 1e-14},
        Case{"gain", "HY_GAIN := (K := 1.3)", 1e-14},
        Case{"even", "HY_EVEN_NONLINEARITY := (SIZE := 0.3, CENTRE := 0.4, REFERENCE := 2.0)", 1e-13},
        Case{"odd", "HY_ODD_NONLINEARITY := (SIZE := 0.5, CENTRE := -0.2, REFERENCE := 2.0)", 1e-13},
        Case{"odd_falling", "HY_ODD_NONLINEARITY := (SIZE := -0.2, REFERENCE := 2.0)", 1e-13},
        Case{"ripple", "HY_PERIODIC_ERROR := (SINE := 0.02, COSINE := 0.03, PITCH := 0.5)", 1e-13},
        Case{"backlash", "HY_BACKLASH := (WIDTH := 0.3)", 1e-14},
        Case{"backlash_from_its_edge", "HY_BACKLASH := (WIDTH := 0.3, START := 1.0)", 1e-14},
        Case{"dead_zone", "HY_DEAD_BAND := (WIDTH := 0.3)", 1e-14},
        Case{"soft_dead_zone", "HY_DEAD_BAND := (WIDTH := 0.3, SPREAD := 0.6)", 1e-13},
        Case{"loop", "HY_HYSTERESIS_RO := (" + loop + ")", 1e-13}, Case{"lag", "HY_LAG := (T1 := 0.02)", 5e-6},
        Case{"lead_lag", "HY_LEAD_LAG := (T1 := 0.02, T2 := 0.05)", 5e-6},
        Case{"resonance", "HY_SECOND_ORDER := (T := 0.02, ZETA := 0.2)", 5e-6},
        Case{"relaxation", "HY_RELAXATION := (GAIN := 0.3, T1 := 0.5)", 1e-7},
        Case{"creep", "HY_CREEP := (GAIN := 0.08, T_ONSET := 0.01)", 5e-6},
        Case{"asymmetry", "HY_HYSTERESIS_GENERAL := (" + loop + ", ASYMMETRY := 0.3)", 1e-5},
        Case{"asymmetry_of_exponent", "HY_HYSTERESIS_GENERAL := (" + loop + ", ASYMMETRY_EXPONENT := 0.2)", 1e-5},
        Case{"rate_dependence", "HY_HYSTERESIS_GENERAL := (" + loop + ", RATE := 0.3, RATE_REFERENCE := 0.1)", 1e-5},
        Case{"bias_dependence", "HY_HYSTERESIS_GENERAL := (" + loop + ", BIAS := 0.1, BIAS_REFERENCE := 2.0)", 1e-5},
        Case{"bias_of_duhem", "HY_HYSTERESIS_GENERAL := (" + loop + ", DUHEM := 0.1, DUHEM_REFERENCE := 2.0)", 1e-5},
        Case{"bias_of_growth", "HY_HYSTERESIS_GENERAL := (" + loop + ", HARDENING := 0.1, HARDENING_REFERENCE := 2.0)",
             1e-5},
        Case{"curve_shape", "HY_HYSTERESIS_GENERAL := (" + loop + ", SHAPE := 0.2, SHAPE_DEPTH := 1.0)", 1e-5},
        Case{"bouc_wen", "HY_HYSTERESIS_GENERAL := (" + loop + ", BOUC_WEN := 0.3, BOUC_WEN_TRAVEL := 0.5)", 1e-4},
        Case{"return_point", "HY_HYSTERESIS_GENERAL := (" + loop + ", RETURN_POINT := 1.0)", 5e-4}),
    [](const testing::TestParamInfo<Case>& one) { return std::string(one.param.name); });

TEST(Feedforward, ChainsOfBlocksAndExpressions) {
  const std::string text = plant_of(
      "    HYST : HY_HYSTERESIS_RO := (C1 := 8.0, C2 := 1.0, C3 := 0.8, START := 1, U0 := -4.0, Y0 := -60.0);\n"
      "    CREEP : HY_CREEP := (GAIN := 0.05, T_ONSET := 0.05);\n    SLOW : HY_LAG := (T1 := 0.005);\n"
      "    PLAY : HY_BACKLASH := (WIDTH := 0.1);\n",
      "  PLAY(XIN := (U - 0.5) / 1.25);\n  HYST(XIN := PLAY.XOUT);\n  SLOW(XIN := -(2.0 - HYST.XOUT));\n"
      "  CREEP(XIN := SLOW.XOUT);\n  Y := 3.0 + CREEP.XOUT * 0.5;\n");
  const Outcome outcome = outcome_of(text, 10.0);
  EXPECT_LE(outcome.rms, 1e-3) << outcome.feedforward.text;
}

/// A machine that has stood at 10 before: what has crept or followed by then is in its output, or is not.
TEST(Feedforward, CreepAndRelaxationSinceTheStart) {
  for (const std::string since : {"FALSE", "TRUE"}) {
    EXPECT_LE(
        outcome_of(with_block("HY_RELAXATION := (GAIN := 0.3, T1 := 0.5, SINCE_START := " + since + ")"), 20.0, 0, 10.0)
            .worst,
        1e-7);
    EXPECT_LE(outcome_of(with_block("HY_CREEP := (GAIN := 0.08, T_ONSET := 0.01, SINCE_START := " + since + ")"), 20.0,
                         0, 10.0)
                  .worst,
              5e-6);
  }
}

/// The servo's force follows from the acceleration, its friction from the velocity that the reference has.
TEST(Feedforward, FrictionInTheLoopOfASeriesChain) {
  const std::string text = plant_of(
      "    DRY : HY_COULOMB_FRICTION := (LEVEL := 0.5, PRESLIDE := 0.05);\n    WET : HY_VISCOUS_FRICTION := "
      "(COEFFICIENT := 0.02);\n"
      "    VEL : HY_INTEGRAL_FORWARD;\n    POS : HY_INTEGRAL;\n    MASS : HY_GAIN := (K := 50.0);\n",
      "  DRY(XIN := U, V := VEL.XOUT);\n  WET(XIN := DRY.XOUT, V := VEL.XOUT);\n  MASS(XIN := WET.XOUT);\n"
      "  VEL(XIN := MASS.XOUT);\n  POS(XIN := VEL.XOUT);\n  Y := POS.XOUT;\n");
  EXPECT_LE(outcome_of(text, 5.0).worst, 1e-3);
}

TEST(Feedforward, ParametersKeepTheirUnits) {
  const std::string text =
      "FUNCTION_BLOCK PLANT  (* @ts 1ms *)\n  VAR_INPUT\n    U : LREAL;  (* @unit V *)\n"
      "    SLOPE : LREAL := 4.0;  (* @param @unit um/V *)\n    ZERO : LREAL := -1.0;  (* @param @unit um *)\n  "
      "END_VAR\n"
      "  VAR_OUTPUT\n    Y : LREAL;  (* @unit um *)\n  END_VAR\n  Y := ZERO + SLOPE * U;\nEND_FUNCTION_BLOCK\n";
  const Outcome outcome = outcome_of(text, 5.0);
  EXPECT_LE(outcome.worst, 1e-14);
  EXPECT_NE(outcome.feedforward.text.find("@unit um/V"), std::string::npos) << outcome.feedforward.text;
}

TEST(Feedforward, AnInputMayBeCalledAsTheReferenceIs) {
  const Program plant = compile_text(
      "FUNCTION_BLOCK PLANT  (* @ts 1ms *)\n  VAR_INPUT\n    REF : LREAL;  (* @unit V *)\n  END_VAR\n  VAR_OUTPUT\n"
      "    Y : LREAL;  (* @unit V *)\n  END_VAR\n  VAR\n    L : HY_LAG := (T1 := 0.01);\n  END_VAR\n"
      "  L(XIN := REF);\n  Y := L.XOUT;\nEND_FUNCTION_BLOCK\n");
  const Feedforward found = feedforward_of(plant, "REF", "Y", feedforward_sample_time);
  ASSERT_NE(found.text, "") << found.reason;
  EXPECT_EQ(found.reference, "REF_2");
  const Program inverse = compile_text(found.text);
  ASSERT_EQ(inverse.graph.inputs.size(), 1U);
  EXPECT_EQ(inverse.graph.inputs[0].name, "REF_2");
  EXPECT_EQ(inverse.graph.outputs[0].name, "REF");
  records::Record record = records::Record::even(0.0, feedforward_sample_time, 6000);
  record.add({.name = "REF", .values = smooth_reference(5.0)});
  record.add({.name = "Y", .values = smooth_reference(5.0)});
  const auto tracking = predicted_tracking(plant, plant, "REF", "Y", record);
  ASSERT_TRUE(tracking);
  EXPECT_LT(tracking->improved, 1e-3);
}

TEST(Feedforward, DeadTimeIsAskedForAsAPreview) {
  const Outcome outcome = outcome_of(with_block("HY_DEAD_TIME := (DEAD_TIME := 0.004)"), 20.0, 4);
  EXPECT_NEAR(outcome.feedforward.preview, 0.004, 1e-15);
  EXPECT_LE(outcome.worst, 1e-13);
}

TEST(Feedforward, SaysWhyThereIsNone) {
  const auto reason = [](const std::string& text) {
    const Feedforward found = feedforward_of(compile_text(text), "U", "Y", feedforward_sample_time);
    EXPECT_EQ(found.text, "");
    return found.reason;
  };
  EXPECT_EQ(reason("FUNCTION_BLOCK PLANT (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
                   "VAR D : LREAL; END_VAR D := U - 1.0; Y := D + D * D; END_FUNCTION_BLOCK"),
            "Y takes 2 signals that depend on U: no series chain");
  EXPECT_EQ(reason(with_block("HY_ABS")), "EFFECT is a HY_ABS, which has no inverse here");
  EXPECT_EQ(reason(with_block("HY_GAIN := (K := 0.0)")), "EFFECT has the gain 0");
}

TEST(Feedforward, PredictedTrackingFallsWithTheEffectInIt) {
  const std::string line = plant_of("    G : HY_GAIN := (K := 10.0);\n", "  G(XIN := U);\n  Y := G.XOUT;\n");
  const std::string play = with_block("HY_BACKLASH := (WIDTH := 0.3)");
  records::Record record = records::Record::even(0.0, feedforward_sample_time, 6000);
  record.add({.name = "U", .unit = {}, .values = smooth_reference(2.0)});
  record.add({.name = "Y", .unit = {}, .values = simulate(compile_text(play), record).front()});
  const auto tracking = predicted_tracking(compile_text(line), compile_text(play), "U", "Y", record);
  ASSERT_TRUE(tracking.has_value());
  EXPECT_NEAR(tracking->nominal, 1.5, 0.1);  // half the gap, 0.15 V, at 10 um/V
  EXPECT_LT(tracking->improved, 1e-6);
}

TEST(InverseOfEffects, HasEveryEffectOfTheCatalogue) {
  std::set<std::string_view> effects;
  for (const BlockType& block : block_types()) {
    effects.insert(block.about.effect);
    for (const Field& field : block.params) {
      effects.insert(field.effect);
    }
  }
  effects.erase("");
  for (const std::string_view effect : effects) {
    EXPECT_TRUE(std::ranges::any_of(inverses(), [&](const InverseOfEffect& one) { return one.effect == effect; }))
        << effect;
  }
  EXPECT_EQ(inverse_of("delay").inverse, Inverse::Avoidable);
  EXPECT_EQ(inverse_of("quantization").inverse, Inverse::None);
  EXPECT_EQ(inverse_of("of_my_own").inverse, Inverse::None);
}

}  // namespace
}  // namespace hysteron::diagnosis
