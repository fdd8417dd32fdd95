// The A2L file: its structure, its ranges and units, and its addresses in programs that are really linked: what lies at
// each of them is what the diagram says of the parameter.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// All types, an array, parameters of the diagram and of its blocks, and a block within a block.
constexpr std::string_view calibrated = R"(FUNCTION_BLOCK INNER
  VAR_INPUT
    A : LREAL;
  END_VAR
  VAR_OUTPUT
    B : LREAL;
  END_VAR
  VAR
    LAG : HY_LAG := (T1 := 0.25);
  END_VAR

  LAG(XIN := A);
  B := LAG.XOUT;
END_FUNCTION_BLOCK

FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT
    X    : LREAL;          (* @unit V @min -10 @max 10 @doc what the "sensor" gives *)
    MODE : BOOL := TRUE;   (* @param *)
    GAIN : LREAL := 2.5;   (* @param @min 0 @max 8 @unit um/V *)
    STOP : BOOL;
  END_VAR
  VAR_OUTPUT
    Y    : LREAL;  (* @unit um *)
    FAIL : BOOL;
    CODE : WORD;
  END_VAR
  VAR
    PART : INNER;
    BEND : HY_TABLE := (X := [0.0, 1.5, 4.0], Y := [0.0, 3.25, 5.0], COUNT := 3, EXTRAPOLATE := TRUE);
  END_VAR

  PART(A := X);
  BEND(XIN := PART.B);
  Y := SEL(STOP OR NOT MODE, GAIN * BEND.XOUT, 0.0);
  FAIL := BEND.ERROR;
  CODE := BEND.ERRORID;
END_FUNCTION_BLOCK
)";

/// Prints the bytes at addresses: `d401020` is a double.
constexpr std::string_view peek = R"(
#include <stdio.h>
#include <stdlib.h>
#include <stdint.h>
#include <stdbool.h>
static void show(int count, char **what) {
  for (int i = 1; i < count; ++i) {
    const uintptr_t at = (uintptr_t)strtoull(what[i] + 1, NULL, 16);
    switch (what[i][0]) {
      case 'd': printf("%.17g\n", *(const double *)at); break;
      case 'f': printf("%.17g\n", (double)*(const float *)at); break;
      case 'b': printf("%d\n", *(const bool *)at); break;
      case 'u': printf("%d\n", *(const uint16_t *)at); break;
      default: printf("%d\n", *(const int32_t *)at);
    }
  }
}
)";

struct A2lEntry {
  std::string kind;  ///< CHARACTERISTIC or MEASUREMENT
  std::string type;  ///< d, f, b, u, i: see peek
  std::uint64_t address = 0;
  std::size_t length = 1;
  std::string minimum;
  std::string maximum;
  std::string unit;
  std::string symbol;
};

/// The words of a text in quotes are one.
std::vector<std::string> words_of_a2l(const std::string& text) {
  static const std::regex word(R"re(/\*[\s\S]*?\*/|"(\\.|[^"\\])*"|\S+)re");
  std::vector<std::string> words;
  for (std::sregex_iterator at(text.begin(), text.end(), word); at != std::sregex_iterator(); ++at) {
    if (!at->str().starts_with("/*")) {
      words.push_back(at->str());
    }
  }
  return words;
}

/// Reads the file by its grammar; each /begin has its /end.
std::map<std::string, A2lEntry> read_a2l(const std::string& text) {
  const auto words = words_of_a2l(text);
  std::vector<std::string> open;
  std::map<std::string, A2lEntry> entries;
  std::map<std::string, std::string> units;
  std::map<std::string, std::string> layouts;
  A2lEntry* entry = nullptr;
  const std::map<std::string, std::string> kinds{
      {"FLOAT64_IEEE", "d"}, {"FLOAT32_IEEE", "f"}, {"UBYTE", "b"}, {"UWORD", "u"}, {"SLONG", "i"}};
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "/begin") {
      open.push_back(words.at(++i));
      const std::string& kind = open.back();
      if (kind == "COMPU_METHOD") {
        units[words.at(i + 1)] = words.at(i + 5);
      } else if (kind == "RECORD_LAYOUT") {
        EXPECT_EQ(words.at(i + 2), "FNC_VALUES");
        layouts[words.at(i + 1)] = kinds.at(words.at(i + 4));
      } else if (kind == "CHARACTERISTIC" || kind == "MEASUREMENT") {
        const auto [at, is_new] = entries.try_emplace(words.at(i + 1));
        EXPECT_TRUE(is_new) << words.at(i + 1) << " stands there twice";
        entry = &at->second;
        entry->kind = kind;
        const bool parameter = kind == "CHARACTERISTIC";
        entry->type = parameter ? layouts.at(words.at(i + 5)) : kinds.at(words.at(i + 3));
        entry->unit = units.at(words.at(i + (parameter ? 7 : 4)));
        entry->minimum = words.at(i + (parameter ? 8 : 7));
        entry->maximum = words.at(i + (parameter ? 9 : 8));
        if (parameter) {
          entry->address = std::stoull(words.at(i + 4), nullptr, 16);
        }
      }
    } else if (words[i] == "/end") {
      EXPECT_FALSE(open.empty());
      EXPECT_EQ(words.at(++i), open.back());
      open.pop_back();
      entry = nullptr;
    } else if (entry != nullptr && words[i] == "ECU_ADDRESS") {
      entry->address = std::stoull(words.at(i + 1), nullptr, 16);
    } else if (entry != nullptr && words[i] == "MATRIX_DIM") {
      entry->length = std::stoul(words.at(i + 1));
    } else if (entry != nullptr && words[i] == "SYMBOL_LINK") {
      entry->symbol = words.at(i + 1) + "+" + words.at(i + 2);
    }
  }
  EXPECT_TRUE(open.empty());
  return entries;
}

class A2lFile : public testing::Test {
 protected:
  A2lFile() { bench.write("axis.st", calibrated); }

  test::Outcome generate(const std::string& options = "") const {
    return bench.shell("hysteron generate axis.st --target c --a2l --out made " + options);
  }

  /// Links a program with these declarations; without addresses to print it does nothing.
  void link(const std::string& declarations, const std::string& of_params, const std::string& flags = "") const {
    bench.write("app.c", fmt::format("#include \"made/axis.h\"\n{}{}\nint main(int count, char **what) {{\n"
                                     "  axis_defaults(&{}, &in);\n  axis_reset(&state, &{});\n  in.x = 1.0;\n"
                                     "  for (int k = 0; k < 40; ++k) axis_step(&{}, &state, &in, &out);\n"
                                     "  printf(\"%.17g\\n\", (double)out.y);\n  show(count, what);\n  return 0;\n}}\n",
                                     peek, declarations, of_params, of_params, of_params));
    const auto outcome = bench.shell("cc -no-pie -ffp-contract=off " + flags + " app.c made/axis.c -lm -o app.elf");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  /// The output Y of the program, and behind it what lies at the addresses of these entries, element by element.
  std::vector<double> values_at(const std::map<std::string, A2lEntry>& entries,
                                const std::vector<std::string>& names) const {
    const std::map<std::string, std::size_t> sizes{{"d", 8}, {"f", 4}, {"b", 1}, {"u", 2}, {"i", 4}};
    std::string command = "./app.elf";
    for (const std::string& name : names) {
      const A2lEntry& one = entries.at("AXIS." + name);
      for (std::size_t k = 0; k < one.length; ++k) {
        command += fmt::format(" {}{:x}", one.type, one.address + k * sizes.at(one.type));
      }
    }
    const auto outcome = bench.shell(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    std::vector<double> values;
    for (double value = 0.0; lines >> value;) {
      values.push_back(value);
    }
    return values;
  }

  test::Workbench bench;
};

constexpr std::string_view own_variables =
    "axis_params params;\nstatic axis_state state;\naxis_in in;\naxis_out out;\n";

const std::vector<std::string> parameters_of_axis{"MODE",   "GAIN",   "PART.LAG.T1", "PART.LAG.SETTLED",
                                                  "BEND.X", "BEND.Y", "BEND.COUNT",  "BEND.EXTRAPOLATE"};

/// The parameters of `calibrated`, in this order, as their elements.
std::vector<double> elements_of_axis() {
  std::vector<double> values{1.0, 2.5, 0.25, 1.0};
  std::vector<double> x(32);
  std::vector<double> y(32);
  x[1] = 1.5;
  x[2] = 4.0;
  y[1] = 3.25;
  y[2] = 5.0;
  values.insert(values.end(), x.begin(), x.end());
  values.insert(values.end(), y.begin(), y.end());
  values.insert(values.end(), {3.0, 1.0});
  return values;
}

TEST_F(A2lFile, HoldsEachParameterAndSignalOnceWithItsRangeAndUnit) {
  const auto outcome = generate();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "made/axis.h\nmade/axis.c\nmade/axis.a2l\n");
  const std::string text = bench.read("made/axis.a2l");
  EXPECT_THAT(text, HasSubstr("ASAP2_VERSION 1 60\n"));
  EXPECT_THAT(text, HasSubstr("BYTE_ORDER MSB_LAST"));
  const auto entries = read_a2l(text);
  std::size_t characteristics = 0;
  for (const auto& [name, one] : entries) {
    characteristics += one.kind == "CHARACTERISTIC" ? 1 : 0;
    EXPECT_EQ(one.address < 0x1000, true) << name << " has an address without a program";
  }
  EXPECT_EQ(characteristics, parameters_of_axis.size());
  for (const std::string& name : parameters_of_axis) {
    EXPECT_EQ(entries.at("AXIS." + name).kind, "CHARACTERISTIC") << name;
  }
  for (const std::string name : {"X", "STOP", "Y", "FAIL", "CODE", "BEND.RISING"}) {
    EXPECT_EQ(entries.at("AXIS." + name).kind, "MEASUREMENT") << name;
  }
  const A2lEntry& gain = entries.at("AXIS.GAIN");
  EXPECT_EQ(gain.minimum, "0");
  EXPECT_EQ(gain.maximum, "8");
  EXPECT_EQ(gain.unit, "\"um/V\"");
  EXPECT_EQ(entries.at("AXIS.X").minimum, "-10");
  EXPECT_EQ(entries.at("AXIS.X").unit, "\"V\"");
  EXPECT_EQ(entries.at("AXIS.Y").maximum, "1.7976931348623157e308");
  EXPECT_EQ(entries.at("AXIS.MODE").maximum, "1");
  EXPECT_EQ(entries.at("AXIS.BEND.COUNT").minimum, "2");
  EXPECT_EQ(entries.at("AXIS.BEND.COUNT").maximum, "32");
  EXPECT_EQ(entries.at("AXIS.BEND.X").length, 32U);
  EXPECT_EQ(entries.at("AXIS.CODE").type, "u");
  EXPECT_THAT(text, HasSubstr("MEASUREMENT AXIS.X \"what the \\\"sensor\\\" gives\""));
  EXPECT_EQ(entries.at("AXIS.MODE").symbol.substr(0, 9), "\"params\"+");
}

TEST_F(A2lFile, AtTheAddressesOfALinkedProgramLieTheParameters) {
  for (const std::string option : {"", "--float32"}) {
    ASSERT_EQ(generate(option).code, 0);
    link(std::string(own_variables), "params");
    const auto outcome = generate("--elf app.elf " + option);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto entries = read_a2l(bench.read("made/axis.a2l"));
    std::vector<std::string> names = parameters_of_axis;
    names.insert(names.end(), {"Y", "X", "BEND.RISING"});
    std::vector<double> got = values_at(entries, names);
    std::vector<double> wanted = elements_of_axis();
    ASSERT_EQ(got.size(), 1 + wanted.size() + 3) << option;
    const double output = got.front();
    EXPECT_NE(output, 0.0);
    wanted.insert(wanted.end(), {output, 1.0, 1.0});
    EXPECT_EQ(std::vector<double>(got.begin() + 1, got.end()), wanted) << option;
  }
}

TEST_F(A2lFile, FindsAStructureWithinOneOfTheUser) {
  ASSERT_EQ(generate().code, 0);
  link("axis_state state;\naxis_in in;\naxis_out out;\nstruct { char head[24]; axis_params of_axis; } all;\n",
       "all.of_axis");
  const auto outcome = generate("--elf app.elf --symbol params=all+0x18");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = bench.read("made/axis.a2l");
  EXPECT_THAT(text, HasSubstr("SYMBOL_LINK \"all\" 24\n"));
  const auto got = values_at(read_a2l(text), parameters_of_axis);
  EXPECT_EQ(std::vector<double>(got.begin() + 1, got.end()), elements_of_axis());
  const auto beyond = generate("--elf app.elf --symbol params=all+32");
  EXPECT_EQ(beyond.code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("HY745"));
}

TEST_F(A2lFile, WhatAProgramDoesNotHoldIsToldByName) {
  ASSERT_EQ(generate().code, 0);
  link("axis_params parms;\nstatic axis_state state;\naxis_in in;\nstatic axis_out out;\n", "parms");
  EXPECT_THAT(generate("--elf app.elf").err,
              AllOf(HasSubstr("HY745"), HasSubstr("There is no variable params."), HasSubstr("did you mean parms?")));
  EXPECT_EQ(generate("--elf app.elf --symbol params=parms").code, 0);
  EXPECT_THAT(generate("--elf app.elf --symbol params=parms --float32").err, HasSubstr("bytes, and axis_params has"));
  EXPECT_THAT(generate("--elf app.elf --symbol params=parms --symbol out=results").err,
              HasSubstr("There is no variable results."));
  ASSERT_EQ(bench.shell("objcopy -N out app.elf less.elf").code, 0);
  const auto less = generate("--elf less.elf --symbol params=parms");
  EXPECT_EQ(less.code, 0);
  EXPECT_THAT(less.err, AllOf(HasSubstr("HY745 warning"), HasSubstr("what axis_out holds is left out")));
  const auto entries = read_a2l(bench.read("made/axis.a2l"));
  EXPECT_FALSE(entries.contains("AXIS.Y"));
  EXPECT_TRUE(entries.contains("AXIS.X"));
}

TEST_F(A2lFile, AFileThatIsNoLinkedProgramIsRefused) {
  ASSERT_EQ(generate().code, 0);
  link(std::string(own_variables), "params");
  ASSERT_EQ(bench.shell("cc -c app.c -o app.o && strip -o bare.elf app.elf && objcopy -O binary app.elf app.bin").code,
            0);
  const std::string before = bench.read("made/axis.a2l");
  for (const auto& [file, told] : {std::pair{"app.o", "is an object file"},
                                   {"bare.elf", "has no table of symbols"},
                                   {"app.bin", "is no ELF file"},
                                   {"axis.st", "is no ELF file"}}) {
    const auto outcome = generate(std::string("--elf ") + file);
    EXPECT_EQ(outcome.code, 2) << file;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("HY745"), HasSubstr(told))) << file;
  }
  EXPECT_THAT(generate("--elf nowhere.elf").err, HasSubstr("HY100"));
  // Cut off anywhere, it is refused or read, and nothing else.
  const std::string whole = bench.read("app.elf");
  for (const std::size_t size : {std::size_t{3}, std::size_t{17}, std::size_t{60}, std::size_t{64}, whole.size() / 3,
                                 whole.size() / 2, whole.size() - 100, whole.size() - 1}) {
    bench.write("cut.elf", std::string_view(whole).substr(0, size));
    const auto outcome = generate("--elf cut.elf");
    EXPECT_TRUE(outcome.code == 2 && outcome.err.starts_with("HY745")) << size << outcome.err;
  }
  EXPECT_EQ(bench.read("made/axis.a2l"), before);
}

TEST_F(A2lFile, AVectorIsOneEntryAndOneArray) {
  bench.write("vectors.st", R"(FUNCTION_BLOCK VECTORS  (* @ts 1ms *)
  VAR_INPUT
    ON_1 : BOOL;
    X : ARRAY[0..2] OF LREAL;  (* @unit um @doc three sensors *)
  END_VAR
  VAR_OUTPUT
    Y : ARRAY[0..2] OF LREAL;
  END_VAR

  Y := SEL(ON_1, X, -X);
END_FUNCTION_BLOCK
)");
  const auto outcome = bench.shell("hysteron generate vectors.st --target c --a2l --out arrays");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string header = bench.read("arrays/vectors.h");
  EXPECT_THAT(header, AllOf(HasSubstr("  double x[3];  // [um] three sensors\n"), HasSubstr("  double y[3];\n")));
  EXPECT_THAT(
      bench.read("arrays/vectors.c"),
      HasSubstr("  for (size_t i = 0U; i < 3U; ++i) {\n    out->y[i] = in->on_1 ? (-in->x[i]) : in->x[i];\n  }\n"));
  const std::string a2l = bench.read("arrays/vectors.a2l");
  const auto entry = a2l.find("/begin MEASUREMENT VECTORS.X ");
  ASSERT_NE(entry, std::string::npos);
  EXPECT_THAT(a2l.substr(entry, 400), AllOf(HasSubstr("MATRIX_DIM 3 1 1"), HasSubstr(" 8\n")));  // behind ON_1
}

TEST_F(A2lFile, OptionsThatSayNothingAreRefused) {
  for (const std::string options :
       {"--target c --elf app.elf", "--target c --symbol params=p", "--target cpp --a2l",
        "--target c --a2l --symbol params", "--target c --a2l --symbol all=p", "--target c --a2l --symbol params=p+1k",
        "--target c --a2l --symbol params=p --symbol params=q", "--target c --a2l --symbol params=+4"}) {
    const auto outcome = bench.shell("hysteron generate axis.st --out made " + options);
    EXPECT_EQ(outcome.code, 2) << options;
    EXPECT_THAT(outcome.err, HasSubstr("HY730")) << options;
  }
  EXPECT_FALSE(bench.has("made"));
}

}  // namespace
}  // namespace hysteron
