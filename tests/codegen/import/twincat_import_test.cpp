// TwinCAT's own files: what they hold, with all that it names, as one text that compiles; and what is refused by name.
#include "codegen/import/twincat_import.hpp"

#include <gmock/gmock.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "codegen/compile.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string object(const std::string& kind, const std::string& name, const std::string& declaration,
                   const std::string& more = "") {
  return "\xEF\xBB\xBF<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n<TcPlcObject Version=\"1.1.0.1\">\r\n  <" + kind +
         " Name=\"" + name + "\" Id=\"{0}\">\r\n    <Declaration><![CDATA[" + declaration + "]]></Declaration>\r\n" +
         more + "  </" + kind + ">\r\n</TcPlcObject>\r\n";
}

std::string in_st(const std::string& statements) {
  return "    <Implementation>\r\n      <ST><![CDATA[" + statements + "]]></ST>\r\n    </Implementation>\r\n";
}

const std::string ramp_block =
    object("POU", "FB_Ramp",
           "// FUNCTION_BLOCK of a comment\r\n{attribute 'x'}\r\nFUNCTION_BLOCK PUBLIC "
           "FB_Ramp\r\nVAR_INPUT\r\n\tTarget : LREAL;\r\n"
           "\tMode : E_MODE;\r\nEND_VAR\r\nVAR_OUTPUT\r\n\tValue : LREAL;\r\nEND_VAR\r\nVAR\r\n\tSettings : "
           "ST_Ramp;\r\nEND_VAR\r\n",
           in_st("IF Mode = E_Mode.Run THEN\r\n\tValue := Value + F_Clamp(Target - Value, Settings.Step);\r\nEND_IF"));

const std::map<std::string, std::string> ramp_project{
    {"FB_RAMP", ramp_block},
    {"ST_RAMP",
     object("DUT", "ST_Ramp", "TYPE ST_Ramp :\r\nSTRUCT\r\n\tStep : LREAL := 0.5;\r\nEND_STRUCT\r\nEND_TYPE\r\n")},
    {"E_MODE", object("DUT", "E_Mode", "TYPE E_Mode : (Hold, Run); END_TYPE")},
    {"F_CLAMP", object("POU", "F_Clamp", "FUNCTION F_Clamp : LREAL\r\nVAR_INPUT\r\n\tX, Most : LREAL;\r\nEND_VAR\r\n",
                       in_st("F_Clamp := LIMIT(-Most, X, Most);"))},
    {"FB_UNUSED", object("POU", "FB_Unused", "FUNCTION_BLOCK FB_Unused\r\n", in_st(";"))},
};

std::string imported(const std::string& text, const std::map<std::string, std::string>& project) {
  return import_twincat({.path = "FB.TcPOU", .text = text},
                        [&](std::string_view name) -> std::optional<ProjectFile> {
                          const auto found = project.find(in_capitals(name));
                          return found == project.end()
                                     ? std::nullopt
                                     : std::optional(ProjectFile{.path = found->first, .text = found->second});
                        },
                        {.cycle = "10ms"});
}

Diagnostics refusal_of(const std::string& text) {
  try {
    (void)imported(text, ramp_project);
  } catch (const InputError& error) {
    return error.diagnostics();
  }
  return {};
}

TEST(TwincatImport, ABlockComesWithAllThatItNamesAndCompiles) {
  ASSERT_TRUE(is_twincat_object(ramp_block));
  const std::string text = imported(ramp_block, ramp_project);
  EXPECT_THAT(text, HasSubstr("FUNCTION_BLOCK PUBLIC FB_Ramp (* @ts 10ms @body *)"));
  EXPECT_THAT(text, Not(HasSubstr("FB_Unused")));
  EXPECT_THAT(text, Not(HasSubstr("\r")));
  EXPECT_LT(text.find("TYPE ST_Ramp"), text.find("FUNCTION_BLOCK PUBLIC"));
  EXPECT_EQ(text.find("TYPE E_Mode"), text.rfind("TYPE E_Mode")) << "each once";
  const Program program = compile_text(text);
  EXPECT_EQ(program.graph.name, "FB_Ramp");
  EXPECT_EQ(program.graph.sample_time_ns, 10'000'000);
  ASSERT_EQ(program.graph.outputs.size(), 1U);
}

/// What generate --structured wrote says already that its text is a body, and how often it runs.
TEST(TwincatImport, AnnotationsOfATextOfOurOwnAreSaidOnce) {
  const auto block = [](const std::string& head) {
    return imported(
        object("POU", "OWN",
               "(* generated *)\r\nFUNCTION_BLOCK OWN" + head + "\r\nVAR_OUTPUT\r\n\tN : DINT;\r\nEND_VAR\r\n",
               in_st("N := N + 1;")),
        {});
  };
  EXPECT_THAT(block("  (* @body @ts 100000000ns *)"), HasSubstr("FUNCTION_BLOCK OWN (* @ts 10ms @body *)\n"));
  EXPECT_THAT(block(" (* @body @doc counts *)"), HasSubstr("FUNCTION_BLOCK OWN (* @ts 10ms @body @doc counts *)\n"));
  EXPECT_THAT(block(" (* counts *)"), HasSubstr("FUNCTION_BLOCK OWN (* @ts 10ms @body *) (* counts *)\n"));
  EXPECT_EQ(compile_text(block("  (* @body @ts 100000000ns *)")).graph.sample_time_ns, 10'000'000);
}

/// Of a list come the variables that are named, and what these name.
TEST(TwincatImport, GlobalVariablesComeWithTheBlock) {
  const std::string list = object(
      "GVL", "GVL_Axis",
      "{attribute 'qualified_only'}\r\nVAR_GLOBAL CONSTANT\r\n\tMost : LREAL := 2.0 * GVL_Axis.Half; // mm\r\n\tHalf "
      ": LREAL := 4.0;\r\nEND_VAR\r\nVAR_GLOBAL\r\n\tName : STRING;\r\n\tA, Count : DINT;\r\nEND_VAR\r\n");
  const auto block = [](const std::string& more, const std::string& statements) {
    return object("POU", "FB_X",
                  "FUNCTION_BLOCK FB_X\r\nVAR_OUTPUT\r\n\tY : LREAL;\r\n\tN : DINT;\r\n" + more + "END_VAR\r\n",
                  in_st(statements));
  };
  const std::map<std::string, std::string> project{{"GVL_AXIS", list}};
  const std::string text = imported(
      block("",
            "Y := gvl_axis.Most; // GVL_Axis.Most\r\nGVL_Axis.Count := GVL_Axis.Count + 1;\r\nN := GVL_Axis.Count;"),
      project);
  EXPECT_THAT(text, HasSubstr("VAR_GLOBAL CONSTANT\n  Most : LREAL := 2.0 * Half; // mm\nEND_VAR"));
  EXPECT_THAT(text, HasSubstr("Y := Most; // GVL_Axis.Most\nCount := Count + 1;"));
  EXPECT_THAT(text, Not(HasSubstr("STRING")));
  EXPECT_EQ(compile_text(text).graph.outputs.size(), 2U);
  try {
    (void)imported(block("\tMost : LREAL;\r\n", "Y := GVL_Axis.Most; N := 1;"), project);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().at(0).cause, "GVL_Axis.Most has the name of another variable of FB_X");
  }
}

TEST(TwincatImport, WhatADiagramCannotExpressIsNamed) {
  const std::string declaration = "FUNCTION_BLOCK FB_X\r\nVAR_OUTPUT\r\n\tY : LREAL;\r\nEND_VAR\r\n";
  const Diagnostics methods = refusal_of(
      object("POU", "FB_X", declaration,
             in_st("Y := 1.0;") +
                 "    <Method Name=\"Reset\" Id=\"{1}\"></Method>\r\n    <Action Name=\"A_Init\"></Action>\r\n"));
  ASSERT_EQ(methods.all().size(), 2U);
  EXPECT_EQ(methods.all()[0].number, error::untranslatable_element);
  EXPECT_EQ(methods.all()[0].cause, "FB_X has the METHOD Reset");
  EXPECT_EQ(methods.all()[0].place.line, 12U);
  EXPECT_EQ(methods.all()[1].cause, "FB_X has the ACTION A_Init");
  const auto cause = [&](const std::string& text) { return refusal_of(text).all().at(0).cause; };
  EXPECT_EQ(cause(object("POU", "FB_X", declaration, "<Implementation><CFC/></Implementation>")),
            "the body of FB_X is written in CFC");
  EXPECT_EQ(cause(object("POU", "MAIN", "PROGRAM MAIN\r\n", in_st(";"))), "MAIN is a PROGRAM");
  EXPECT_EQ(cause(object("GVL", "GVL_Main", "VAR_GLOBAL\r\nEND_VAR")), "GVL_Main is a list of global variables");
  const Diagnostics cut = refusal_of("<TcPlcObject><POU Name=\"X\">");
  ASSERT_EQ(cut.all().size(), 1U);
  EXPECT_EQ(cut.all()[0].number, error::not_plcopen);
}

}  // namespace
}  // namespace hysteron::testing
