#include "records/resampled_columns.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "records/read.hpp"
#include "support/diagnostic.hpp"
#include "tests/records/refusal.hpp"

namespace hysteron::records {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Three rows are missing behind 1 s. u rises by 10 a second, q counts, s switches.
constexpr std::string_view log =
    "t,u,q,s\n0,0,0,FALSE\n1,10,1,FALSE\n5,50,5,TRUE\n6,60,6,TRUE\n7,70,7,TRUE\n8,80,8,TRUE\n";

Record read(const ReadOptions& options) {
  return parse_record("log.csv", std::string(log), options);
}

std::string refused(const ReadOptions& options) {
  try {
    (void)read(options).column("u");
  } catch (const InputError& error) {
    const Diagnostic& first = error.diagnostics().all().front();
    return first.cause + " " + first.mend;
  }
  return "read";
}

TEST(ResampledColumns, EachGoesItsWayAndSaysSo) {
  const Record record =
      read({.resampling = Resampling::Linear, .ways = {{.name = "q", .way = Resampling::Hold}}, .sample_time = 1.0});
  EXPECT_THAT(record.column("u").values, ElementsAre(0, 10, 20, 30, 40, 50, 60, 70, 80));
  EXPECT_THAT(record.column("q").values, ElementsAre(0, 1, 1, 1, 1, 5, 6, 7, 8));
  EXPECT_THAT(record.column("s").values, ElementsAre(0, 0, 0, 0, 0, 1, 1, 1, 1));
  // Rows at 2, 3 and 4 s are made up. Linear: the nearer sample is 2 s off at 3 s; held: 1 + 2 + 3 s late, over 9 rows.
  EXPECT_THAT(
      record.notes(),
      ElementsAre("resampled to 1 s: 9 rows", "u: linear; 3 rows made up in gaps; a row lies up to 2 s from its sample",
                  "q: hold; 3 rows made up in gaps; a row lies up to 3 s from its sample, and signals are late "
                  "by 0.667 s in the mean",
                  "s: hold, as nothing lies between two values; 3 rows made up in gaps; a row lies up to 3 s "
                  "from its sample, and signals are late by 0.667 s in the mean"));
}

TEST(ResampledColumns, AColumnOfWhichNothingIsSaidIsRefusedToWhoAsksForIt) {
  const ReadOptions options{.ways = {{.name = "q", .way = Resampling::Hold}}, .sample_time = 1.0};
  EXPECT_THAT(read(options).column("q").values, ElementsAre(0, 1, 1, 1, 1, 5, 6, 7, 8));
  EXPECT_THAT(refused(options), HasSubstr("--resample u=linear"));
  // At the record's own times there is nothing to be done.
  const Record even = parse_record("log.csv", "t,u,q\n0,0,0\n1,10,1\n2,20,2\n3,30,3\n", options);
  EXPECT_THAT(even.column("u").values, ElementsAre(0, 10, 20, 30));
}

TEST(ResampledColumns, BetweenTwoValuesOfASwitchNothingIsMadeUp) {
  const ReadOptions whole{.resampling = Resampling::Average, .stepping = {"Q"}, .sample_time = 1.0};
  EXPECT_THAT(read(whole).column("q").values, ElementsAre(0, 1, 1, 1, 1, 5, 6, 7, 8));
  EXPECT_THAT(refused({.ways = {{.name = "s", .way = Resampling::Linear}}}), HasSubstr("--resample s=hold"));
  EXPECT_THAT(refused({.ways = {{.name = "q", .way = Resampling::Average}}, .stepping = {"Q"}}),
              HasSubstr("--resample q=hold"));
}

TEST(ResampledColumns, NamesAreThoseOfTheDiagramOrOfTheFile) {
  const ReadOptions renamed{.columns = {{.name = "X", .in_file = "u"}}, .resampling = Resampling::Hold};
  for (const std::string_view name : {"X", "u", "2"}) {
    ReadOptions options = renamed;
    options.ways = {{.name = std::string(name), .way = Resampling::Linear}};
    options.sample_time = 1.0;
    EXPECT_THAT(read(options).column("X").values, ElementsAre(0, 10, 20, 30, 40, 50, 60, 70, 80)) << name;
  }
  const Record vector = parse_record("log.csv", "t,Y[1],Y[2]\n0,0,0\n1,1,2\n4,4,8\n5,5,10\n6,6,12\n",
                                     {.ways = {{.name = "Y", .way = Resampling::Linear}}, .sample_time = 1.0});
  EXPECT_THAT(vector.column("Y[2]").values, ElementsAre(0, 2, 4, 6, 8, 10, 12));
}

TEST(ResampledColumns, AMisspeltNameIsRefusedAndOneOfAParameterFileIsSaid) {
  EXPECT_THAT(refused({.ways = {{.name = "n", .way = Resampling::Hold}}}), HasSubstr("There is no column n"));
  try {
    (void)parse_record("log.csv", "t,speed\n0,1\n1,2\n2,3\n", {.ways = {{.name = "sped", .way = Resampling::Hold}}});
    FAIL() << "the name was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().front().mend, "did you mean --resample speed=hold?");
  }
  EXPECT_THAT(refused({.ways = {{.name = "t", .way = Resampling::Hold}}}), HasSubstr("t is the time"));
  EXPECT_THAT(refused({.ways = {{.name = "q", .way = Resampling::Hold}, {.name = "q", .way = Resampling::Linear}}}),
              HasSubstr("in two ways, hold and linear"));
  const Record record =
      read({.resampling = Resampling::Linear, .ways = {{.name = "n", .way = Resampling::Hold, .is_general = true}}});
  EXPECT_EQ(record.notes().front(), "there is no column n, which the parameter file resamples");
}

/// Times with jitter and a gap have the rate at which they were meant to come.
TEST(ResampledColumns, TheRateIsThatOfTheRecordWithoutItsGaps) {
  std::string text = "t,u\n";
  for (int k = 0; k < 200; ++k) {
    if (k < 50 || k > 55) {
      text += fmt::format("{:.6f},{}\n", 1e-3 * k + 1e-5 * ((k * 7) % 5 - 2) * (k > 0), k);
    }
  }
  const Record record = parse_record("log.csv", text, {.resampling = Resampling::Linear});
  EXPECT_EQ(record.sample_time(), 0.001);
}

TEST(ResampledColumns, AGridIsTakenWhereItIsStated) {
  const Record record = read({.resampling = Resampling::Linear, .sample_time = 1.0, .origin = -0.5});
  EXPECT_THAT(std::vector<double>(record.time().begin(), record.time().end()),
              ElementsAre(0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5));
  EXPECT_THAT(record.column("u").values, ElementsAre(5, 15, 25, 35, 45, 55, 65, 75));
}

TEST(ResampledColumns, ARefusalNamesTheColumnThatSteps) {
  EXPECT_THAT(refusal_of("t,u,q\n0,0.5,0\n1,1.5,1\n5,5.5,5\n6,6.5,6\n7,7.5,7\n8,8.5,8\n"),
              HasSubstr("of one signal alone, --resample q=hold"));
}

}  // namespace
}  // namespace hysteron::records
