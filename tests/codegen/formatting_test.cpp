// Formatting never changes a meaning: over random texts in random order, what `fmt` lets pass means the same here and
// in an IEC compiler, before and after.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"
#include "tests/codegen/sequential.hpp"

namespace hysteron::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A text of variables, delays, stateless blocks and blocks of its own, one statement for each. Every third stands in
/// an order of its data flow, every third in one that few exchanges have disturbed, every third in any order.
class RandomText {
 public:
  explicit RandomText(std::uint64_t seed) : engine_(seed) {
    names_ = {{"X1", "X2"}, {"B1"}, {"N1"}};
    std::vector<std::string> statements;
    const std::size_t count = 3 + pick(8);
    // What exists before anything is worked out: the delays.
    std::vector<std::string> delays;
    for (std::size_t kind = 0; kind < 3; ++kind) {
      const std::string name = fmt::format("Z{}", kind);
      declare(fmt::format(
          "{} : {};", name,
          std::vector<std::string>{"HY_DELAY := (X0 := 0.5)", "HY_DELAY_BOOL", "HY_DELAY_DINT := (X0 := 3)"}[kind]));
      names_[kind].push_back(name + ".XOUT");
    }
    for (std::size_t i = 0; i < count; ++i) {
      statements.push_back(statement(i));
    }
    for (std::size_t kind = 0; kind < 3; ++kind) {
      std::erase(names_[kind], fmt::format("Z{}.XOUT", kind));
      statements.push_back(fmt::format("Z{}(XIN := {});", kind, expression(kind, 0)));
    }
    statements.insert(statements.begin() + static_cast<std::ptrdiff_t>(count), "Y := " + expression(0, 0) + ";");
    std::size_t exchanges = std::vector<std::size_t>{0, 1 + pick(3), 40}[pick(3)];
    for (; exchanges > 0; --exchanges) {
      std::swap(statements[pick(statements.size())], statements[pick(statements.size())]);
    }
    text_ =
        "FUNCTION_BLOCK THROUGH\n  VAR_INPUT\n    U : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    V : LREAL;\n  END_VAR\n\n"
        "  V := U + 0.5;\nEND_FUNCTION_BLOCK\n"
        "FUNCTION_BLOCK LATER\n  VAR_INPUT\n    U : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    V : LREAL;\n  END_VAR\n  VAR\n"
        "    Z : HY_DELAY;\n  END_VAR\n\n  V := Z.XOUT;\n  Z(XIN := U);\nEND_FUNCTION_BLOCK\n"
        "FUNCTION_BLOCK T  (* @ts 1ms *)\n  VAR_INPUT\n    X1, X2 : LREAL;\n    B1 : BOOL;\n    N1 : DINT;\n  END_VAR\n"
        "  VAR_OUTPUT\n    Y : LREAL;\n  END_VAR\n  VAR\n" +
        declarations_ + "  END_VAR\n\n";
    for (const std::string& one : statements) {
      text_ += "  " + one + "\n";
    }
    text_ += "END_FUNCTION_BLOCK\n";
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::size_t pick(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  void declare(const std::string& declaration) { declarations_ += "    " + declaration + "\n"; }

  std::string statement(std::size_t i) {
    const std::size_t form = pick(7);
    if (form < 3) {
      const std::string name = fmt::format("V{}", i);
      const std::string text = fmt::format("{} := {};", name, expression(form, 0));
      declare(fmt::format("{} : {};", name, std::vector<std::string>{"LREAL := 0.25", "BOOL", "DINT := 2"}[form]));
      names_[form].push_back(name);
      return text;
    }
    const std::string name = fmt::format("I{}", i);
    const std::string type = std::vector<std::string>{"HY_GAIN := (K := 0.75)", "HY_SUM", "THROUGH", "LATER"}[form - 3];
    const bool own = form > 4;
    const std::string text = type == "HY_SUM"
                                 ? fmt::format("{}(IN1 := {}, IN2 := {});", name, expression(0, 0), expression(0, 0))
                                 : fmt::format("{}({} := {});", name, own ? "U" : "XIN", expression(0, 0));
    declare(fmt::format("{} : {};", name, type));
    names_[0].push_back(name + (own ? ".V" : ".XOUT"));
    return text;
  }

  std::string expression(std::size_t kind, int depth) {
    const auto& known = names_[kind];
    if (depth > 2 || pick(2) == 0) {
      return pick(6) == 0 ? std::vector<std::string>{"1.5", "TRUE", "4"}[kind] : known[pick(known.size())];
    }
    const auto part = [&](std::size_t of) { return expression(of, depth + 1); };
    if (pick(4) == 0) {
      return fmt::format("SEL({}, {}, {})", part(1), part(kind), part(kind));
    }
    if (kind == 1) {
      const std::size_t form = pick(4);
      return form == 0   ? fmt::format("({} < {})", part(0), part(0))
             : form == 1 ? fmt::format("({} > {})", part(2), part(2))
             : form == 2 ? fmt::format("({} XOR {})", part(1), part(1))
                         : fmt::format("(NOT {})", part(1));
    }
    return fmt::format("({} {} {})", part(kind), pick(2) == 0 ? "+" : "-", kind == 0 ? part(0) : part(2));
  }

  std::mt19937_64 engine_;
  std::vector<std::vector<std::string>> names_;  ///< by kind, LREAL, BOOL and DINT: what an expression may name
  std::string declarations_;
  std::string text_;
};

/// The output over some steps as an IEC compiler has it.
std::vector<double> executed(const std::string& text, std::uint64_t seed) {
  Diagnostics none;
  const auto source = language::parse("t", text, none);
  Sequential machine(source, "T");
  std::mt19937_64 engine(seed);
  std::vector<double> values;
  for (int k = 0; k < 40; ++k) {
    machine.set("X1", static_cast<double>(engine() % 64) * 0.125 - 4.0);
    machine.set("X2", static_cast<double>(engine() % 64) * 0.125 - 4.0);
    machine.set("B1", static_cast<double>(engine() % 2));
    machine.set("N1", static_cast<double>(engine() % 9) - 4.0);
    machine.step();
    values.push_back(machine.get("Y"));
  }
  return values;
}

/// The same as `hysteron run --any-order` has it.
std::vector<double> run_in_any_order(const std::string& text, std::uint64_t seed) {
  Machine<double> machine(compile_text(text, {.top = "T", .any_order = true}));
  std::mt19937_64 engine(seed);
  std::vector<double> values;
  for (int k = 0; k < 40; ++k) {
    machine.set_input(0, static_cast<double>(engine() % 64) * 0.125 - 4.0);
    machine.set_input(1, static_cast<double>(engine() % 64) * 0.125 - 4.0);
    machine.set_input(2, static_cast<double>(engine() % 2));
    machine.set_input(3, static_cast<double>(engine() % 9) - 4.0);
    machine.step();
    values.push_back(machine.output(0));
  }
  return values;
}

TEST(Formatting, ABitStaysAtItsWord) {
  const std::string text =
      "FUNCTION_BLOCK T\n  VAR_INPUT\n    W : WORD;\n  END_VAR\n  VAR_OUTPUT\n    Y : BOOL;\n  END_VAR\n\n"
      "  Y := W.3 AND NOT W.15;\nEND_FUNCTION_BLOCK\n";
  Diagnostics none;
  EXPECT_EQ(language::format(language::parse("t.st", text, none)), text);
}

TEST(Formatting, LeavesWhatAnIecCompilerComputesOrRefuses) {
  constexpr std::uint64_t count = 3000;
  const std::uint64_t fresh = std::random_device{}();
  SCOPED_TRACE(fmt::format("the fresh half begins with seed {}", fresh));
  std::size_t passed = 0;
  std::size_t differing = 0;  // texts that mean one thing here and another elsewhere: only refused ones
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t seed = i < count / 2 ? i : fresh + i;
    const std::string text = RandomText(seed).text();
    Diagnostics diagnostics;
    const std::string formatted = format_text("t", text, diagnostics);
    if (diagnostics.has_errors()) {
      ASSERT_EQ(formatted, text) << "refused, and changed all the same";
      for (const Diagnostic& one : diagnostics.all()) {
        ASSERT_THAT(one.number, ::testing::AnyOf(error::hidden_delay, error::read_after_call)) << one.cause;
      }
      try {
        differing += run_in_any_order(text, seed) != executed(text, seed) ? 1U : 0U;
      } catch (const InputError&) {
        ++differing;  // a loop here, memory elsewhere
      }
      continue;
    }
    ++passed;
    const auto wanted = executed(text, seed);
    ASSERT_EQ(executed(formatted, seed), wanted) << "seed " << seed << ", moved:\n" << text << formatted;
    ASSERT_EQ(run_in_any_order(formatted, seed), wanted) << "seed " << seed << ", here and elsewhere:\n" << text;
  }
  EXPECT_GT(passed, count / 5);
  EXPECT_GT(differing, count / 5) << "else the texts try nothing";
}

std::string with_memory(const std::string& variables, const std::string& statements) {
  return "FUNCTION_BLOCK T (* @ts 1ms *)\nVAR_INPUT X : LREAL; B : BOOL; N : DINT; END_VAR\nVAR_OUTPUT Y : LREAL; "
         "END_VAR\nVAR " +
         variables + " END_VAR\n" + statements + "\nEND_FUNCTION_BLOCK\n";
}

std::vector<Diagnostic> told(const std::string& text) {
  Diagnostics diagnostics;
  check(std::make_shared<const language::SourceFile>(language::parse("t", text, diagnostics)), diagnostics);
  return diagnostics.all();
}

TEST(Formatting, RefusesToMoveAReadAcrossItsAssignmentAndNamesTheDelay) {
  const std::string text = with_memory("LAST : LREAL := 2.5;", "Y := (X - LAST) / 0.001;\nLAST := X;");
  Diagnostics refused;
  EXPECT_EQ(format_text("t", text, refused), text);
  ASSERT_EQ(refused.all().size(), 1U);
  const Diagnostic& one = refused.all().front();
  EXPECT_EQ(one.number, error::hidden_delay);
  EXPECT_EQ(one.severity, Severity::Error);
  EXPECT_THAT(one.mend, HasSubstr("declare LAST_BEFORE : HY_DELAY := (X0 := 2.5); call LAST_BEFORE(XIN := LAST); and "
                                  "read LAST_BEFORE.XOUT here."));
  // The mend as it stands is what an IEC compiler made of the text.
  const std::string mended = with_memory("LAST : LREAL := 2.5; LAST_BEFORE : HY_DELAY := (X0 := 2.5);",
                                         "Y := (X - LAST_BEFORE.XOUT) / 0.001;\nLAST := X;\nLAST_BEFORE(XIN := LAST);");
  EXPECT_THAT(told(mended), ::testing::IsEmpty());
}

TEST(Formatting, NamesTheDelayOfTheTypeThatIsRead) {
  const auto mend = [](const std::string& variables, const std::string& statements) {
    const auto found = told(with_memory(variables, statements));
    return found.size() == 1 && found[0].number == error::hidden_delay ? found[0].mend : "";
  };
  EXPECT_THAT(mend("OLD : BOOL;", "Y := SEL(OLD, X, 0.0); OLD := B;"), HasSubstr("OLD_BEFORE : HY_DELAY_BOOL;"));
  EXPECT_THAT(mend("OLD : DINT := 7;", "Y := DINT_TO_LREAL(OLD); OLD := N;"),
              HasSubstr("OLD_BEFORE : HY_DELAY_DINT := (X0 := 7);"));
  EXPECT_THAT(mend("OLD, W : WORD; Q : HY_QUOTIENT;", "Q(IN1 := X, IN2 := X); W := OLD; OLD := Q.ERRORID; Y := X;"),
              HasSubstr("OLD_BEFORE : HY_DELAY_WORD;"));
  EXPECT_THAT(mend("OLD, OLD_BEFORE : LREAL;", "OLD_BEFORE := X; Y := OLD; OLD := OLD_BEFORE;"),
              HasSubstr("OLD_BEFORE_2 : HY_DELAY;"));
}

TEST(Formatting, TellsAFilterInOneLineAsMemoryAndNotAsALoop) {
  for (const std::string statements : {"F := F + (X - F) * 0.1;\nY := F;", "F := G;\nG := F + X;\nY := G;"}) {
    const auto found = told(with_memory("F, G : LREAL;", statements + (statements[5] == 'F' ? "\nG := X;" : "")));
    ASSERT_EQ(found.size(), 1U) << statements;
    EXPECT_EQ(found[0].number, error::hidden_delay);
    EXPECT_THAT(found[0].mend, HasSubstr("HY_DELAY"));
  }
  const auto itself = told(with_memory("F : LREAL;", "F := F + (X - F) * 0.1;\nY := F;"));
  EXPECT_THAT(itself[0].mend, AllOf(HasSubstr("cannot depend on itself"), Not(HasSubstr("move this statement"))));
}

TEST(Formatting, VariablesInACircleAreMemoryToo) {
  const auto found = told(with_memory("F, G : LREAL;", "F := G;\nG := F;\nY := G + X;"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].number, error::hidden_delay);
}

/// What is told of each line: its number and cause.
std::vector<std::string> told_by_line(const std::string& text) {
  std::vector<std::string> list;
  for (const Diagnostic& one : told(text)) {
    list.push_back(fmt::format("{} HY{} {}", one.place.line, one.number, one.cause));
  }
  return list;
}

/// Statement by statement: one line is memory, a circle of calls elsewhere is a loop.
TEST(Formatting, MemoryIsToldBesideALoop) {
  const std::string loop = "S(IN1 := X, IN2 := P.XOUT);\nP(XIN := S.XOUT);\nY := P.XOUT + F;";
  const std::string names = "F : LREAL; G : LREAL := 0.0; S : HY_SUM; P : HY_GAIN;";
  using ::testing::ElementsAre;
  const auto is_loop = AllOf(HasSubstr("HY401"), HasSubstr("P → S → P"));
  EXPECT_THAT(told_by_line(with_memory(names, "F := F + (X - F) * 0.1;\n" + loop)),
              ElementsAre(HasSubstr("5 HY402 hidden delay: F is read"), is_loop));
  EXPECT_THAT(
      told_by_line(with_memory(names, loop + "\nF := F + (X - F) * 0.1;")),
      ElementsAre(is_loop, HasSubstr("7 HY402 hidden delay: F is read"), HasSubstr("8 HY402 hidden delay: F is read")));
  EXPECT_THAT(told_by_line(with_memory(names, "F := G;\nG := F * 0.5;\n" + loop)),
              ElementsAre(HasSubstr("5 HY402 hidden delay: G is read"), is_loop));
  // The loop itself goes on through a filter that remembers, and through one that does not.
  EXPECT_THAT(told_by_line(with_memory(names,
                                       "S(IN1 := X, IN2 := F);\nP(XIN := S.XOUT);\nF := F * 0.9 + P.XOUT;\n"
                                       "Y := F;")),
              ElementsAre(HasSubstr("5 HY402 hidden delay: F is read"), HasSubstr("7 HY402 hidden delay: F is read")));
  EXPECT_THAT(
      told_by_line(with_memory(names,
                               "G := P.XOUT;\nF := F + (G - F) * 0.1;\nS(IN1 := F, IN2 := G);\n"
                               "P(XIN := S.XOUT);\nY := F;")),
      ElementsAre(HasSubstr("6 HY402 hidden delay: F is read"), HasSubstr("7 HY401 algebraic loop: F → S → P → F")));
  // An output that is read too early beside the loop is told; those in the loop are not, since the loop decides there.
  EXPECT_THAT(told_by_line(with_memory(names + " A : HY_GAIN;", "F := A.XOUT;\nA(XIN := X);\n" + loop)),
              ElementsAre(HasSubstr("5 HY402 hidden delay: A.XOUT is read"), is_loop));
}

TEST(Formatting, TheMendOfACircleMovesNothing) {
  const auto found = told(with_memory("F, G : LREAL;", "F := G;\nG := F + X;\nY := G;"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].mend, AllOf(HasSubstr("cannot depend on itself"), Not(HasSubstr("move this statement"))));
}

/// The order means nothing there, so that nothing could be remembered.
TEST(Formatting, InAnyOrderALoopIsALoop) {
  const std::string text = with_memory("F : LREAL;", "F := F + (X - F) * 0.1;\nY := F;");
  try {
    (void)compile_text(text, {.any_order = true});
    FAIL() << "compiled";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().front().number, error::algebraic_loop);
  }
}

TEST(Formatting, SortsWhereTheOrderMeansNothingAndSaysWhatItMoved) {
  const std::string text = with_memory("A : HY_GAIN;", "Y := A.XOUT;\nA(XIN := X);");
  Diagnostics moved;
  const std::string sorted = format_text("t", text, moved, {.any_order = true});
  EXPECT_FALSE(moved.has_errors());
  ASSERT_EQ(moved.all().size(), 1U);
  EXPECT_EQ(moved.all().front().number, error::hidden_delay);
  EXPECT_LT(sorted.find("A(XIN"), sorted.find("Y := A"));
  EXPECT_THAT(told(sorted), ::testing::IsEmpty());
}

/// Of a block of one's own an IEC compiler has last cycle's outputs before the call, also where a delay is inside.
TEST(Formatting, OutputsOfOwnBlocksAreReadBehindTheirCalls) {
  const std::string inner =
      "FUNCTION_BLOCK P VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT V : LREAL; END_VAR VAR Z : HY_DELAY; END_VAR V := "
      "Z.XOUT; Z(XIN := U); END_FUNCTION_BLOCK\n";
  const auto before = told(inner + with_memory("I : P;", "Y := I.V;\nI(U := X);"));
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0].number, error::read_after_call);
  EXPECT_THAT(before[0].cause, HasSubstr("is read before its call"));
  EXPECT_EQ(before[0].severity, Severity::Warning);
  EXPECT_THAT(told(inner + with_memory("I : P;", "I(U := X);\nY := I.V;")), ::testing::IsEmpty());
}

}  // namespace
}  // namespace hysteron::testing
