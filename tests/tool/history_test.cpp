// The history of a served diagram, listed and exported as a user does, and read by what reads records.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/diagnostic.hpp"
#include "tests/support/error_page.hpp"
#include "tests/tool/workbench.hpp"
#include "tool/history_time.hpp"

namespace hysteron {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kept_plant = R"(FUNCTION_BLOCK PLANT  (* @ts 10ms *)
  VAR_INPUT GAIN_IN : LREAL := 1.0;  (* @unit V *) END_VAR
  VAR_OUTPUT
    U : LREAL;  (* @unit V *)
    Y : LREAL;  (* @unit um *)
  END_VAR
  VAR
    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 0.7);
    AMP : HY_GAIN := (K := 2.5);
    LAG : HY_LAG := (T1 := 0.2);
  END_VAR
  WAVE();
  U := GAIN_IN * WAVE.XOUT;
  AMP(XIN := U);
  LAG(XIN := AMP.XOUT);
  Y := LAG.XOUT;
END_FUNCTION_BLOCK
)";
constexpr const char* model = R"(FUNCTION_BLOCK MODEL  (* @ts 10ms *)
  VAR_INPUT U : LREAL;  (* @unit V *) END_VAR
  VAR_OUTPUT Y : LREAL;  (* @unit um *) END_VAR
  VAR AMP : HY_GAIN := (K := 1.0); LAG : HY_LAG := (T1 := 0.1); END_VAR
  AMP(XIN := U);
  LAG(XIN := AMP.XOUT);
  Y := LAG.XOUT;
END_FUNCTION_BLOCK
)";
constexpr const char* kept_run =
    "[outputs.U]\nsafe = 0.0\n[outputs.Y]\nsafe = 0.0\n[history]\nfile = \"history.sqlite\"\nevery = \"10ms\"\n";

class ServedHistory : public testing::Test {
 protected:
  ServedHistory() {
    bench.write("plant.st", kept_plant);
    bench.write("RUN.toml", kept_run);
  }
  void serve(int cycles) const {
    const auto served = bench.shell(
        "hysteron serve plant.st --config RUN.toml --virtual --engine interpreter --cycles " + std::to_string(cycles));
    EXPECT_EQ(served.code, 0) << served.err << served.out;
  }
  test::Workbench bench;
};

TEST_F(ServedHistory, IsListedAsJsonForAProgram) {
  serve(2000);
  serve(500);
  const auto listed = bench.shell("hysteron history history.sqlite --json");
  EXPECT_EQ(listed.code, 0) << listed.err;
  const auto json = nlohmann::json::parse(listed.out);
  EXPECT_EQ(json["file"], "history.sqlite");
  ASSERT_EQ(json["runs"].size(), 2U);
  const auto& first = json["runs"][0];
  EXPECT_EQ(first["run"], 1);
  EXPECT_EQ(first["title"], "PLANT");
  EXPECT_EQ(first["sample_time"], 0.01);
  EXPECT_EQ(first["points"][1]["name"], "U");
  EXPECT_EQ(first["points"][1]["unit"], "V");
  ASSERT_EQ(first["stretches"].size(), 1U);
  EXPECT_EQ(first["stretches"][0]["rows"], 2000);
  EXPECT_EQ(json["runs"][1]["stretches"][0]["rows"], 500);
  EXPECT_EQ(json["clock_steps"], nlohmann::json::array());
  const auto second = bench.shell("hysteron history history.sqlite --run 2 --from 1s --json");
  const auto part = nlohmann::json::parse(second.out);
  ASSERT_EQ(part["runs"].size(), 1U) << "what is asked for alone";
  EXPECT_EQ(part["runs"][0]["stretches"][0]["rows"], 101);
  const auto refused = bench.shell("hysteron history history.sqlite --json --out log.csv");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--out"));
}

TEST_F(ServedHistory, IsExportedAsARecordThatTuneReads) {
  serve(2000);
  const auto listed = bench.shell("hysteron history history.sqlite");
  EXPECT_EQ(listed.code, 0) << listed.err;
  EXPECT_THAT(listed.out, HasSubstr("run 1: PLANT, a row every 0.01 s; GAIN_IN [V], U [V], Y [um]\n"));
  EXPECT_THAT(listed.out, HasSubstr(", 2000 rows without a gap\n"));
  const auto exported = bench.shell("hysteron history history.sqlite --out log.csv");
  EXPECT_EQ(exported.code, 0) << exported.err;
  EXPECT_THAT(exported.out, HasSubstr("log.csv: run 1, 2000 rows every 0.01 s, "));
  EXPECT_THAT(exported.out, Not(HasSubstr("gaps")));
  EXPECT_TRUE(bench.read("log.csv").starts_with("t,GAIN_IN [V],U [V],Y [um]\n0,1,"))
      << bench.read("log.csv").substr(0, 80);
  const auto record = bench.shell("hysteron record log.csv");
  EXPECT_EQ(record.code, 0) << record.err;
  EXPECT_THAT(record.out, HasSubstr("2000 rows every 0.01 s"));
  bench.write("model.st", model);
  bench.write("p.toml",
              "[parameters.AMP]\nK = 1.0\n[parameters.LAG]\nT1 = 0.1\n[fit.AMP]\nK = {}\n[fit.LAG]\nT1 = {}\n");
  const auto tuned = bench.shell("hysteron tune model.st --log log.csv --params p.toml --out tuned.toml");
  EXPECT_EQ(tuned.code, 0) << tuned.err << tuned.out;
  const std::string found = bench.read("tuned.toml");
  const auto value = [&](const std::string& key) { return std::stod(found.substr(found.find(key) + key.size())); };
  EXPECT_NEAR(value("\nK = "), 2.5, 1e-6) << found;
  EXPECT_NEAR(value("\nT1 = "), 0.2, 1e-6) << found;
}

TEST_F(ServedHistory, OfSeveralRunsTheLongestStretchIsTakenAndTheOthersAreSaid) {
  serve(300);
  serve(500);
  const auto both = bench.shell("hysteron history history.sqlite --out log.csv --points y");
  EXPECT_EQ(both.code, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("log.csv: run 2, 500 rows every 0.01 s, "));
  EXPECT_THAT(both.out, HasSubstr("there are gaps: the longest of 2 stretches was taken\n  left out: run 1, "));
  EXPECT_TRUE(bench.read("log.csv").starts_with("t,Y [um]\n0,"));
  const auto first = bench.shell("hysteron history history.sqlite --out log.csv --run 1");
  EXPECT_THAT(first.out, HasSubstr("run 1, 300 rows every"));
  const auto last = bench.shell("hysteron history history.sqlite --out log.csv --run 2 --from 1s");
  EXPECT_THAT(last.out, HasSubstr("run 2, 101 rows every"));
  const auto none = bench.shell("hysteron history history.sqlite --to 1999-12-31");
  EXPECT_EQ(none.code, 2);
  EXPECT_TRUE(none.err.starts_with("HY819 error: ")) << none.err;
  const auto itself = bench.shell("hysteron history history.sqlite --out ./history.sqlite");
  EXPECT_TRUE(itself.err.starts_with("HY709 error: ")) << itself.err;
}

TEST_F(ServedHistory, IsReadFromAFolderThatMayNotBeWritten) {
  serve(100);
  EXPECT_EQ(bench
                .shell("mkdir fixed && cp history.sqlite fixed && chmod a-w fixed/history.sqlite fixed && "
                       "hysteron history fixed/history.sqlite")
                .code,
            0);
  if (geteuid() != 0) {  // root may write everywhere, and SQLite then leaves its index beside the file
    EXPECT_EQ(bench.shell("ls fixed").out, "history.sqlite\n");
  }
  EXPECT_EQ(bench.shell("chmod u+w fixed").code, 0);
}

TEST_F(ServedHistory, ErrorPagesKeepTheirWord) {
  serve(100);
  for (const char* const number : {"HY818", "HY819"}) {
    const auto page = test::read_error_page(number);
    const auto failed = bench.shell(page.fails.text);
    EXPECT_EQ(failed.code, 2);
    EXPECT_TRUE(failed.err.starts_with(std::string(number) + " error: ")) << failed.err;
    const auto mended = bench.shell(page.mended.text);
    EXPECT_EQ(mended.code, 0) << mended.err;
    EXPECT_EQ(mended.err, "");
  }
}

TEST(HistoryTime, IsAMomentOrALengthBackFromTheNewestRow) {
  const auto time = [](const std::string& text) { return tool::history_time(text, "--from", 1'000'000'000'000); };
  EXPECT_EQ(time(""), std::nullopt);
  EXPECT_EQ(time("2h"), 1'000'000'000'000 - 7'200'000);
  EXPECT_EQ(time("3d"), 1'000'000'000'000 - 3 * 86'400'000LL);
  EXPECT_EQ(time("1970-01-02"), 86'400'000);
  EXPECT_EQ(time("1970-01-01T01:02"), 3'720'000);
  EXPECT_EQ(time("1970-01-01 00:00:01.25Z"), 1'250);
  for (const char* const wrong : {"yesterday", "2026-02-30", "2026-1-1", "2026-01-01T25:00", "2026-01-01T10:00x", "-5",
                                  "2026-01-01T10:61", "2026-01-01T10:00:00."}) {
    EXPECT_THROW((void)time(wrong), InputError) << wrong;
  }
}

}  // namespace
}  // namespace hysteron
