// Units: what is one, how they convert, and what the wires say of parameters.
#include "codegen/graph/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "codegen/compile.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

bool is_unit(std::string_view text) {
  std::string reason;
  return units::is_unit(text, reason);
}

double factor(std::string_view from, std::string_view to) {
  double result = 0.0;
  return units::conversion(from, to, result) ? result : std::numeric_limits<double>::quiet_NaN();
}

TEST(Units, AreSymbolsProductsAndPowers) {
  for (const auto* text : {"1", "m", "um", "µm", "um/V", "N*m", "N·m", "kg*m^2/s^2", "m^(1/2)", "1/(m*K)", "degC", "°C",
                           "%", "m²", "Ohm", "rpm"}) {
    EXPECT_TRUE(is_unit(text)) << text;
  }
  for (const auto* text :
       {"", "umm", "m/", "m^", "m^x", "(m", "m)", "2", "m^(1/0)", "m m", "((((((((((((((((((((m))))))))))))))))))))"}) {
    EXPECT_FALSE(is_unit(text)) << text;
  }
}

TEST(Units, Convert) {
  EXPECT_DOUBLE_EQ(factor("um", "m"), 1e-6);
  EXPECT_DOUBLE_EQ(factor("N*m/s", "W"), 1.0);
  EXPECT_DOUBLE_EQ(factor("rpm", "rad/s"), 2.0 * 3.14159265358979323846 / 60.0);
  EXPECT_DOUBLE_EQ(factor("kg*m/s^2", "mN"), 1e3);
  EXPECT_TRUE(std::isnan(factor("m", "s")));
  EXPECT_TRUE(std::isnan(factor("K", "degC"))) << "their zeros differ";
}

// A cycle is a whole turn: 2π rad, 360 deg, 1 rev. Where one side names neither, 1/s is what the other says.
TEST(Units, OfAngularVelocityAndFrequencyDifferByATurn) {
  constexpr double turn = 2.0 * 3.14159265358979323846;
  EXPECT_DOUBLE_EQ(factor("Hz", "rad/s"), turn);
  EXPECT_DOUBLE_EQ(factor("rad/s", "Hz"), 1.0 / turn);
  EXPECT_DOUBLE_EQ(factor("rpm", "Hz"), 1.0 / 60.0);
  EXPECT_DOUBLE_EQ(factor("rev/s", "Hz"), 1.0);
  EXPECT_DOUBLE_EQ(factor("deg/s", "Hz"), 1.0 / 360.0);
  EXPECT_DOUBLE_EQ(factor("kHz", "rpm"), 60'000.0);
  EXPECT_DOUBLE_EQ(factor("Hz^2", "rad^2/s^2"), turn * turn);
  EXPECT_DOUBLE_EQ(factor("Hz", "1/s"), 1.0);
  EXPECT_DOUBLE_EQ(factor("1/ms", "kHz"), 1.0);
  EXPECT_DOUBLE_EQ(factor("rad/s", "1/s"), 1.0);
  EXPECT_DOUBLE_EQ(factor("N*m*rad/s", "W"), 1.0);
  EXPECT_DOUBLE_EQ(factor("Hz*s", "rad"), turn);
}

TEST(Units, OfParametersComeFromTheWires) {
  const Program program = compile_text(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit um *) "
      "END_VAR "
      "VAR G : HY_GAIN; L : HY_LAG; END_VAR G(XIN := U); L(XIN := G.XOUT); Y := L.XOUT; END_FUNCTION_BLOCK");
  const auto texts = units::Solution(program.graph, program.schedule).parameters();
  EXPECT_EQ(texts[static_cast<std::size_t>(find_parameter(program.graph, "G.K"))], "um/V");
  EXPECT_EQ(texts[static_cast<std::size_t>(find_parameter(program.graph, "L.T1"))], "s");
}

TEST(Units, OfParametersWhoseExponentIsAParameter) {
  const auto unit_of_c2 = [](const std::string& x, const std::string& y) {
    const Program program = compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; (* @unit " + x +
                                         " *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit " + y +
                                         " *) END_VAR VAR H : HY_HYSTERESIS_RO; END_VAR H(XIN := U); Y := H.XOUT; "
                                         "END_FUNCTION_BLOCK");
    return units::Solution(program.graph, program.schedule)
        .parameters()[static_cast<std::size_t>(find_parameter(program.graph, "H.C2"))];
  };
  EXPECT_EQ(unit_of_c2("V", "um"), "um/V^(1+C3)");
  EXPECT_EQ(unit_of_c2("A/m", "T"), "T/(A/m)^(1+C3)");
  const Program silent = compile_text(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
      "VAR H : HY_HYSTERESIS_RO; END_VAR H(XIN := U); Y := H.XOUT; END_FUNCTION_BLOCK");
  EXPECT_EQ(units::Solution(silent.graph, silent.schedule)
                .parameters()[static_cast<std::size_t>(find_parameter(silent.graph, "H.C2"))],
            "");
}

/// What the check of units says: causes and mends.
std::vector<Diagnostic> unit_faults(const std::string& ports, const std::string& parts, const std::string& text) {
  try {
    (void)compile_text("FUNCTION_BLOCK T (* @ts 1ms *) " + ports + " " + parts + " " + text + " END_FUNCTION_BLOCK");
    return {};
  } catch (const InputError& problem) {
    for (const Diagnostic& one : problem.diagnostics().all()) {
      EXPECT_EQ(one.number, error::unit_mismatch) << one.cause;
    }
    return problem.diagnostics().all();
  }
}
const std::string bare = "VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR";
const std::string volts = "VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit V *) END_VAR";
const std::string integral = "VAR I : HY_INTEGRAL_FORWARD; END_VAR";

std::string constant(const std::string& unit) {
  return "VAR CONSTANT C : LREAL := 10.0; (* @unit " + unit + " *) END_VAR ";
}

TEST(Units, OfAConstantCount) {
  const std::string loop = "Y := I.XOUT; I(XIN := C * (U - I.XOUT));";
  EXPECT_TRUE(unit_faults(volts, constant("1/s") + integral, loop).empty());
  EXPECT_EQ(unit_faults(volts, constant("1") + integral, loop).size(), 1U);
  EXPECT_TRUE(unit_faults(volts, constant("V"), "Y := U + C;").empty());
  EXPECT_EQ(unit_faults(volts, constant("m"), "Y := U + C;").size(), 1U);
  EXPECT_EQ(unit_faults(volts, constant("m"), "Y := C;").size(), 1U);
  EXPECT_EQ(unit_faults(volts, constant("m") + "VAR W : LREAL; (* @unit s *) END_VAR", "W := C; Y := U;").size(), 1U);
}

TEST(Units, OfConstantsGoThroughWhatIsComputedOfThem) {
  EXPECT_TRUE(unit_faults(volts, constant("V"), "Y := U + 2.0 * C;").empty());
  EXPECT_TRUE(unit_faults(volts, constant("V"), "Y := U + SQRT(C * C) / 2.0;").empty());
  EXPECT_TRUE(unit_faults(volts, constant("rad"), "Y := U * SIN(C);").empty());
  EXPECT_EQ(unit_faults(volts, constant("V"), "Y := U + C * C;").size(), 1U);
  EXPECT_EQ(unit_faults(volts, constant("V"), "Y := U * SIN(C);").size(), 1U) << "folded only where units agree";
  EXPECT_EQ(
      unit_faults(volts, constant("V") + "VAR CONSTANT L : LREAL := 1.0; (* @unit m *) END_VAR", "Y := U + (C + L);")
          .size(),
      1U);
}

TEST(Units, OfAConstantReachTheInputOfABlock) {
  const std::string stage =
      "FUNCTION_BLOCK STAGE VAR_INPUT X : LREAL; (* @unit um *) END_VAR VAR_OUTPUT Z : LREAL; (* @unit um *) END_VAR "
      "Z := X; END_FUNCTION_BLOCK ";
  const auto compiles = [&](const std::string& unit) {
    Diagnostics diagnostics;
    auto parsed =
        language::parse("test.st",
                        stage + "FUNCTION_BLOCK T (* @ts 1ms *) VAR_OUTPUT Y : LREAL; END_VAR " + constant(unit) +
                            " VAR S : STAGE; END_VAR S(X := C); Y := S.Z; END_FUNCTION_BLOCK",
                        diagnostics);
    check(std::make_shared<const language::SourceFile>(std::move(parsed)), diagnostics);
    return !diagnostics.has_errors();
  };
  EXPECT_TRUE(compiles("um"));
  EXPECT_FALSE(compiles("V"));
}

TEST(Units, WithoutAStatedUnitNothingIsRefused) {
  EXPECT_TRUE(unit_faults(bare, integral, "Y := I.XOUT; I(XIN := U - I.XOUT);").empty());
  EXPECT_TRUE(unit_faults(bare, integral, "Y := I.XOUT; I(XIN := 10.0 * (U - I.XOUT));").empty());
  EXPECT_TRUE(unit_faults(bare, "VAR D : HY_DERIVATIVE; END_VAR", "D(XIN := U); Y := U + 0.1 * D.XOUT;").empty());
}

TEST(Units, AStatedUnitReachesTheWholeLoop) {
  const std::string half = "VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; (* @unit V *) END_VAR";
  EXPECT_EQ(unit_faults(half, integral, "Y := I.XOUT; I(XIN := 10.0 * (U - I.XOUT));").size(), 1U)
      << "found last, though the loop was met before the unit of Y";
  EXPECT_EQ(unit_faults(bare, constant("m") + integral, "Y := I.XOUT; I(XIN := C * (U - I.XOUT));").size(), 1U);
}

TEST(Units, TheMendSaysHowANumberGetsItsUnit) {
  const auto mend = [](const std::string& parts, const std::string& text) {
    std::string mends;
    for (const Diagnostic& one : unit_faults(volts, parts, text)) {
      mends += one.mend + "\n";
    }
    return mends;
  };
  const auto says = [](const std::string& number, const std::string& unit) {
    return ::testing::HasSubstr("VAR CONSTANT K : LREAL := " + number + "; (* @unit " + unit + " *) END_VAR");
  };
  const std::string rate = "VAR D : HY_DERIVATIVE; END_VAR";
  EXPECT_THAT(mend(rate, "D(XIN := U); Y := U + 0.1 * D.XOUT;"), says("0.1", "s"));
  EXPECT_THAT(mend(rate, "D(XIN := U); Y := 0.1 * D.XOUT + U;"), says("0.1", "s"));
  EXPECT_THAT(mend(rate, "D(XIN := U); Y := U + D.XOUT / 4.0;"), says("4.0", "1/s"));
  EXPECT_THAT(mend(integral, "Y := I.XOUT; I(XIN := 10.0 * (U - I.XOUT));"), says("10.0", "1/s"));
}

TEST(Units, TheMendNamesTheWholeFactor) {
  const auto mend = [](const std::string& unit, const std::string& parts, const std::string& text) {
    const auto faults =
        unit_faults("VAR_INPUT U : LREAL; (* @unit " + unit + " *) END_VAR VAR_OUTPUT Y : LREAL; END_VAR",
                    "VAR " + parts + " END_VAR", text);
    return faults.size() == 1 ? faults.front().mend : std::to_string(faults.size()) + " faults";
  };
  const auto of_sine = [&](const std::string& unit) {
    return mend(unit, "S : HY_SINE;", "Y := S.XOUT; S(FREQUENCY := U);");
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(of_sine("rpm"), HasSubstr("K = 0.016666666666666666 "));
  EXPECT_THAT(of_sine("rad/s"), HasSubstr("K = 0.15915494309189535 "));
  EXPECT_THAT(of_sine("kHz"), HasSubstr("K = 1000 "));
  EXPECT_EQ(of_sine("rev/s"), "0 faults");
  EXPECT_EQ(of_sine("1/s"), "0 faults");
  EXPECT_THAT(mend("deg", "S : HY_SIN;", "S(XIN := U); Y := S.XOUT;"), HasSubstr("K = 0.017453292519943295 "));
  EXPECT_THAT(mend("mV", "W : LREAL; (* @unit V *)", "W := U; Y := W;"), HasSubstr("K = 0.001 "));
  EXPECT_THAT(mend("kHz", "T : LREAL := 1.0; (* @unit ms *)", "Y := SIN(U * T);"), HasSubstr("K = 6.283185307179586 "));
}

TEST(Units, ANumberThatConvertsIsWrittenAsAConstant) {
  const std::string ports =
      "VAR_INPUT F : LREAL; (* @unit Hz *) END_VAR VAR_OUTPUT W : LREAL; (* @unit rad/s *) END_VAR";
  const auto faults = unit_faults(ports, "", "W := 6.283185307179586 * F;");
  ASSERT_EQ(faults.size(), 1U);
  const std::string constant = "VAR CONSTANT K : LREAL := 6.283185307179586; (* @unit rad/(Hz*s) *) END_VAR";
  EXPECT_THAT(faults.front().mend, ::testing::HasSubstr(constant));
  EXPECT_TRUE(unit_faults(ports, constant, "W := K * F;").empty()) << "the mend mends";
}

/// Solutions that hang on each other may be as many as the diagram has blocks.
TEST(Units, OfALongChainAreSolved) {
  constexpr int length = 50'000;
  std::string parts = "VAR ";
  std::string text;
  for (int i = 0; i < length; ++i) {
    parts += "L" + std::to_string(i) + " : HY_LAG; V" + std::to_string(i) + " : LREAL; ";
    text += "L" + std::to_string(i) + "(XIN := " + (i == 0 ? std::string("U") : "V" + std::to_string(i - 1)) + "); V" +
            std::to_string(i) + " := L" + std::to_string(i) + ".XOUT; ";
  }
  const std::string ports = "VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; (* @unit V *) END_VAR";
  const Program program = compile_text("FUNCTION_BLOCK T (* @ts 1ms *) " + ports + " " + parts + " END_VAR " + text +
                                       "Y := V" + std::to_string(length - 1) + "; END_FUNCTION_BLOCK");
  const auto units = units::Solution(program.graph, program.schedule).outputs();
  for (const auto& of_node : units) {
    ASSERT_EQ(of_node.front(), "V");
  }
}

}  // namespace
}  // namespace hysteron::testing
