#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "records/read.hpp"
#include "records/text/csv_line.hpp"
#include "support/errors.hpp"
#include "tests/records/refusal.hpp"

namespace hysteron::records {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

void expect_plain(const Record& record) {
  EXPECT_THAT(record.names(), ElementsAre("u", "y"));
  EXPECT_THAT(record.time(), ElementsAre(0.0, 0.5, 1.0));
  EXPECT_THAT(record.column("u").values, ElementsAre(1.5, -2.25, 3.0));
  EXPECT_THAT(record.column("y").values, ElementsAre(10.0, 20.0, 30.0));
  EXPECT_EQ(record.sample_time(), 0.5);
}

TEST(CsvReader, ThePlainForm) {
  expect_plain(parse_record("log.csv", "t,u,y\n0,1.5,10\n0.5,-2.25,20\n1.0,3,30\n"));
}

TEST(CsvReader, TheSameInEveryFormThatIsTolerated) {
  for (const std::string_view text : {
           "\xEF\xBB\xBFt,u,y\r\n0,1.5,10\r\n0.5,-2.25,20\r\n1.0,3,30\r\n",    // byte order mark, CRLF
           "t;u;y\n0;1.5;10\n0.5;-2.25;20\n1.0;3;30",                          // semicolons, no last line end
           "t;u;y\n0;1,5;10\n0,5;-2,25;20\n1,0;3;30\n",                        // decimal commas
           "t\tu\ty\n0\t1,5\t10\n0,5\t-2,25\t20\n1\t3\t30\n",                  // tabs
           "\"t\",\"u\",\"y\"\n0,\"1,5\",10\n\"0,5\",\"-2,25\",20\n1,3,30\n",  // quotes
           " t , u , y \n 0 , +1.5 , 1e1\n0.5,-2.25,2.0E+01\n1.0,3.,30\n",     // blanks, signs, exponents
           "# a log\n\nt,u,y\n# of today\n0,1.5,10\n0.5,-2.25,20\n  # end\n1.0,3,30\n\n \n,,\n",
           "U,T,Y\n1.5,0,10\n-2.25,0.5,20\n3,1,30\n",  // t anywhere, capitals
       }) {
    SCOPED_TRACE(text);
    const Record record = parse_record("log.csv", std::string(text));
    EXPECT_EQ(record.size(), 3U);
    EXPECT_THAT(record.time(), ElementsAre(0.0, 0.5, 1.0));
    EXPECT_THAT(record.column("u").values, ElementsAre(1.5, -2.25, 3.0));
    EXPECT_THAT(record.column("Y").values, ElementsAre(10.0, 20.0, 30.0));
    EXPECT_EQ(record.sample_time(), 0.5);
  }
}

TEST(CsvReader, KeepsUnits) {
  const auto record = parse_record("log.csv", "t [s],u [V],y[µm],\"p [bar, gauge]\",n\n0,1,2,3,4\n1,1,2,3,4\n");
  EXPECT_THAT(record.names(), ElementsAre("u", "y", "p", "n"));
  EXPECT_EQ(record.column("u").unit, "V");
  EXPECT_EQ(record.column("y").unit, "µm");
  EXPECT_EQ(record.column("p").unit, "bar, gauge");
  EXPECT_EQ(record.column("n").unit, "");
}

TEST(CsvReader, SaysWhatIsWrongWhereAndHowToMendIt) {
  EXPECT_EQ(refusal_of("t,u\n0,1\n1,nan\n"),
            "HY506 error: log.csv:3:3: Column u holds nan, which is no finite number.\n"
            "    3 | 1,nan\n"
            "      |   ^^^\n"
            "mend: read the rows behind it: --rows 3.., or record the signal again.\n");
  EXPECT_EQ(refusal_of("\xEF\xBB\xBFt;µ\r\n0;1\r\n1;on\r\n"),
            "HY505 error: log.csv:3:3: \"on\" in column µ is no number.\n"
            "    3 | 1;on\n"
            "      |   ^^\n"
            "mend: write a number, such as 1.25e-3, or record the signal again.\n");
}

/// A few samples that are no numbers can be bridged; of a cut or a dead sensor a line would be invention.
TEST(CsvReader, SaysWhereResamplingBridgesWhatIsNoNumber) {
  const auto log = [](int bad) {
    std::string text = "t,u\n";
    for (int k = 0; k < 40; ++k) {
      text += std::to_string(k) + (k >= 10 && k < 10 + bad ? ",nan\n" : ",1\n");
    }
    return text;
  };
  EXPECT_THAT(refusal_of(log(2)), HasSubstr("It is 2 of 40 rows: --resample linear bridges them"));
  EXPECT_THAT(refusal_of(log(3)), testing::Not(HasSubstr("--resample")));
}

struct Refused {
  std::string text;
  std::string beginning;  ///< of the first diagnostic
  std::string mend;       ///< part of it
};

TEST(CsvReader, RefusesWhatIsNoRecord) {
  const Refused cases[] = {
      {"", "HY501 error: log.csv: The file holds no row of numbers", "row of names"},
      {"\n\n# only\n", "HY501 error: log.csv: The file holds no row of numbers", "row of names"},
      {"t,u\n", "HY501 error: log.csv: The file holds no row of numbers", "row of names"},
      {"t,u\n0,1\n", "HY501 error: log.csv:1:1: The record has one row", "two rows"},
      {"u,y\n0,1\n1,2\n", "HY502 error: log.csv:1:1: There is no column of time", "--time u[s]"},
      {"u,y\n0,1\n0,2\n", "HY502 error: log.csv:1:1: There is no column of time", "--time y[s]"},
      {"u,y\n1,1\n0,0\n", "HY502 error: log.csv:1:1: There is no column of time", "--rate 1kHz"},
      {"t,u,U\n0,1,2\n1,1,2\n", "HY503 error: log.csv:1:3: There are two columns u", "--column u=2 or --column u=3"},
      {"t,u\n0,1\n1,2,3\n", "HY504 error: log.csv:3:1: The row has 3 cells where the line above has 2", "--skip 2"},
      {"t,u\n0,1\n1,2\n2,3\n3,4,5\n", "HY504 error: log.csv:5:1: The row has 3 cells where the header names 2 columns",
       "one number"},
      {"t,u\n0,1\n1\n", "HY504 error: log.csv:3:1: The row has 1 cell ", "one number"},
      {"t,u\n0,000,1,25\n0,005,1,50\n", "HY504 error: log.csv:2:1: ", "decimal points"},
      {"t,u\n0,1\n\n1,2\n", "HY504 error: log.csv:3:1: There is a blank row", "no sample is missing"},
      {"t,u\n0,1\nEOF\n1,2\n2,3\n", "HY504 error: log.csv:3:1: \"EOF\" stands between rows", "--rows 1..1"},
      {"t,u\n0,1\n1,\n", "HY505 error: log.csv:3:3: Column u has no number in this row", "--rows 3.."},
      {"t,u\n0,1\n1,0x10\n", "HY505 error: log.csv:3:3: \"0x10\"", "write 16,"},
      {"t,u\n0,1\n1,0xZ\n", "HY505 error: log.csv:3:3: \"0xZ\"", "such as"},
      {"t,u\n0,1\n1,1 2\n", "HY505 error: log.csv:3:3: \"1 2\"", "such as"},
      {"t,u\n0,1\n1,\"2\n", R"(HY505 error: log.csv:3:3: ""2")", "alone, 2"},
      {"t;u\n0;1\n1;a,b\n", "HY505 error: log.csv:3:3: \"a,b\"", "such as"},
      {"t,u\n0,1 V\n1,1 mV\n", "HY505 error: log.csv:3:3: 1 mV is in mV, but column u is in V", "one unit"},
      {"t,u\n0,1\n1,-Inf\n", "HY506 error: log.csv:3:3: Column u holds -Inf", "--rows"},
      {"t,u\n0,1\n1,1e999\n", "HY506 error: log.csv:3:3: 1e999 in column u is beyond the range", "scale"},
      {"t,u\nnan,1\n1,2\n", "HY506 error: log.csv:2:1: Column t holds nan", "--rows"},
      {"0,1\n1,2\n", "HY509 error: log.csv:1:1: There is no row of names", "--time 1[s]"},
      {"0,5;1\n1;2\n", "HY509 error: log.csv:1:1: There is no row of names", "--column U=2"},
      {"t,\"u\"x\"\n0,1\n1,1\n", "HY509 error: log.csv:1:4: The name of the column holds a quote", "letters"},
      {std::string("t,u\n0,1\n1,\0\n", 11), "HY510 error: log.csv:3:3: The byte 16#00", "CSV"},
      {"t;u\n0,1;1.5\n1;2\n",
       "HY511 error: log.csv:2:5: 1.5 has a decimal point, an earlier number has a decimal comma", "same decimal mark"},
      {"t;u\n0;1.234,5\n1;2\n", "HY511 error: log.csv:2:3: 1.234,5 has more than one decimal mark", "thousands"},
      {"t;u\n0;1,234,567\n1;2\n", "HY511 error: log.csv:2:3: 1,234,567 has more than one decimal mark", "thousands"},
      {"t;u;y\n1;888;2.664\n2;451;4.353\n3;586;758\n",
       "HY511 error: log.csv:2:7: 2.664 in column y could be read in two ways", "--decimal point"},
      {"t [V],u\n0,1\n1,2\n", "HY512 error: log.csv:1:1: The time is given in V", "--time t[UNIT]"},
      {"{\"t\": [0, 1]}", "HY513 error: log.csv: The file is JSON", "to_csv"},
      {"time,clock,u\n0,0,1\n1,2,1\n", "HY514 error: log.csv:1:6: Each of the columns time and clock could be the time",
       "--time time"},
      {"t_u,u,t_y,y\n0,1,0.5,2\n1,1,1.5,2\n", "HY514 error: log.csv:1:7: Columns t_u and t_y have different times",
       "--resample linear"},
  };
  for (const auto& [text, beginning, mend] : cases) {
    SCOPED_TRACE(text);
    const auto said = refusal_of(text);
    EXPECT_THAT(said, StartsWith(beginning));
    EXPECT_THAT(said.substr(said.find("mend: ")), HasSubstr(mend));
  }
}

TEST(CsvReader, TheEarlierDecimalMarkIsNoted) {
  const auto list = refusals_of("t;u\n0,1;1\n1;1.5\n");
  ASSERT_EQ(list.all().front().notes.size(), 1U);
  EXPECT_EQ(list.all().front().notes.front().place.line, 2U);
  EXPECT_EQ(list.all().front().notes.front().place.column, 1U);
}

TEST(CsvReader, RefusesTimesThatAreNoGrid) {
  EXPECT_EQ(refusal_of("t,u\n0,1\n0.5,1\n0.5,2\n1,1\n"),
            "HY508 error: log.csv:4:1: The time 0.5 s stands in two rows.\n"
            "    4 | 0.5,2\n"
            "      | ^^^\n"
            "mend: print the time with more digits, or remove the row that was written twice; events of a simulation: "
            "--resample hold, and the later row counts.\n"
            "note: log.csv:3:1: the row before\n"
            "    3 | 0.5,1\n"
            "      | ^^^\n");
  EXPECT_THAT(refusal_of("u,t\n1,0\n1,0.5\n1,0.25\n"),
              StartsWith("HY508 error: log.csv:4:3: The time runs back, from 0.5 s to 0.25 s."));
  EXPECT_THAT(refusal_of("t,u\n0.000,1\n0.005,1\n# lost\n0.020,1\n0.025,1\n0.030,1\n"),
              StartsWith("HY507 error: log.csv:5:1: The time goes on by 0.015 s here, elsewhere by 0.005 s."));
}

/// An error that prints two numbers shows that they differ.
TEST(CsvReader, TwoTimesThatDifferAreToldApart) {
  EXPECT_THAT(refusal_of("t,u\n100.0000002,1\n100.0000004,1\n100.0000003,1\n"),
              StartsWith("HY508 error: log.csv:4:1: The time runs back, from 100.0000004 s to 100.0000003 s."));
  std::string text = "t,u\n";
  for (int k = 0; k < 40; ++k) {
    text += fmt::format("{:.9f},1\n", 0.1013004 * k + (k > 20 ? 0.0041 : 0.0));
  }
  EXPECT_THAT(refusal_of(text), HasSubstr("The time goes on by 0.1054 s here, elsewhere by 0.1013 s."));
}

TEST(CsvReader, AClockThatDriftsIsToldByHowFarItStrays) {
  std::string text = "t,u\n";
  for (int k = 0; k < 400; ++k) {
    text += fmt::format("{:.9f},1\n", 0.101 * k + 1e-6 * k * k);
  }
  const std::string said = refusal_of(text);
  EXPECT_THAT(said, HasSubstr("No single step stands out, but the times stray from an even grid by 0."));
  EXPECT_THAT(said, HasSubstr("jitters or drifts"));
  EXPECT_THAT(said.substr(said.find("mend: ")), HasSubstr("--resample hold, for encoders and commands"));
}

TEST(CsvReader, CollectsErrorsButNotWithoutEnd) {
  std::string text = "t,u,y\n0,1,1\n1,1,1\n2,1,1\n3,1,1\n";
  for (int row = 4; row < 7; ++row) {
    text += fmt::format("{},1\n", row);
  }
  EXPECT_EQ(refusals_of(text).all().size(), 3U);
  for (int row = 7; row < 10000; ++row) {
    text += fmt::format("{},1\n", row);
  }
  EXPECT_LE(refusals_of(text).all().size(), 12U);
}

TEST(CsvReader, AMissingFileIsHY100) {
  try {
    (void)read_record("/no/such/log.csv");
    FAIL();
  } catch (const InputError& refused) {
    EXPECT_EQ(refused.diagnostics().all().front().number, error::unreadable_file);
  }
}

TEST(SplitHeader, AnElementOfAVectorKeepsItsIndex) {
  const auto parts = [](std::string_view cell) {
    const records::HeaderName found = records::split_header(cell);
    return found.name + "|" + found.unit;
  };
  EXPECT_EQ(parts("Y[2]"), "Y[2]|");
  EXPECT_EQ(parts("Y[2] [um]"), "Y[2]|um");
  EXPECT_EQ(parts("Y[12][1/s]"), "Y[12]|1/s");
  EXPECT_EQ(parts("Y[2] (V)"), "Y[2]|V");
  EXPECT_EQ(parts("gain [1]"), "gain|1");
  EXPECT_EQ(parts("u[V]"), "u|V");
}

}  // namespace
}  // namespace hysteron::records
