// Units: what is one, how they convert, and what the wires say of parameters.
#include "codegen/graph/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "codegen/compile.hpp"

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

TEST(Units, OfParametersComeFromTheWires) {
  const Program program = compile_text(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit um *) "
      "END_VAR "
      "VAR G : HY_GAIN; L : HY_LAG; END_VAR G(XIN := U); L(XIN := G.XOUT); Y := L.XOUT; END_FUNCTION_BLOCK");
  const auto texts = units::of_parameters(program.graph, program.schedule);
  EXPECT_EQ(texts[static_cast<std::size_t>(find_parameter(program.graph, "G.K"))], "um/V");
  EXPECT_EQ(texts[static_cast<std::size_t>(find_parameter(program.graph, "L.T1"))], "s");
}

TEST(Units, OfParametersWhoseExponentIsAParameter) {
  const auto unit_of_c2 = [](const std::string& x, const std::string& y) {
    const Program program = compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; (* @unit " + x +
                                         " *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit " + y +
                                         " *) END_VAR VAR H : HY_HYSTERESIS_RO; END_VAR H(XIN := U); Y := H.XOUT; "
                                         "END_FUNCTION_BLOCK");
    return units::of_parameters(program.graph,
                                program.schedule)[static_cast<std::size_t>(find_parameter(program.graph, "H.C2"))];
  };
  EXPECT_EQ(unit_of_c2("V", "um"), "um/V^(1+C3)");
  EXPECT_EQ(unit_of_c2("A/m", "T"), "T/(A/m)^(1+C3)");
  const Program silent = compile_text(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
      "VAR H : HY_HYSTERESIS_RO; END_VAR H(XIN := U); Y := H.XOUT; END_FUNCTION_BLOCK");
  EXPECT_EQ(units::of_parameters(silent.graph,
                                 silent.schedule)[static_cast<std::size_t>(find_parameter(silent.graph, "H.C2"))],
            "");
}

}  // namespace
}  // namespace hysteron::testing
