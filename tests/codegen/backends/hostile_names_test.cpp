// Names that mean something in a target or beside it: each as a block, an input, an output, a variable, a parameter and
// an instance, of a diagram and of a sequential body. Either the language refuses it, with a mend, or every target
// keeps its file compiling and readable.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "codegen/backends/c/c.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/fmu/fmu.hpp"
#include "codegen/backends/plcopen/plcopen.hpp"
#include "codegen/backends/st/st.hpp"
#include "codegen/import/plcopen_import.hpp"
#include "tests/codegen/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

/// Words of C and C++, of their libraries and macros, of generated files, of IEC 61131-3 and of PLCs' own languages.
const std::vector<std::string> hostile_names{"int",
                                             "double",
                                             "float",
                                             "main",
                                             "inline",
                                             "restrict",
                                             "register",
                                             "volatile",
                                             "static",
                                             "struct",
                                             "union",
                                             "auto",
                                             "bool",
                                             "true_",
                                             "class",
                                             "template",
                                             "namespace",
                                             "this",
                                             "operator",
                                             "new",
                                             "delete",
                                             "private",
                                             "virtual",
                                             "NULL",
                                             "EOF",
                                             "errno",
                                             "INFINITY",
                                             "NAN",
                                             "HUGE_VAL",
                                             "EDOM",
                                             "assert",
                                             "stdin",
                                             "stdout",
                                             "M_PI",
                                             "isnan",
                                             "fabs",
                                             "_Bool",
                                             "_Complex",
                                             "_Static_assert",
                                             "__LINE__",
                                             "linux",
                                             "unix",
                                             "i386",
                                             "signals",
                                             "complex",
                                             "I",
                                             "near",
                                             "far",
                                             "and",
                                             "or",
                                             "not",
                                             "xor",
                                             "mod",
                                             "and_eq",
                                             "bitand",
                                             "compl",
                                             "ref",
                                             "exp",
                                             "step",
                                             "action",
                                             "transition",
                                             "sin",
                                             "len",
                                             "left",
                                             "mid",
                                             "time",
                                             "date",
                                             "tod",
                                             "ton",
                                             "sr",
                                             "en",
                                             "eno",
                                             "at",
                                             "of",
                                             "task",
                                             "with",
                                             "resource",
                                             "params",
                                             "state",
                                             "in",
                                             "out",
                                             "self",
                                             "me",
                                             "reset",
                                             "started",
                                             "ts",
                                             "largest",
                                             "place",
                                             "defaults",
                                             "real",
                                             "real_max",
                                             "select",
                                             "select_2",
                                             "steps",
                                             "size_t",
                                             "int32_t",
                                             "uint16_t",
                                             "j0",
                                             "y1",
                                             "index",
                                             "div",
                                             "time_t",
                                             "TEMP",
                                             "INSTANCE",
                                             "super",
                                             "program",
                                             "end_if",
                                             "pointer",
                                             "string",
                                             "S",
                                             "R",
                                             "N",
                                             "P",
                                             "L",
                                             "D",
                                             "SD",
                                             "DS",
                                             "fmi3instance",
                                             "fmi2real",
                                             "model",
                                             "component",
                                             "value",
                                             "values",
                                             "set",
                                             "get",
                                             "host",
                                             "previous",
                                             "last"};

std::string diagram_of(const std::string& name) {
  return fmt::format(
      "FUNCTION_BLOCK {0} (* @ts 1ms *) VAR_INPUT X : LREAL; {0}_IN : LREAL; END_VAR VAR_OUTPUT Y, {0}_OUT : LREAL; "
      "END_VAR\n"
      "VAR G : HY_GAIN := (K := 2.0); {0}_L : HY_LAG := (T1 := 0.1); END_VAR\n"
      "G(XIN := X); {0}_L(XIN := {0}_IN); Y := G.XOUT; {0}_OUT := {0}_L.XOUT; END_FUNCTION_BLOCK\n",
      name);
}

enum class Role : std::uint8_t { Input, Parameter, Output, Instance, Variable, BodyInput, BodyOutput, Memory };

/// A block where each of the names is one thing.
std::string block_with(Role role, const std::vector<std::string>& names) {
  std::string inputs = "X : LREAL;";
  std::string outputs = "Y_ALL : LREAL;";
  std::string locals;
  std::string statements;
  std::string sum = "X";
  for (const std::string& name : names) {
    switch (role) {
      case Role::Input:
      case Role::Parameter:
        inputs += fmt::format(" {} : LREAL := 2.0; {}\n", name, role == Role::Parameter ? "(* @param *)" : "");
        break;
      case Role::BodyInput:
        inputs += fmt::format(" {} : REAL;\n", name);
        break;
      case Role::Output:
      case Role::BodyOutput:
        outputs += fmt::format(" {} : {};\n", name, role == Role::Output ? "LREAL" : "INT");
        statements += role == Role::Output ? fmt::format("{} := X;\n", name)
                                           : fmt::format("IF X > 1.0 THEN {0} := {0} + 1; END_IF;\n", name);
        break;
      case Role::Instance:
        locals += fmt::format(" {} : HY_LAG := (T1 := 0.1);\n", name);
        statements += fmt::format("{}(XIN := X);\n", name);
        break;
      case Role::Variable:
        locals += fmt::format(" {} : LREAL;\n", name);
        statements += fmt::format("{} := X * {}.0;\n", name, &name - names.data());
        break;
      case Role::Memory:
        locals += fmt::format(" {} : UINT;\n", name);
        statements += fmt::format("IF X > 1.0 THEN {0} := {0} + 1; END_IF;\n", name);
    }
    sum += role == Role::Instance                             ? fmt::format(" + {}.XOUT", name)
           : role == Role::Memory                             ? fmt::format(" + UINT_TO_LREAL({})", name)
           : role == Role::Output || role == Role::BodyOutput ? ""
                                                              : fmt::format(" + {}", name);
  }
  return fmt::format(
      "FUNCTION_BLOCK ROLE_{} (* @ts 1ms *)\nVAR_INPUT {} END_VAR\nVAR_OUTPUT {} END_VAR\nVAR {} END_VAR\n{}Y_ALL := "
      "{};\nEND_FUNCTION_BLOCK\n",
      static_cast<int>(role), inputs, outputs, locals, statements, sum);
}

/// Of the names that the language refuses, the error has a mend.
bool is_taken(const std::string& text) {
  const auto refused = refusals(text);
  EXPECT_TRUE(refused.empty() || !refused.front().mend.empty()) << text;
  return refused.empty();
}

std::vector<std::string> texts_of_hostile_names() {
  std::vector<std::string> texts;
  for (const std::string& name : hostile_names) {
    if (const std::string text = diagram_of(name); is_taken(text)) {
      texts.push_back(text);
    }
  }
  for (int role = 0; role <= static_cast<int>(Role::Memory); ++role) {
    std::vector<std::string> names;
    for (const std::string& name : hostile_names) {
      if (is_taken(block_with(static_cast<Role>(role), {name}))) {
        names.push_back(name);
      }
    }
    EXPECT_GT(names.size(), 80U) << role;
    texts.push_back(block_with(static_cast<Role>(role), names));
  }
  return texts;
}

TEST(HostileNames, CompileInCAndCpp) {
  const test::ScratchFolder folder;
  std::string main =
      "#include <algorithm>\n#include <cmath>\n#include <cstdio>\n#include <cstdlib>\n#include <vector>\n";
  const std::vector<std::string> texts = texts_of_hostile_names();
  ASSERT_GT(texts.size(), 80U);
  for (const std::string& text : texts) {
    const Program program = compile_text(text);
    const GeneratedFile header = generate_cpp_header(program, {});
    folder.write(header.name, header.text);
    main += fmt::format("#include \"{}\"\n", header.name);
    for (const GeneratedFile& file : generate_c(program)) {
      folder.write(file.name, file.text);
    }
  }
  folder.write("main.cpp", main + "int main() {}\n");
  const std::string build = fmt::format(
      "cd {0} && c++ -std=c++11 -fsyntax-only -Wall -Wextra -Werror {1} main.cpp > log 2>&1 && cc -std=c99 -pedantic "
      "-fsyntax-only -Wall -Wextra -Werror {1} *.c >> log 2>&1",
      folder.path().string(), cpp_numeric_flags);
  EXPECT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 3000);
}

TEST(HostileNames, OfAnFmuAreItsVariables) {
  const test::ScratchFolder folder;
  std::string build = "cd " + folder.path().string() + " && rm -f log";
  for (std::size_t i = 0; i < hostile_names.size(); i += 9) {
    const std::string text = diagram_of(hostile_names[i]);
    if (!refusals(text).empty()) {
      continue;
    }
    const FmuContents fmu =
        generate_fmu(compile_text(text), {.version = i % 2 == 0 ? FmiVersion::Three : FmiVersion::Two});
    for (const GeneratedFile& file : fmu.files) {
      std::filesystem::create_directories((folder.path() / std::to_string(i) / file.name).parent_path());
      folder.write(fmt::format("{}/{}", i, file.name), file.text);
    }
    for (const std::string& source : fmu.sources) {
      build +=
          fmt::format(" && cc -std=c99 -fsyntax-only -Wall -Wextra -Werror -Wno-unused-parameter {} {}/{} >> log 2>&1",
                      cpp_numeric_flags, i, source);
    }
    EXPECT_NE(fmu.files[0].text.find(fmt::format("\"{}_IN\"", hostile_names[i])), std::string::npos)
        << fmu.files[0].text;
  }
  EXPECT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 3000);
}

/// Every dialect writes each; what the portable one writes is read back with the pins in their order.
TEST(HostileNames, AreReadBackFromStructuredText) {
  for (const std::string& text : texts_of_hostile_names()) {
    const Program program = compile_text(text);
    for (const char* const name : {"portable", "codesys", "twincat", "siemens-scl"}) {
      const auto files = generate_st(program, {.dialect = *st_dialect(name)});
      ASSERT_FALSE(files.empty());
      if (std::string(name) == "portable") {
        const auto refused = refusals(files[0].text);
        ASSERT_TRUE(refused.empty()) << refused.front().cause << "\n" << files[0].text;
        const Program again = compile_text(files[0].text);
        EXPECT_EQ(again.graph.outputs.size(), program.graph.outputs.size());
        EXPECT_GE(again.graph.inputs.size(), program.graph.inputs.size());
      }
    }
    const auto project = generate_plcopen(program, {});
    Diagnostics warnings;
    const std::string imported = import_plcopen("x.xml", project[0].text, {}, warnings);
    const auto refused = refusals(imported);
    EXPECT_TRUE(refused.empty()) << refused.front().cause << "\n" << imported;
  }
}

}  // namespace
}  // namespace hysteron::testing
