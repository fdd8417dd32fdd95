// Records of a diagram that has a port T: which column is the time, which the signal, and where nobody can say.
#include <gmock/gmock.h>

#include <string>
#include <string_view>
#include <vector>

#include "records/csv.hpp"
#include "records/read.hpp"
#include "support/errors.hpp"
#include "support/render.hpp"

namespace hysteron::records {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using Values = std::vector<double>;

/// Of a diagram with a port T, in this unit.
ReadOptions with_t(std::string unit = "") {
  return {.signal_t = SignalT{.unit = std::move(unit), .sample_time = 0.1}};
}

Record read(std::string_view text, const ReadOptions& options) {
  return parse_record("log.csv", std::string(text), options);
}

std::string refusal(std::string_view text, const ReadOptions& options) {
  try {
    (void)read(text, options);
  } catch (const InputError& refused) {
    Sources sources;
    sources.put("log.csv", text);
    return as_text(refused.diagnostics().all().front(), sources);
  }
  return "read";
}

TEST(SignalT, BesideAColumnThatSaysTimeItIsTheSignal) {
  struct Case {
    std::string_view text;
    ReadOptions options = with_t();
  };
  // T rises as evenly as a time, so that nothing but the rule can tell the two apart.
  const std::vector<Case> cases{
      {"time,T,u\n0,5,1\n0.1,6,2\n0.2,7,3\n"},
      {"T,time,u\n5,0,1\n6,0.1,2\n7,0.2,3\n"},
      {"time,t,u\n0,5,1\n0.1,6,2\n0.2,7,3\n"},
      {"Zeit;T;u\n0;5;1\n0,1;6;2\n0,2;7;3\n"},
      {"t_ms,T,u\n0,5,1\n100,6,2\n200,7,3\n"},
      {"ts,T,u\n0,5,1\n0.1,6,2\n0.2,7,3\n"},
      {"time,T [degC],u\n0,5,1\n0.1,6,2\n0.2,7,3\n"},
      {"time,T [s],u\n0,5,1\n0.1,6,2\n0.2,7,3\n"},
      {"time,T,u\ns,degC,V\n0,5,1\n0.1,6,2\n0.2,7,3\n"},
      {"2024-06-03 12:00:00.0,5,1\n2024-06-03 12:00:00.1,6,2\n2024-06-03 12:00:00.2,7,3\n",
       {.columns = {{.name = "T", .in_file = "2"}, {.name = "u", .in_file = "3"}}, .signal_t = SignalT{}}},
      {"t,T,u\n0,5,1\n0.1,6,2\n0.2,7,3\n"},
      {"T,t,u\n5,0,1\n6,0.1,2\n7,0.2,3\n"},
      {"T,t,u\n0,5,1\n0.1,6,2\n0.2,7,3\n", {.time = "T", .signal_t = SignalT{}}},
      {"T,t,u\n5,0,1\n6,0.1,2\n7,0.2,3\n", {.time = "t", .signal_t = SignalT{}}},
      {"tick,T,u\n0,5,1\n0.1,6,2\n0.2,7,3\n", {.time = "tick", .signal_t = SignalT{}}},
      {"t,oven,u\n0,5,1\n0.1,6,2\n0.2,7,3\n", {.columns = {{.name = "T", .in_file = "oven"}}, .signal_t = SignalT{}}},
      {"T,oven,u\n0,5,1\n0.1,6,2\n0.2,7,3\n", {.columns = {{.name = "T", .in_file = "oven"}}, .signal_t = SignalT{}}},
      {"time,T,oven,u\n0,8,5,1\n0.1,8,6,2\n0.2,8,7,3\n",
       {.columns = {{.name = "T", .in_file = "oven"}}, .signal_t = SignalT{}}},
      {"t,u\n5,1\n6,2\n7,3\n", {.rate = 10.0, .signal_t = SignalT{}}},
      {"T,u\n5,1\n6,2\n7,3\n", {.rate = 10.0, .signal_t = SignalT{}}},
      {"t [s],oven,u\n0,5,1\n0.1,6,2\n0.2,7,3\n",
       {.columns = {{.name = "t", .in_file = "oven"}}, .signal_t = SignalT{.unit = "degC"}}},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.text);
    const Record record = read(one.text, one.options);
    EXPECT_NEAR(record.sample_time(), 0.1, 1e-12);
    EXPECT_EQ(record.column("t").name, "T");
    EXPECT_EQ(record.column("T").values, (Values{5, 6, 7}));
    EXPECT_EQ(record.column("u").values, (Values{1, 2, 3}));
    EXPECT_EQ(record.time_heading(), "time");
  }
}

TEST(SignalT, OneColumnThatCouldBeBothIsRefused) {
  EXPECT_EQ(refusal("t,HEAT\n0,1\n0.1,3\n0.2,2\n", with_t()),
            "HY514 error: log.csv:1:1: Column t could be the time, or the signal T of the diagram; the columns are t, "
            "HEAT.\n"
            "    1 | t,HEAT\n"
            "      | ^^^^^^\n"
            "mend: if it is the time, call it time in the file, or say --time t; if it is the signal, state how often "
            "there is a row: --rate 0.1s.\n");
  EXPECT_THAT(refusal("n,T\n7,0\n8,0.1\n9,0.2\n", with_t()),
              AllOf(HasSubstr("Column T could be the time"), HasSubstr("--time T;"), HasSubstr("--time n[s],")));
  // Each of the mends is one.
  EXPECT_EQ(read("t,HEAT\n0,1\n0.1,3\n0.2,2\n", {.time = "t", .signal_t = SignalT{}}).find("T"), nullptr);
  EXPECT_EQ(read("time,HEAT\n0,1\n0.1,3\n0.2,2\n", with_t()).find("T"), nullptr);
  EXPECT_EQ(read("n,T\n7,0\n8,0.1\n9,0.2\n", {.time = "n", .time_unit = "s", .signal_t = SignalT{}}).column("T").values,
            (Values{0, 0.1, 0.2}));
  // A rate above the rows leaves both readings.
  EXPECT_THAT(refusal("# Sample period: 1 ms\nt,HEAT\n0,1\n1,3\n2,2\n", with_t()), HasSubstr("--rate 1000Hz"));
}

TEST(SignalT, WhatCannotBeTheTimeIsTheSignal) {
  for (const std::string_view text : {"T,HEAT\n20,1\n20,2\n20,3\n", "T [degC],HEAT\n20,1\n21,2\n22,3\n"}) {
    EXPECT_THAT(refusal(text, with_t()), HasSubstr("HY502 error: log.csv:1:1: There is no column of time.")) << text;
  }
  EXPECT_EQ(read("t [ms],HEAT\n0,1\n1,2\n2,3\n", with_t("degC")).sample_time(), 1e-3);
  EXPECT_THAT(refusal("t [ms],HEAT\n0,1\n1,2\n2,3\n", with_t("s")), HasSubstr("HY514"));
}

TEST(SignalT, OfTwoThatDifferInCaseTheSmallOneIsTheTimeWhereItRisesEvenly) {
  EXPECT_EQ(
      refusal("t,T,u\n0,5,1\n0.1,6,2\n0.3,7,3\n0.4,8,4\n", with_t()),
      "HY514 error: log.csv:1:1: Each of the columns t and T could be the time, or the signal T of the diagram: t "
      "does not rise evenly, as a time does; the columns are t, T, u.\n"
      "    1 | t,T,u\n"
      "      | ^^^^^\n"
      "mend: call the time `time` in the file, or say which it is: --time t or --time T.\n");
  EXPECT_THAT(refusal("T,t,u\n0,5,1\n0.1,4,2\n0.2,7,3\n", with_t()), HasSubstr("--time T or --time t."));
  EXPECT_THAT(refusal("T,T,u\n0,5,1\n0.1,6,2\n0.2,7,3\n", with_t()), HasSubstr("--time 1 or --time 2."));
  // Only one of them can be a time: what is wrong with it is told.
  EXPECT_THAT(refusal("t,T,u\n0,5,1\n0.1,5,2\n0.3,5,3\n0.4,5,4\n", with_t()), HasSubstr("HY507"));
}

/// What the diagram is nobody said, or it has no port T.
TEST(SignalT, WithoutAPortOfTheNameNothingIsRefused) {
  for (const std::string_view text : {"t,u\n0,1\n0.1,2\n0.2,3\n", "T,u\n0,1\n0.1,2\n0.2,3\n"}) {
    const Record record = read(text, {});
    EXPECT_THAT(record.names(), ElementsAre("u"));
    EXPECT_EQ(record.time_heading(), "t");
  }
  EXPECT_EQ(csv_text(read("t,u\n0,1\n0.1,2\n0.2,3\n", {})), "t,u\n0,1\n0.1,2\n0.2,3\n");
  // A temperature beside the time is a signal, whatever its unit.
  for (const std::string_view text : {"time,T\n0,5\n0.1,6\n0.2,7\n", "time,T [degC]\n0,5\n0.1,6\n0.2,7\n",
                                      "time,T [s]\n0,5\n0.1,6\n0.2,7\n", "t,T\n0,5\n0.1,6\n0.2,7\n"}) {
    SCOPED_TRACE(text);
    const Record record = read(text, {});
    EXPECT_EQ(record.column("T").values, (Values{5, 6, 7}));
    EXPECT_EQ(record.time_heading(), "time");
  }
  EXPECT_EQ(read("time,T,CLOCK\n0,5,1\n0.1,6,3\n0.2,7,4\n", {}).column("CLOCK").values, (Values{1, 3, 4}));
  EXPECT_EQ(read("time,T,CLOCK\n0,5,1\n0.1,6,3\n0.2,7,4\n", with_t()).column("CLOCK").values, (Values{1, 3, 4}));
}

TEST(SignalT, ARecordIsWrittenSoThatItIsReadBack) {
  Record record = Record::even(0.0, 0.5, 3);
  record.add({.name = "u", .values = {1, 2, 3}});
  EXPECT_EQ(csv_text(record), "t,u\n0,1\n0.5,2\n1,3\n");
  record.add({.name = "t", .unit = "s", .values = {4, 5, 6}});
  EXPECT_EQ(csv_text(record), "time,u,T [s]\n0,1,4\n0.5,2,5\n1,3,6\n");
  for (const ReadOptions& options : {ReadOptions{}, with_t(), with_t("s")}) {
    const Record again = read(csv_text(record), options);
    EXPECT_EQ(csv_text(again), csv_text(record));
    EXPECT_EQ(again.slice({1, 3}).time_heading(), "time");
  }
  // Of a diagram with a port T, a record without it says time, too: t alone would have two readings.
  record = Record::even(0.0, 0.5, 2);
  record.add({.name = "u", .values = {1, 2}});
  record.set_beside_t(true);
  EXPECT_EQ(csv_text(record), "time,u\n0,1\n0.5,2\n");
  EXPECT_EQ(read(csv_text(record), with_t()).sample_time(), 0.5);
}

TEST(SignalT, PlacesAreThoseOfTheColumnThatIsMeant) {
  const Record record = read("T,t,u\n5,0,1\n6,0.1,2\n7,0.2,3\n", with_t());
  EXPECT_EQ(record.place("T", 1).column, 1U);
  EXPECT_EQ(record.place_of_time(1).column, 3U);
  EXPECT_THAT(refusal("T,t,u\n5,0,1\n5,0.1,2\n5,0,3\n5,1,3\n", {.time = "t", .signal_t = SignalT{}}),
              AllOf(HasSubstr("HY508 error: log.csv:4:3:"), Not(HasSubstr("log.csv:4:1"))));
}

}  // namespace
}  // namespace hysteron::records
