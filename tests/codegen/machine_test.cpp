// The interpreter: what it prepares of parameters that stand still changes no bit.
#include "codegen/interpreter/machine.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "blocks/catalogue.hpp"

namespace hysteron {
namespace {

/// A block with a time constant, and what else it is given.
struct Case {
  std::string_view block;
  std::string_view name;  ///< of the time constant
  std::string_view more;  ///< parameters
};
constexpr Case cases[] = {
    {"HY_LAG", "T1", ""},
    {"HY_LEAD_LAG", "T2", ", T1 := 0.3"},
    {"HY_DERIVATIVE_FILTERED", "T1", ""},
    {"HY_RELAXATION", "T1", ", GAIN := 0.4"},
    {"HY_CREEP", "T_ONSET", ", GAIN := 0.4"},
    {"HY_CROSS_COUPLING", "T1", ", GAIN := 0.4"},
    {"HY_SECOND_ORDER", "T", ", ZETA := 0.3, K := 2.0"},
};

std::string diagram(const Case& one, bool wired) {
  const std::string parameters = wired ? fmt::format("{}", one.more.empty() ? "" : one.more.substr(2))
                                       : fmt::format("{} := 0.1{}", one.name, one.more);
  const std::string input = one.block == "HY_CROSS_COUPLING" ? "XIN := 0.0, Z := U" : "XIN := U";
  return fmt::format(
      "FUNCTION_BLOCK D (* @ts 10ms *)\n  VAR_INPUT U : LREAL; P : LREAL; END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n"
      "  VAR B : {}{}; END_VAR\n  B({}{});\n  Y := B.XOUT;\nEND_FUNCTION_BLOCK\n",
      one.block, parameters.empty() ? "" : fmt::format(" := ({})", parameters), input,
      wired ? fmt::format(", {} := P", one.name) : "");
}

std::size_t parameter_named(const Program& program, std::string_view name) {
  const auto& parameters = program.graph.parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].field.name == name) {
      return i;
    }
  }
  ADD_FAILURE() << "no parameter " << name;
  return 0;
}

TEST(Machine, WhatItPreparesHasTheBitsOfAParameterThatIsASignal) {
  for (const Case& one : cases) {
    SCOPED_TRACE(one.block);
    const Program still = compile_text(diagram(one, false));
    const Program moving = compile_text(diagram(one, true));
    Machine<double> prepared(still);
    Machine<double> plain(moving);
    const std::size_t time = parameter_named(still, one.name);
    for (const double value : {0.1, 2.0, 0.0004, 1e-9}) {  // set between steps, each takes effect at once
      prepared.set_parameter(time, value);
      plain.set_input(1, value);
      for (int k = 0; k < 50; ++k) {
        const double u = std::sin(0.3 * k) + (k % 17 < 5 ? 1.0 : 0.0);
        prepared.set_input(0, u);
        plain.set_input(0, u);
        prepared.step();
        plain.step();
        ASSERT_EQ(std::bit_cast<std::uint64_t>(prepared.output(0)), std::bit_cast<std::uint64_t>(plain.output(0)))
            << "T = " << value << ", step " << k;
      }
    }
  }
}

TEST(Machine, TheCasesAreAllBlocksWithCoefficients) {
  std::size_t count = 0;
  Catalogue::for_each([&]<class B> { count += HasCoefficients<B> ? 1U : 0U; });
  EXPECT_EQ(count, std::size(cases));
}

}  // namespace
}  // namespace hysteron
