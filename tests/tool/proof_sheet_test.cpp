// hysteron generate --proof: what the sheet tells, and that it is the same each time.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/sha256.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::string_view filtered = R"(FUNCTION_BLOCK FILTERED  (* @ts 1ms *)
  VAR_INPUT
    X : LREAL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    LAG : HY_LAG := (T1 := 0.02);
  END_VAR

  LAG(XIN := X);
  Y := LAG.XOUT;
END_FUNCTION_BLOCK
)";

TEST(ProofSheet, TellsWhatTheFilesAreMadeOf) {
  const test::Workbench bench;
  bench.write("it's.st", filtered);
  bench.write("p.toml", "[parameters.LAG]\nT1 = 0.05\n");
  const auto outcome = bench.shell("hysteron generate \"it's.st\" --target st --params p.toml --proof --out made");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("made/filtered.st.proof.json\n"));
  const std::string text = bench.read("made/filtered.st.proof.json");
  const auto sheet = nlohmann::json::parse(text);
  EXPECT_EQ(sheet["source"]["sha256"], sha256(filtered));
  EXPECT_EQ(sheet["parameters"]["sha256"], sha256(bench.read("p.toml")));
  EXPECT_EQ(sheet["files"][0]["sha256"], sha256(bench.read("made/filtered.st")));
  EXPECT_EQ(sheet["schedule"][0]["type"], "HY_LAG");
  EXPECT_GT(sheet["state_bytes"], 8);
  EXPECT_GT(sheet["operations_per_step"], 2);
  EXPECT_EQ(sheet["equality"]["bits"], "equal");
  EXPECT_EQ(sheet["equality"]["steps"], 2000);
  EXPECT_EQ(sheet["command"], R"(hysteron generate 'it'\''s.st' --target st --params p.toml --proof --out DIR)");
  const auto again = bench.shell("hysteron generate \"it's.st\" --target st --params p.toml --proof --out made");
  EXPECT_EQ(again.code, 0) << "its own sheet is not someone else's: " << again.err;
  EXPECT_EQ(bench.read("made/filtered.st.proof.json"), text);
}

TEST(ProofSheet, ThePageSaysWhatTheSheetSays) {
  const test::Workbench bench;
  bench.write("f.st", filtered);
  const auto outcome = bench.shell("hysteron generate f.st --target c --proof --out made");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("made/filtered.c.proof.html\n"));
  const auto sheet = nlohmann::json::parse(bench.read("made/filtered.c.proof.json"));
  const std::string page = bench.read("made/filtered.c.proof.html");
  EXPECT_THAT(page, HasSubstr("Equal bits in all 2000 steps, at 1 output."));
  EXPECT_THAT(page, HasSubstr(sheet["source"]["sha256"].get<std::string>()));
  for (const auto& file : sheet["files"]) {
    EXPECT_THAT(page, HasSubstr(file["sha256"].get<std::string>()));
  }
  EXPECT_THAT(page, HasSubstr(sheet["command"].get<std::string>()));
  ASSERT_TRUE(sheet["stack_bytes"].is_object()) << "GCC and Clang both tell it";
  EXPECT_GT(sheet["stack_bytes"]["bytes"], 0);
  EXPECT_THAT(page, HasSubstr(sheet["stack_bytes"]["bytes"].dump() + " bytes at most"));
  EXPECT_THAT(page, HasSubstr("<td>LAG</td><td>HY_LAG</td>"));
  EXPECT_THAT(page, HasSubstr("signature"));
  EXPECT_THAT(page, Not(HasSubstr("src="))) << "nothing is loaded";
}

TEST(ProofSheet, APageOfHysteronMayBeWrittenAnew) {
  const test::Workbench bench;
  bench.write("f.st", filtered);
  ASSERT_EQ(bench.shell("hysteron generate f.st --target st --proof --out made").code, 0);
  bench.write("f.st", std::string(filtered) + "(* another hash *)\n");
  const auto again = bench.shell("hysteron generate f.st --target st --proof --out made");
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST(ProofSheet, VectorsOfEveryTypeHaveEqualBitsInEveryTarget) {
  const test::Workbench bench;
  bench.write("types.st", R"(FUNCTION_BLOCK TYPES  (* @ts 1ms *)
  VAR_INPUT
    R : ARRAY[0..2] OF LREAL;
    N : ARRAY[0..2] OF DINT;
    W : ARRAY[0..2] OF WORD;
    B : ARRAY[0..2] OF BOOL;
  END_VAR
  VAR_OUTPUT
    YR : ARRAY[0..2] OF LREAL;
    YN : ARRAY[0..2] OF DINT;
    YW : ARRAY[0..2] OF WORD;
    YB : ARRAY[0..2] OF BOOL;
  END_VAR

  YR := R * 2.0;
  YN := N + 1;
  YW := W AND 16#F0;
  YB := NOT B;
END_FUNCTION_BLOCK
)");
  for (const std::string option : {"", " --float32"}) {
    const auto outcome = bench.shell("hysteron generate types.st --target all --out made" + option);
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  }
}

TEST(ProofSheet, OfADialectThatIsNotReadBackProvesThePortableText) {
  const test::Workbench bench;
  bench.write("f.st", filtered);
  const auto outcome =
      bench.shell("hysteron generate f.st --target st --dialect twincat --structured --proof --out made");
  ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  const auto sheet = nlohmann::json::parse(bench.read("made/filtered.st.proof.json"));
  EXPECT_EQ(sheet["equality"]["run"], "read back, in the portable dialect");
  EXPECT_EQ(sheet["files"].size(), 2U) << "the diagram and HY_LAG";
}

TEST(ProofSheet, AHostHasNone) {
  const test::Workbench bench;
  bench.write("f.st", filtered);
  const auto outcome = bench.shell("hysteron generate f.st --host --config r.toml --proof --out made");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no proof sheet"));
}

}  // namespace
}  // namespace hysteron
