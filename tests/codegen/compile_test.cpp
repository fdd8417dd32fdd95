// What the compiler makes of a diagram: its diagnostics with their places, its schedule, its rates.
#include "codegen/compile.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<Diagnostic> diagnose(const std::string& text) {
  Diagnostics diagnostics;
  auto parsed = language::parse("test.st", text, diagnostics);
  if (!diagnostics.has_errors()) {
    check(std::make_shared<const language::SourceFile>(std::move(parsed)), diagnostics);
  }
  return diagnostics.all();
}

std::string block(const std::string& declarations, const std::string& statements) {
  return "FUNCTION_BLOCK T (* @ts 1ms *)\n" + declarations + "\n" + statements + "\nEND_FUNCTION_BLOCK\n";
}
const std::string io = "VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR ";

TEST(Compile, FindsSeveralFaultsAtOnceInTheOrderOfTheText) {
  const auto found = diagnose(block(io + "VAR G : HY_GAIM; H : HY_GAIN; END_VAR", "H(XIM := U);\nY := W;"));
  ASSERT_EQ(found.size(), 3U);  // that XIN is not connected is the same fault as XIM
  EXPECT_EQ(found[0].number, error::unknown_block);
  EXPECT_THAT(found[0].mend, HasSubstr("HY_GAIN"));
  EXPECT_EQ(found[1].number, error::unknown_pin);
  EXPECT_THAT(found[1].mend, HasSubstr("Did you mean XIN?"));
  EXPECT_EQ(found[1].place.line, 3U);
  EXPECT_EQ(found[1].place.column, 3U);
  EXPECT_EQ(found[2].number, error::unknown_name);
}

TEST(Compile, APinWhoseValueIsRefusedIsNotToldAsUnconnected) {
  const auto numbers = [](const std::string& call) {
    std::vector<int> list;
    for (const Diagnostic& one :
         diagnose("FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT X : BOOL; END_VAR VAR_OUTPUT Q : BOOL; END_VAR\n"
                  "VAR T : HY_TON; END_VAR\n" +
                  call + " Q := T.Q; END_FUNCTION_BLOCK")) {
      list.push_back(one.number);
    }
    return list;
  };
  EXPECT_EQ(numbers("T(IN := X, PT := 2);"), std::vector<int>{error::type_mismatch});
  EXPECT_EQ(numbers("T(IN := X, PT := NOWHERE);"), std::vector<int>{error::unknown_name});
  EXPECT_EQ(numbers("T(IN := X);"), std::vector<int>{error::unconnected_input});
}

TEST(Compile, AnAlgebraicLoopIsAPathWithTheWiresWhereADelayWouldCutIt) {
  const auto found = diagnose(block(io + "VAR A : HY_GAIN; B : HY_LAG; S : HY_SUM; END_VAR",
                                    "S(IN1 := U, IN2 := B.XOUT);\nA(XIN := S.XOUT);\nB(XIN := A.XOUT);\nY := B.XOUT;"));
  ASSERT_THAT(found, Contains(::testing::Field(&Diagnostic::number, error::algebraic_loop)));
  const auto& loop = *std::ranges::find(found, error::algebraic_loop, &Diagnostic::number);
  EXPECT_THAT(loop.cause, AllOf(HasSubstr("A → B"), HasSubstr("B → S"), HasSubstr("S → A")));
  ASSERT_EQ(loop.notes.size(), 3U);
  for (const Note& note : loop.notes) {
    EXPECT_THAT(note.text, HasSubstr("a HY_DELAY here would cut the loop"));
    EXPECT_GT(note.place.line, 1U);
  }
}

/// Of a loop through two instances of one block, that it is cut for one of them.
TEST(Compile, AnAlgebraicLoopThroughBlocksOfBlocksIsShownWhereTheyAreWired) {
  const std::string inner =
      "FUNCTION_BLOCK INNER VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "VAR G : HY_GAIN; V : LREAL; END_VAR G(XIN := X); V := G.XOUT + 1.0; Y := V; END_FUNCTION_BLOCK\n";
  const auto found = diagnose(inner + block(io + "VAR P : INNER; Q : INNER; A : LREAL; END_VAR",
                                            "A := U + Q.Y;\nP(X := A);\nQ(X := P.Y);\nY := Q.Y;"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].number, error::algebraic_loop);
  std::vector<std::uint32_t> lines;
  for (const Note& note : found[0].notes) {
    lines.push_back(note.place.line);
  }
  EXPECT_THAT(lines, ::testing::UnorderedElementsAre(5U, 6U, 7U));
  EXPECT_THAT(lines, Contains(found[0].place.line));
}

TEST(Compile, AnAlgebraicLoopInsideABlockOfBlocksIsShownThere) {
  const std::string inner =
      "FUNCTION_BLOCK INNER VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "VAR G : HY_GAIN; S : HY_SUM; END_VAR\nG(XIN := S.XOUT);\nS(IN1 := X, IN2 := G.XOUT); Y := G.XOUT; "
      "END_FUNCTION_BLOCK\n";
  const auto found = diagnose(inner + block(io + "VAR P : INNER; END_VAR", "P(X := U);\nY := P.Y;"));
  ASSERT_THAT(found, Contains(::testing::Field(&Diagnostic::number, error::algebraic_loop)));
  const auto& loop = *std::ranges::find(found, error::algebraic_loop, &Diagnostic::number);
  ASSERT_EQ(loop.notes.size(), 2U);
  for (const Note& note : loop.notes) {
    EXPECT_THAT(note.place.line, ::testing::AnyOf(3U, 4U));
  }
}

TEST(Compile, TheMendOfATypeSaysWhatTheOperatorTakes) {
  const auto mend = [](const std::string& type, const std::string& expression) {
    const auto found =
        diagnose(block("VAR_INPUT A : " + type + "; B : " + type + "; END_VAR VAR_OUTPUT Y : " + type + "; END_VAR",
                       "Y := " + expression + ";"));
    return found.size() == 1 && found[0].number == error::type_mismatch ? found[0].mend : "";
  };
  EXPECT_THAT(mend("WORD", "A + B"), AllOf(HasSubstr("It takes LREAL or DINT"), HasSubstr("WORD_TO_DINT")));
  EXPECT_THAT(mend("LREAL", "A AND B"), AllOf(HasSubstr("It takes BOOL or WORD"), HasSubstr("A comparison")));
  EXPECT_THAT(mend("DINT", "A ** B"), AllOf(HasSubstr("It takes LREAL"), HasSubstr("DINT_TO_LREAL")));
  EXPECT_THAT(mend("LREAL", "A MOD B"), AllOf(HasSubstr("It takes DINT"), HasSubstr("LREAL_TO_DINT")));
  EXPECT_THAT(mend("BOOL", "A + B"), AllOf(HasSubstr("It takes LREAL or DINT"), HasSubstr("SEL turns a BOOL")));
  EXPECT_THAT(mend("LREAL", "NOT A"), AllOf(HasSubstr("It takes BOOL"), HasSubstr("A comparison")));
}

/// Every pair of types that are not the same has a mend that names what turns the one into the other.
TEST(Compile, TheMendOfAnAssignmentNamesTheConversion) {
  const std::vector<std::vector<std::string>> wanted{{"", "DINT_TO_LREAL", "SEL(B, 0.0, 1.0)", "WORD_TO_DINT(W)"},
                                                     {"LREAL_TO_DINT", "", "SEL(B, 0, 1)", "WORD_TO_DINT"},
                                                     {"A comparison", "A comparison", "", "W.3"},
                                                     {"LREAL_TO_DINT(X)", "DINT_TO_WORD", "WORD#1", ""}};
  const std::vector<std::string> types{"LREAL", "DINT", "BOOL", "WORD"};
  for (std::size_t to = 0; to < types.size(); ++to) {
    for (std::size_t from = 0; from < types.size(); ++from) {
      const auto found = diagnose(
          block("VAR_INPUT A : " + types[from] + "; END_VAR VAR_OUTPUT Y : " + types[to] + "; END_VAR", "Y := A;"));
      ASSERT_EQ(found.size(), to == from ? 0U : 1U);
      EXPECT_THAT(to == from ? "" : found[0].mend, HasSubstr(wanted[to][from])) << types[to] << " := " << types[from];
    }
  }
}

TEST(Compile, RatesThatDifferByTheirPhasesAreTold) {
  const auto found = diagnose(block(io + "VAR A : HY_SAMPLE; (* @every 3 @phase 1 *) B : HY_GAIN; (* @every 3 *) "
                                         "H : HY_HOLD; END_VAR",
                                    "A(XIN := U); B(XIN := A.XOUT); H(XIN := B.XOUT); Y := H.XOUT;"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].cause, "B runs every 3 steps from step 0, its input XIN changes every 3 steps from step 1");
}

TEST(Compile, ADelayClosesALoop) {
  EXPECT_THAT(diagnose(block(io + "VAR A : HY_GAIN; Z : HY_DELAY; S : HY_SUM; END_VAR",
                             "S(IN1 := U, IN2 := Z.XOUT);\nA(XIN := S.XOUT);\nZ(XIN := A.XOUT);\nY := A.XOUT;")),
              IsEmpty());
}

TEST(Compile, ADelayThatIsWiredToItselfKeepsItsValue) {
  Machine<double> machine(
      compile_text(block(io + "VAR Z : HY_DELAY := (X0 := 0.5); END_VAR", "Y := Z.XOUT + U;\nZ(XIN := Z.XOUT);")),
      0.001);
  for (int k = 0; k < 4; ++k) {
    machine.step();
    EXPECT_EQ(machine.output(0), 0.5) << "step " << k;
  }
}

TEST(Compile, TheFeedforwardOfThePaperClosesWithoutADelayBlock) {
  EXPECT_THAT(diagnose(block(io + "VAR RATE : HY_DERIVATIVE; B : HY_BRANCH; P : HY_MOMENTUM; INV : HY_M_INVERSE; SUM : "
                                  "HY_INTEGRAL; END_VAR",
                             "RATE(XIN := U); B(XIN := U);\nINV(XIN := RATE.XOUT, P := P.XOUT, R1 := B.Q);\n"
                             "P(XIN := INV.XOUT, R1 := B.Q); SUM(XIN := INV.XOUT); Y := SUM.XOUT;")),
              IsEmpty());
}

TEST(Compile, AReadBeforeTheCallIsAHiddenDelayUnlessTheInstanceIsADelay) {
  const auto hidden = diagnose(block(io + "VAR A : HY_GAIN; END_VAR", "Y := A.XOUT;\nA(XIN := U);"));
  ASSERT_EQ(hidden.size(), 1U);
  EXPECT_EQ(hidden[0].number, error::hidden_delay);
  EXPECT_EQ(hidden[0].place.line, 3U);
  EXPECT_THAT(diagnose(block(io + "VAR Z : HY_DELAY; END_VAR", "Y := Z.XOUT;\nZ(XIN := U);")), IsEmpty());
  const auto late = diagnose(block(io + "VAR Z : HY_DELAY; END_VAR", "Z(XIN := U);\nY := Z.XOUT;"));
  ASSERT_EQ(late.size(), 1U);
  EXPECT_EQ(late[0].severity, Severity::Warning) << "here it is this step's value all the same";
}

TEST(Compile, FormattingInAnyOrderMendsHiddenDelaysAndChangesNothingTwice) {
  Diagnostics diagnostics;
  const std::string text =
      block(io + "VAR A : HY_GAIN; Z : HY_DELAY; END_VAR", "Y := A.XOUT + Z.XOUT;\nZ(XIN := A.XOUT);\nA(XIN := U);");
  const std::string once = format_text("t", text, diagnostics, {.any_order = true});
  EXPECT_THAT(diagnose(once), IsEmpty()) << once;
  EXPECT_EQ(format_text("t", once, diagnostics), once);
}

TEST(Compile, FormattingPutsWhatMustBeBeforeWhatShouldBe) {
  // Of HY_CLOCK, XOUT depends on the step and ERROR on the memory alone. What reads both must stand behind the call for
  // the one and should stand before it for the other, which is worth a warning only.
  const std::string text = block(io + "VAR C : HY_CLOCK; END_VAR", "Y := SEL(C.ERROR, C.XOUT, 0.0);\nC(XIN := U);");
  Diagnostics diagnostics;
  for (const Diagnostic& one : diagnose(format_text("t", text, diagnostics, {.any_order = true}))) {
    EXPECT_EQ(one.number, error::read_after_call) << one.cause;
  }
}

TEST(Compile, ABlockWithADelayInsideClosesALoop) {
  const std::string inner =
      "FUNCTION_BLOCK PLANT VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR I : HY_INTEGRAL_FORWARD; "
      "END_VAR\n"
      "Y := I.XOUT; I(XIN := U);\nEND_FUNCTION_BLOCK\n";
  const auto found = diagnose(
      inner + block("VAR_INPUT R : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR P : PLANT; K : HY_GAIN; END_VAR",
                    "K(XIN := R - P.Y); P(U := K.XOUT); Y := P.Y;"));
  EXPECT_THAT(found, ::testing::Not(Contains(::testing::Field(&Diagnostic::severity, Severity::Error))));
}

TEST(Compile, HierarchyIsFlattenedAndParametersKeepTheirPaths) {
  const Program program = compile_text(
      "FUNCTION_BLOCK STAGE VAR_INPUT U : LREAL; K : LREAL := 2.0; (* @param @min 0 *) END_VAR VAR_OUTPUT Y : LREAL; "
      "END_VAR "
      "VAR L : HY_LAG := (T1 := 0.25); END_VAR L(XIN := U * K); Y := L.XOUT; END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR A, B : STAGE; "
      "END_VAR "
      "A(U := U); B(U := A.Y, K := 3.0); Y := B.Y; END_FUNCTION_BLOCK");
  std::vector<std::string> paths;
  for (const Parameter& parameter : program.graph.parameters) {
    paths.push_back(parameter.path);
  }
  EXPECT_THAT(paths, Contains("A.K"));
  EXPECT_THAT(paths, Contains("B.K"));
  EXPECT_THAT(paths, Contains("A.L.T1"));
  EXPECT_EQ(program.graph.parameters[static_cast<std::size_t>(find_parameter(program.graph, "b.k"))].value.front(),
            3.0);
}

TEST(Compile, ABlockCannotContainItself) {
  EXPECT_THAT(
      diagnose("FUNCTION_BLOCK A VAR_OUTPUT Y : LREAL; END_VAR VAR X : B; END_VAR X(); Y := X.Y; END_FUNCTION_BLOCK\n"
               "FUNCTION_BLOCK B VAR_OUTPUT Y : LREAL; END_VAR VAR X : A; END_VAR X(); Y := X.Y; END_FUNCTION_BLOCK"),
      Contains(::testing::Field(&Diagnostic::number, error::recursive_block)));
}

TEST(Compile, NamesOfTheLibraryAreReserved) {
  for (const std::string declaration : {"HY_LAG : HY_LAG;", "hy_sum : LREAL := 1.0;"}) {
    EXPECT_THAT(diagnose(block(fmt::format("{}VAR {} END_VAR", io, declaration), "Y := U;")),
                Contains(::testing::Field(&Diagnostic::number, error::reserved_name)))
        << declaration;
  }
}

/// Thirty blocks that hold two of the one before: refused before they are counted out.
TEST(Compile, TheInstancesOfABlockAreBounded) {
  std::string text;
  for (int i = 0; i < 30; ++i) {
    const std::string inner = "B" + std::to_string(i - 1);
    text += "FUNCTION_BLOCK B" + std::to_string(i) + " VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR " +
            (i == 0 ? "Y := X;" : "VAR I, J : " + inner + "; END_VAR I(X := X); J(X := I.Y); Y := J.Y;") +
            " END_FUNCTION_BLOCK\n";
  }
  const auto found = diagnose(text);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().number, error::nested_too_deeply);
  EXPECT_THAT(found.front().cause, AllOf(HasSubstr("'B20'"), HasSubstr("2097150 instances")));
}

TEST(Compile, TheLevelsOfBlocksInBlocksAreBounded) {
  std::string text =
      "FUNCTION_BLOCK B0 VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR Y := X; "
      "END_FUNCTION_BLOCK\n";
  for (int i = 1; i <= 1000; ++i) {
    text += "FUNCTION_BLOCK B" + std::to_string(i) +
            " VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR I : B" + std::to_string(i - 1) +
            "; END_VAR I(X := X); Y := I.Y; END_FUNCTION_BLOCK\n";
  }
  const auto found = diagnose(text);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().number, error::nested_too_deeply);
  EXPECT_THAT(found.front().cause, HasSubstr("1001 levels"));
}

/// Operations take the rate of their operands, however many stand in a row.
TEST(Compile, ALongChainOfOperationsGetsItsRate) {
  constexpr int length = 100'000;
  std::string parts = "VAR S : HY_SAMPLE; (* @every 2 *) H : HY_HOLD; ";
  std::string text = "S(XIN := U); V0 := S.XOUT + 1.0; ";
  for (int i = 0; i < length; ++i) {
    parts += "V" + std::to_string(i) + " : LREAL; ";
    if (i > 0) {
      text += "V" + std::to_string(i) + " := V" + std::to_string(i - 1) + " + 1.0; ";
    }
  }
  const auto found =
      diagnose(block(io + parts + "END_VAR", text + "H(XIN := V" + std::to_string(length - 1) + "); Y := H.XOUT;"));
  EXPECT_THAT(found, IsEmpty());
}

TEST(Compile, UnitsAreCarriedThroughBlocksAndExpressions) {
  const auto with = [&](const std::string& in, const std::string& out, const std::string& parts,
                        const std::string& text) {
    return diagnose(block("VAR_INPUT U : LREAL; (* @unit " + in + " *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit " + out +
                              " *) END_VAR " + parts,
                          text));
  };
  const std::string lag = "VAR L : HY_LAG; END_VAR";
  EXPECT_THAT(with("um", "um", lag, "L(XIN := U); Y := L.XOUT;"), IsEmpty());
  EXPECT_THAT(with("um", "m", lag, "L(XIN := U); Y := L.XOUT;"),
              Contains(::testing::Field(&Diagnostic::number, error::unit_mismatch)));
  EXPECT_THAT(with("um", "um/s", "VAR D : HY_DERIVATIVE; END_VAR", "D(XIN := U); Y := D.XOUT;"), IsEmpty());
  EXPECT_THAT(with("m/s", "m", "VAR I : HY_INTEGRAL; END_VAR", "I(XIN := U); Y := I.XOUT;"), IsEmpty());
  EXPECT_THAT(with("N*m/s", "W", "", "Y := 2.0 * U;"), IsEmpty());
  EXPECT_THAT(with("V", "A", "", "Y := 2.0 * U;"),
              Contains(::testing::Field(&Diagnostic::number, error::unit_mismatch)));
  EXPECT_THAT(with("m^2", "m", "", "Y := SQRT(U);"), IsEmpty());
  EXPECT_THAT(with("V", "V", "", "Y := U + 1.0;"), IsEmpty()) << "a literal takes the unit of what it is added to";
  EXPECT_THAT(with("V", "1", "", "Y := SIN(U);"),
              Contains(::testing::Field(&Diagnostic::number, error::unit_mismatch)));
  EXPECT_THAT(with("V", "um", "VAR G : HY_GAIN; END_VAR", "G(XIN := U); Y := G.XOUT;"), IsEmpty())
      << "a gain changes the unit";
  EXPECT_THAT(with("°C", "degC", "", "Y := U;"), IsEmpty());
  EXPECT_THAT(with("µm", "um", "", "Y := U;"), IsEmpty());
}

TEST(Compile, UnitsAreCheckedAtVariablesAndAtTheBordersOfBlocks) {
  const auto unit_errors = [](const std::string& text) {
    const auto found = diagnose(text);
    return std::ranges::count(found, error::unit_mismatch, &Diagnostic::number);
  };
  const std::string ports = "VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; END_VAR ";
  EXPECT_EQ(unit_errors(block(ports + "VAR W : LREAL; (* @unit V *) END_VAR", "W := U; Y := W;")), 0);
  EXPECT_EQ(unit_errors(block(ports + "VAR W : LREAL; (* @unit um *) END_VAR", "W := U; Y := W;")), 1);
  const std::string inner =
      "FUNCTION_BLOCK STAGE VAR_INPUT X : LREAL; (* @unit um *) END_VAR VAR_OUTPUT Z : LREAL; (* @unit um *) END_VAR "
      "Z := X; END_FUNCTION_BLOCK\n";
  EXPECT_EQ(unit_errors(inner + block(ports + "VAR S : STAGE; END_VAR", "S(X := U); Y := S.Z;")), 1);
  EXPECT_EQ(
      unit_errors(inner + block("VAR_INPUT U : LREAL; (* @unit um *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit um *) "
                                "END_VAR VAR S : STAGE; END_VAR",
                                "S(X := U); Y := S.Z;")),
      0);
}

TEST(Compile, ASlowerPartRunsInItsStepsAndIsHeldBetween) {
  const std::string text = block(
      "VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR S : HY_SAMPLE; (* @every 4 @phase 1 *) "
      "I : HY_INTEGRAL; (* @every 4 @phase 1 *) H : HY_HOLD; END_VAR",
      "S(XIN := U); I(XIN := S.XOUT); H(XIN := I.XOUT); Y := H.XOUT;");
  EXPECT_THAT(diagnose(text), IsEmpty());
  Machine<double> machine(compile_text(text));
  double sum = 0.0;
  for (int k = 0; k < 40; ++k) {
    machine.set_input(0, k);
    machine.step();
    sum += k % 4 == 1 ? k * 4e-3 : 0.0;
    ASSERT_NEAR(machine.output(0), sum, 1e-15) << "step " << k;
  }
}

TEST(Compile, AFloatMachineTakesAndGivesEveryDint) {
  Machine<float> machine(compile_text(block("VAR_INPUT N : DINT; END_VAR VAR_OUTPUT M : DINT; END_VAR", "M := N;")));
  for (const double n : {16777217.0, -16777217.0, 2147483647.0, -2147483648.0}) {  // the first has no float
    machine.set_input(0, n);
    machine.step();
    EXPECT_EQ(machine.output(0), n);
  }
}

TEST(Compile, RoundingToDintIsToTheNearestEvenAndEndsWhereDintEnds) {
  Machine<double> machine(
      compile_text(block("VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT N : DINT; END_VAR", "N := LREAL_TO_DINT(X);")));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponents(-2.0, 34.0);
  const auto expect_rounded = [&](double x) {
    machine.set_input(0, x);
    machine.step();
    ASSERT_EQ(machine.output(0), std::clamp(std::nearbyint(x), -2147483648.0, 2147483647.0)) << x;
  };
  for (const double x : {2147483646.5, 2147483647.0, 2147483647.5, 2147483647.9, 2147483648.0, -2147483647.5,
                         -2147483648.0, -2147483648.5, -2147483648.9, 1e300, -1e300}) {
    expect_rounded(x);
  }
  for (int k = -9; k <= 9; ++k) {
    expect_rounded(0.5 * k);
  }
  for (int k = 0; k < 10000; ++k) {
    expect_rounded((k % 2 == 0 ? 1.0 : -1.0) * std::exp2(exponents(random)));
  }
}

TEST(Compile, AWireBetweenTwoRatesNeedsASampleOrAHold) {
  const auto found = diagnose(block(io + "VAR A : HY_GAIN; (* @every 2 *) END_VAR", "A(XIN := U); Y := A.XOUT;"));
  EXPECT_THAT(found, Contains(::testing::Field(&Diagnostic::number, error::rate_mismatch)));
}

TEST(Compile, RatesNeedACommonPeriodThatACounterHolds) {
  const auto two_rates = [](int a, int b) {
    return block(io + "VAR A : HY_SAMPLE; (* @every " + std::to_string(a) + " *) B : HY_SAMPLE; (* @every " +
                     std::to_string(b) + " *) KA : HY_HOLD; KB : HY_HOLD; END_VAR",
                 "A(XIN := U); B(XIN := U); KA(XIN := A.XOUT); KB(XIN := B.XOUT); Y := KA.XOUT + KB.XOUT;");
  };
  EXPECT_THAT(diagnose(two_rates(65536, 32749)), IsEmpty()) << "2146238464 steps are below 2147483647";
  const auto beyond = diagnose(two_rates(65536, 32771));
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_EQ(beyond[0].number, error::rates_too_far_apart);
  EXPECT_THAT(beyond[0].cause, HasSubstr("the rates repeat together only every 2147680256 steps"));

  // A slow instance in a slow instance runs at the product.
  const std::string inner = "FUNCTION_BLOCK SLOW " + io +
                            "VAR S : HY_SAMPLE; (* @every 100000 *) H : HY_HOLD; END_VAR\n"
                            "S(XIN := U); H(XIN := S.XOUT); Y := H.XOUT;\nEND_FUNCTION_BLOCK\n";
  const auto nested = [&](int every) {
    return diagnose(inner + block(io + "VAR A : HY_SAMPLE; (* @every " + std::to_string(every) +
                                      " *) P : SLOW; (* @every " + std::to_string(every) + " *) K : HY_HOLD; END_VAR",
                                  "A(XIN := U); P(U := A.XOUT); K(XIN := P.Y); Y := K.XOUT;"));
  };
  EXPECT_THAT(nested(20000), IsEmpty());
  const auto product = nested(50000);
  ASSERT_EQ(product.size(), 1U);
  EXPECT_EQ(product[0].number, error::rates_too_far_apart);
  EXPECT_THAT(product[0].cause, HasSubstr("'S' would run every 5000000000 steps"));

  std::string ages = two_rates(1000000, 1000000);
  ages.replace(ages.find("1ms"), 3, "10000000s");
  ASSERT_EQ(diagnose(ages).size(), 1U);
  EXPECT_THAT(diagnose(ages)[0].cause, HasSubstr("more than 292 years"));
}

TEST(Compile, TheOrderOfTheTextDoesNotCount) {
  std::vector<std::string> declarations;
  std::vector<std::string> statements;
  for (int i = 0; i < 30; ++i) {
    const std::string n = std::to_string(i);
    declarations.push_back("    G" + n + " : " + (i % 3 == 0 ? "HY_LAG" : i % 3 == 1 ? "HY_DELAY" : "HY_GAIN") + ";\n");
    statements.push_back(
        "  G" + n + "(XIN := " +
        (i < 2 ? "U" : "G" + std::to_string((i * 7) % i) + ".XOUT * 0.5 + G" + std::to_string(i - 1) + ".XOUT") +
        ");\n");
  }
  statements.emplace_back("  Y := G29.XOUT;\n");
  std::mt19937 engine(1);
  std::string first;
  for (int round = 0; round < 100; ++round) {
    std::string text =
        "FUNCTION_BLOCK T (* @ts 1ms *)\n  VAR_INPUT\n    U : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    Y : LREAL;\n  "
        "END_VAR\n  VAR\n";
    for (const auto& one : declarations) {
      text += one;
    }
    text += "  END_VAR\n";
    for (const auto& one : statements) {
      text += one;
    }
    text += "END_FUNCTION_BLOCK\n";
    const std::string generated = generate_cpp_header(compile_text(text, {.any_order = true})).text;
    Diagnostics diagnostics;
    const std::string formatted = format_text("t", text, diagnostics, {.any_order = true});
    ASSERT_EQ(generate_cpp_header(compile_text(formatted)).text, generated)
        << "formatting puts the statements in order";
    if (round == 0) {
      first = generated;
    }
    ASSERT_EQ(generated, first) << "round " << round;
    std::ranges::shuffle(declarations, engine);
    std::ranges::shuffle(statements, engine);
  }
}

}  // namespace
}  // namespace hysteron::testing
