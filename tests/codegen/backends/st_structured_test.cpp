// The library in Structured Text, and diagrams as calls of it: names, convention of memory, what is refused.
#include "codegen/backends/st/st.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "codegen/backends/st/library_block.hpp"
#include "codegen/backends/st/words.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/parameters/apply.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string structured(const std::string& diagram, std::string_view dialect = "portable") {
  return generate_st_structured(compile_text(diagram, {.any_order = true}), {.dialect = *st_dialect(dialect)})
      .front()
      .text;
}

/// A delay whose output is read before its call, and one whose reset is wired.
constexpr std::string_view two_delays =
    "FUNCTION_BLOCK LOOP (* @ts 1ms *) VAR_INPUT X : LREAL; CLEAR : BOOL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
    "VAR LAST : HY_DELAY := (X0 := 2.5); HELD : HY_DELAY; END_VAR\n"
    "HELD(XIN := X, R1 := CLEAR); Y := 0.5 * LAST.XOUT + HELD.XOUT; LAST(XIN := Y + X); END_FUNCTION_BLOCK";

TEST(StStructured, ADelayIsReadBeforeItsCallAndBehindItWhereItsResetIsWired) {
  const std::string text = structured(std::string(two_delays));
  EXPECT_THAT(text, HasSubstr("    HELD : HY_DELAY_NOW;\n    LAST : HY_DELAY := (X0 := 2.5);\n"));
  EXPECT_THAT(text, HasSubstr("  HELD(XIN := X, R1 := CLEAR, RESET := FALSE);\n"));
  EXPECT_LT(text.find("0.5 * LAST.XOUT + HELD.XOUT;"), text.find("  LAST(XIN := ")) << text;
  EXPECT_THAT(text, HasSubstr("    LAST(RESET := TRUE);\n")) << "the first value of LAST.XOUT is X0";
}

TEST(StStructured, ReadBackHasTheFirstValueAndThatAfterAReset) {
  const Program diagram = compile_text(std::string(two_delays));
  const Program again = compile_text(structured(std::string(two_delays)), {.top = "LOOP"});
  Machine<double> wanted(diagram);
  Machine<double> got(again);
  for (int k = 0; k < 12; ++k) {
    const double x = 0.3 * k - 1.0;
    if (k == 7) {
      wanted.reset();
    }
    for (Machine<double>* one : {&wanted, &got}) {
      one->set_input(0, x);
      one->set_input(1, k % 4 == 3 ? 1.0 : 0.0);
    }
    got.set_input(2, k == 7 ? 1.0 : 0.0);
    wanted.step();
    got.step();
    EXPECT_EQ(wanted.output(0), got.output(0)) << "step " << k;
  }
}

TEST(StStructured, MemoryThatIsReadBehindItsCallIsCopiedFirst) {
  const std::string text = structured(
      "FUNCTION_BLOCK TWO (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "VAR A, B : HY_DELAY; END_VAR A(XIN := B.XOUT + X); B(XIN := A.XOUT); Y := A.XOUT - B.XOUT; END_FUNCTION_BLOCK");
  EXPECT_THAT(text, HasSubstr("A_XOUT := A.XOUT;"));
  EXPECT_THAT(text, HasSubstr("B(XIN := A_XOUT, RESET := FALSE);"));
}

TEST(StStructured, ASlowerPartIsCalledInItsSteps) {
  const std::string text = structured(
      "FUNCTION_BLOCK RATES (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "VAR S : HY_SAMPLE; (* @every 4 @phase 1 *) L : HY_LAG := (T1 := 0.02); (* @every 4 @phase 1 *) H : HY_HOLD;\n"
      "END_VAR S(XIN := X); L(XIN := S.XOUT); H(XIN := L.XOUT); Y := H.XOUT; END_FUNCTION_BLOCK");
  EXPECT_THAT(text, HasSubstr("L : HY_LAG := (T1 := 0.02, TS := 0.004);"));
  EXPECT_THAT(text, HasSubstr("  IF STEPS MOD 4 = 1 THEN\n"));
  EXPECT_THAT(text, HasSubstr("L_XOUT := L.XOUT;"));
}

TEST(StStructured, WhatSingleCallsCannotComputeIsRefused) {
  const auto number_of = [](const std::string& text) {
    try {
      structured(text);
    } catch (const InputError& error) {
      return error.diagnostics().all().front().number;
    }
    return 0;
  };
  // P of HY_MEM depends on R1 alone, and XIN is computed from it.
  EXPECT_EQ(number_of("FUNCTION_BLOCK M (* @ts 1ms *) VAR_INPUT X : LREAL; B : BOOL; END_VAR VAR_OUTPUT Y : LREAL; "
                      "END_VAR VAR E : HY_MEM; END_VAR E(XIN := X + E.P, R1 := B); Y := E.XOUT; END_FUNCTION_BLOCK"),
            error::no_network);
  Program program = compile_text(std::string(two_delays));
  parameters::apply(parameters::parse_parameter_file("p.toml", "[initial.Last]\nx1 = 2.5\n"), program.graph);
  EXPECT_THROW(generate_st_structured(program, {.dialect = *st_dialect("portable")}), InputError);
}

TEST(StStructured, EveryPinOfTheCatalogueKeepsItsNameInThePortableLibrary) {
  const auto portable = *st_dialect("portable");
  for (const BlockType& type : block_types()) {
    const StPou pou = library_pou(type, 1'000'000, {.dialect = portable, .library = true});
    std::set<std::string> names;
    for (const StSection& section : pou.sections) {
      for (const StVariable& one : section.variables) {
        EXPECT_TRUE(names.insert(one.name).second) << type.about.name << "." << one.name << " is declared twice";
      }
    }
    for (std::size_t pin = 0; pin < type.pin_count(); ++pin) {
      EXPECT_TRUE(names.contains(std::string(type.pin(pin).name))) << type.about.name << "." << type.pin(pin).name;
      EXPECT_NE(type.pin(pin).name, "RESET") << "it is the input of every block with memory";
    }
    for (const Field& output : type.outputs) {
      EXPECT_TRUE(names.contains(std::string(output.name))) << type.about.name << "." << output.name;
    }
  }
  EXPECT_EQ(st_pin_name("REFERENCE", *st_dialect("codesys")), "REFERENCE_2");
  EXPECT_EQ(st_pin_name("R", *st_dialect("twincat")), "R") << "the standard's own SR has it";
}

TEST(StStructured, DialectsThatWantAFileForEachBlockGetOne) {
  const Program program = compile_text(std::string(two_delays));
  const auto files = generate_st_structured(program, {.dialect = *st_dialect("twincat")});
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].name, "loop.TcPOU");
  EXPECT_EQ(files[1].name, "hy_delay.TcPOU");
  EXPECT_EQ(files[2].name, "hy_delay_now.TcPOU");
  EXPECT_EQ(generate_st_structured(program, {.dialect = *st_dialect("siemens-scl")}).size(), 1U);
  EXPECT_THAT(structured(std::string(two_delays), "siemens-scl"), HasSubstr("#HELD(XIN := #X, R1 := #CLEAR"));
}

TEST(StStructured, TheLibraryIsWholeAndTheSameEachTime) {
  const auto files = generate_st_library(1'000'000, {.dialect = *st_dialect("portable")});
  ASSERT_EQ(files.size(), 1U);
  for (const BlockType& type : block_types()) {
    EXPECT_THAT(files[0].text, HasSubstr(fmt::format("FUNCTION_BLOCK {}  (* @body *)\n", type.about.name)));
  }
  EXPECT_THAT(files[0].text, Not(HasSubstr("CORE")));
  EXPECT_EQ(files[0].text, generate_st_library(1'000'000, {.dialect = *st_dialect("portable")})[0].text);
}

/// The library's names belong to the library, unless the whole text is executed from top to bottom.
TEST(StStructured, ADiagramCannotBringABlockOfTheLibraryAlong) {
  const std::string gain =
      "FUNCTION_BLOCK HY_GAIN (* @body *) VAR_INPUT XIN : LREAL; END_VAR VAR_OUTPUT XOUT : LREAL; END_VAR\n"
      "XOUT := 7.0 * XIN; END_FUNCTION_BLOCK\n";
  const auto user = [](std::string_view mark) {
    return fmt::format(
        "FUNCTION_BLOCK D (* @ts 1ms {} *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : HY_GAIN; "
        "END_VAR G(XIN := X); Y := G.XOUT; END_FUNCTION_BLOCK",
        mark);
  };
  EXPECT_THROW(compile_text(gain + user("")), InputError);
  Machine<double> machine(compile_text(gain + user("@body")));
  machine.set_input(0, 2.0);
  machine.step();
  EXPECT_EQ(machine.output(0), 14.0) << "the text's own block is meant";
}

}  // namespace
}  // namespace hysteron::testing
