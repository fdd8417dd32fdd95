// Dialects of tools that the dresses do not show: each is read to the same numbers, or refused with the way out.
#include "tests/records/dialect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "records/read.hpp"
#include "records/text/csv_line.hpp"
#include "records/text/time_cell.hpp"
#include "records/text/unit_text.hpp"
#include "support/errors.hpp"
#include "tests/records/refusal.hpp"

namespace hysteron::records {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Dialect> dialects() {
  const ReadOptions channels{.columns = {{"u", "CH1"}, {"y", "CH2"}}};
  std::string turned = "time,u,y\n";
  std::string twice = "\"time\",\"u\",\"y\"\n";
  std::string again;
  for (int k = 0; k < samples; ++k) {
    const int back = samples - 1 - k;
    turned += fmt::format("2024-06-03 10:00:00.{:03},{:.4f},{:.4f}\n", back, drive(back), 3.0 * drive(back));
    const std::string row = fmt::format("{:.3f},{:.4f},{:.4f}\n", 1e-3 * k, drive(k), 3.0 * drive(k));
    twice += k == 20 ? row + row : row;
    again += (k % 10 == 0 ? "t,u,y\n" : "") + row;
  }
  return {
      {"date, time and milliseconds of FactoryTalk",
       written("Date,Time,Millitm,Marker,u,y\n", "06/03/2024,10:00:00,{k},,{u:.4f},{y:.4f}\n")},
      {"milliseconds beside a date, of Graphtec",
       written("Number,Date&Time,ms,u,y\nNO.,Time,ms,V,um\n", "{k},2024/06/03 10:00:00,{k},{u:+.4f},{y:+.4f}\n")},
      {"seconds and nanoseconds of ROS 2",
       written("header.stamp.sec,header.stamp.nanosec,u,y\n", "1717408800,{k}000000,{u:.4f},{y:.4f}\n")},
      {"month by name, of MATLAB", written("Time,u,y\n", "03-Jun-2024 10:00:00.{k:03},{u:.4f},{y:.4f}\n")},
      {"month by name and two digits, of PI", written("Time,u,y\n", "03-Jun-24 10:00:00.{k:03},{u:.4f},{y:.4f}\n")},
      {"ctime of C", written("time,u,y\n", "Mon Jun  3 10:00:00.{k:03} 2024,{u:.4f},{y:.4f}\n")},
      {"ISO 8601 without marks", written("time,u,y\n", "20240603T100000.{k:03}Z,{u:.4f},{y:.4f}\n")},
      {"length of time of pandas", written(",u,y\n", "0 days 00:00:00.{k:03}000,{u:.4f},{y:.4f}\n")},
      {"TIME of a PLC", written("Time;u;y\n", "T#{k}ms;{u:.4f};{y:.4f}\n")},
      {"LTIME of a PLC", written("Time;u;y\n", "LTIME#{k}ms0us;{u:.4f};{y:.4f}\n")},
      {"a clock with points", written("Uhrzeit;u;y\n", "10.00.00.{k:03};{u:.4f};{y:.4f}\n")},
      {"a German date beside its clock",
       written("Datum;Uhrzeit;u;y\n", "03.06.2024;10:00:00.{k:03};{u:.4f};{y:.4f}\n")},
      {"newest first", turned},
      {"a row written twice", twice},
      {"names repeated", again},
      {"micros() that begin anew", written("micros,u,y\n", "{k}000,{u:.4f},{y:.4f}\n")},
      {"time with unit in capitals", written("TIME_S,u,y\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"units behind in, of Rohde & Schwarz", written("in s,u in V,y in um\n", "{t:.6e},{u:.5e},{y:.5e}\n")},
      {"units behind a slash", written("t/s,u/V,y/um\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"units behind a comma", written("\"t, s\",\"u, V\",\"y, um\"\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"X_Columns No, of LabVIEW",
       written("X0\t0.0\t0.0\t\nDelta_X\t0.001\t0.001\t\n***End_of_Header***\t\t\t\nX_Value\tu\ty\tComment\n",
               "\t{u:.6f}\t{y:.6f}\n")},
      {"X_Columns Multi, of LabVIEW",
       written("Y_Unit_Label\tVolts\tum\t\n***End_of_Header***\t\t\t\nX_Value\tu\tX_Value\ty\tComment\n",
               "{t:.6f}\t{u:.6f}\t{t:.6f}\t{y:.6f}\n")},
      {"a remark behind the first row, of LabVIEW",
       written("X_Value\tu\ty\tComment\n0.000\t0.3505\t1.0514\tbegin\n", "{t:.3f}\t{u:.4f}\t{y:.4f}\n"),
       {.first_row = 2}},
      {"tInc of Rigol", written("CH1,CH2,t0 =-3.0e-02, tInc = 1.0e-03,\n", "{u:.5e},{y:.5e},,\n"), channels},
      {"HResolution of Yokogawa",
       written("\"TraceName\",\"CH1\",\"CH2\"\n\"VUnit\",\"V\",\"V\"\n\"HResolution\",\"1.0E-03\",\"1.0E-03\"\n"
               "\"HUnit\",\"s\",\"s\"\n\n",
               ",{u:.5E},{y:.5E},\n"),
       channels},
      {"three rows of head, of Campbell",
       written("\"TOA5\",\"CR1000\",\"CR1000\",\"1\",\"std\",\"P\",\"1\",\"T\"\n\"TIMESTAMP\",\"RECORD\",\"u\",\"y\"\n"
               "\"TS\",\"RN\",\"V\",\"um\"\n\"\",\"\",\"Smp\",\"Smp\"\n",
               "\"2024-06-03 10:00:00.{k:03}\",{k},{u:.4f},{y:.4f}\n")},
      {"names, units and the index below them, of pandas",
       written("sig,u,y\nunit,V,um\nt,,\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"units with a gap above the time", written("time,u,y\n,Unit: V,Unit: um\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"units with a dash for the time", written("t,u,y\n-,V,um\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"rows for units and comments, of DIAdem",
       written("Kanal;Zeit;u;y\nEinheit;s;V;um\nKommentar;;;\n", ";{t:.3f};{u:.4f};{y:.4f}\n")},
      {"units of ControlDesk by column",
       written("path;;R/u;R/y\nunit;s;;\ntype;XAxis;;\nname;time;u;y\n", "trace_values;{t:.3f};{u:.4f};{y:.4f}\n")},
      {"titles above names that repeat a time",
       written("Rig 4,Run 7,Piezo,Labor\nt,u,t,y\n", "{t:.3f},{u:.4f},{t:.3f},{y:.4f}\n")},
      {"titles above names that end with a separator",
       written("Rig 4,Run 7,Piezo,Labor\nt,u,y,\n", "{t:.3f},{u:.4f},{y:.4f},\n")},
      {"a name over two lines", written("\"t\n[s]\",\"u\r\n[V]\",\"y\n[um]\"\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"rows that begin with their number, of R",
       [] {
         std::string text = "\"t\" \"u\" \"y\"\n";
         for (int k = 0; k < samples; ++k) {
           text += fmt::format("\"{}\" {:.3f} {:.4f} {:.4f}\n", k + 1, 1e-3 * k, drive(k), 3.0 * drive(k));
         }
         return text;
       }()},
      {"a table of Markdown", written("| t | u | y |\n|---|---|---|\n", "| {t:.3f} | {u:.4f} | {y:.4f} |\n")},
      {"a table of psql",
       written("   t   |    u    |   y\n-------+---------+-------\n", " {t:.3f} | {u:.4f} | {y:.4f}\n", "(40 rows)\n")},
      {"a summary below", written("t,u,y\n", "{t:.3f},{u:.4f},{y:.4f}\n", "\nMean,0.1,0.3\nMax,2.1,6.3\n")},
      {"Ctrl-Z", written("t,u,y\n", "{t:.3f},{u:.4f},{y:.4f}\n", "\x1A")},
      {"lines that end with CR",
       [] {
         std::string text = written("t,u,y\n", "{t:.3f},{u:.4f},{y:.4f}\n");
         std::ranges::replace(text, '\n', '\r');
         return text;
       }()},
      {"a signal in each block, of Grafana",
       [] {
         std::string text = "Series;Time;Value\n";
         for (const auto& [name, gain] : {std::pair("u", 1.0), std::pair("y", 3.0)}) {
           for (int k = 0; k < samples; ++k) {
             text += fmt::format("{};2024-06-03T10:00:00.{:03}+00:00;{:.4f}\n", name, k, gain * drive(k));
           }
         }
         return text;
       }()},
      {"the range beside the time, of InfluxDB",
       [] {
         std::string text = ",result,table,_start,_stop,_time,_value,_field\n";
         for (const auto& [name, gain] : {std::pair("u", 1.0), std::pair("y", 3.0)}) {
           for (int k = 0; k < samples; ++k) {
             text += fmt::format(",,0,2024-06-03T09:00:00Z,2024-06-03T11:00:00Z,2024-06-03T10:00:00.{:03}Z,{:.4f},{}\n",
                                 k, gain * drive(k), name);
           }
         }
         return text;
       }()},
      {"apostrophes between thousands",
       [] {
         std::string text = "t;u;y\n";
         for (int k = 0; k < samples; ++k) {
           text += fmt::format("{:.3f};{:.4f};{:.4f}\n", 1e-3 * k, drive(k), 3.0 * drive(k));
         }
         return text + "0.040;1'234.5;3'703.5\n";
       }(),
       {.last_row = samples}},
      {"arrival in brackets, of Tera Term",
       written("", "[2024-06-03 10:00:00.{k:03}] {u:.4f},{y:.4f}\n"),
       {.rate = 1000.0, .columns = {{"u", "1"}, {"y", "2"}}}},
      {"arrival before blanks, of CoolTerm",
       written("", "2024-06-03 10:00:00.{k:03} {u:.4f},{y:.4f}\n"),
       {.rate = 1000.0, .columns = {{"u", "1"}, {"y", "2"}}}},
      {"the minus of typography",
       [] {
         std::string text = written("t,u,y\n", "{t:.3f},{u:.4f},{y:.4f}\n");
         for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos;) {
           text.replace(at, 1, "\xE2\x88\x92");
         }
         return text;
       }()},
  };
}

TEST(Dialect, EachHoldsTheSameNumbers) {
  for (const Dialect& one : dialects()) {
    expect_the_numbers(one);
  }
}

/// What could be read in two ways is refused with the option that says which, or read with a note. The table stands in
/// docs/how-to/own-record.md.
TEST(Dialect, WhatHasTwoReadingsIsRefusedOrSaid) {
  struct Case {
    std::string text;
    std::string_view said;  ///< in the mend of the refusal, or in a note
    bool is_refused = true;
  };
  const std::string tail = "0.001,2,4\n0.002,3,6\n";
  const Case cases[] = {
      {"t;u;y\n1;888;2.664\n2;451;4.353\n3;586;758\n", "--decimal comma"},
      {"t;u\n0;1.234,5\n1;2\n", "--decimal comma"},
      {"t;u\n0;\"1,234.5\"\n1;2\n", "--decimal point"},
      {"time,clock,u\n0,0,1\n1,2,1\n", "--time time"},
      {"t,u,u\n0,1,2\n1,1,2\n", "--column u=2 or --column u=3"},
      {"t_u,u,t_y,y\n0,1,0.5,2\n1,1,1.5,2\n", "--resample linear"},
      {"t1,u,t2,y\n0,1,0,2\n1,1,2,2\n2,1,,\n3,4,,\n", "--resample linear"},
      {"clock,u\n00:58,1\n00:59,2\n01:00,3\n", "--rate"},
      {"Time,u\n46176.4166666667,1\n46176.4166782407,2\n46176.4166898148,3\n", "--time Time[d]"},
      {"date,u\n6/3/2024 23:59:59,1\n6/4/2024 00:00:00,2\n", "2024-06-03"},
      {"time,u\n10:00:00,1\n10:00:00,2\n10:00:00,3\n10:00:01,4\n10:00:01,5\n10:00:01,6\n10:00:02,7\n10:00:02,8\n",
       "--rate 3Hz"},
      {"t,u\n0,1 V\n1,1 mV\n", "one unit"},
      {"0.5,1\n0,0.1,0.3\n0.001,0.2,0.6\n", "--skip 1"},
      {"t u y\n0.5 1 2 3\n0.7 2 4 6\n", "give every column a name"},
      {"Sample rate: 2 kHz\nu,y\n1,2\n1,3\n0,1\n", "--rate 2000Hz"},
      {"t,0,1,2,3,4,5,6,7,8\nu,1,2,3,4,5,6,7,8,9\n", "turn rows into columns"},
      {"t,u\n0,0x1F\n1,0x2F\n2,0x3F\n", "hexadecimal"},
      {"T,u\n20,1\n21,2\n22,3\n", "the time is column T", false},
      {"time,T,u\n"
       "0,25,1\n1,24,2\n2,25,3\n",
       "the time is column time", false},
      {",t,u\n0,0,1\n1,1,2\n2,2,3\n", "", false},
      {"t,u,y\n0.000,1,2\n" + tail + "EOF\n", "is no part of the record", false},
      {"t,u,y\n0.000,1,2\n" + tail + "t,u,y\n0.003,3,6\n", "names stands 1 time more", false},
      {"t,u,y\n0.000,1,2\n0.001,2,4\n0.001,2,4\n0.002,3,6\n0.003,3,6\n", "stands twice", false},
      {"t,u,y\n0.002,3,6\n0.001,2,4\n0.000,1,2\n", "newest first", false},
      {"t_ms,u\n65534,1\n65535,2\n0,3\n1,4\n", "begins anew", false},
      {"\"t\" \"u\"\n\"1\" 0.0 5\n\"2\" 0.1 6\n\"3\" 0.2 7\n", "begins with its number", false},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.text);
    if (one.is_refused) {
      const std::string said = refusal_of(one.text);
      EXPECT_THAT(said.substr(said.find("mend: ")), HasSubstr(std::string(one.said)));
      continue;
    }
    Record record = Record::even(0.0, 1.0, 0);
    ASSERT_NO_THROW(record = parse_record("log.csv", one.text));
    const std::string notes = fmt::format("{}", fmt::join(record.notes(), "\n"));
    EXPECT_THAT(notes, HasSubstr(std::string(one.said)));
  }
}

TEST(Dialect, AStatedDecimalMarkMakesTheOtherOneThousands) {
  const std::string german = "t;u\n0;888\n1;2.664\n2;-1.234.567,5\n";
  EXPECT_THAT(parse_record("log.csv", german, {.decimal = ','}).column("u").values,
              ElementsAre(888.0, 2664.0, -1234567.5));
  const std::string english = "t;u\n0;1,234.5\n1;2,664\n2;0.5\n";
  EXPECT_THAT(parse_record("log.csv", english, {.decimal = '.'}).column("u").values, ElementsAre(1234.5, 2664.0, 0.5));
  EXPECT_THROW((void)parse_record("log.csv", "t;u\n0;888\n1;2.66\n2;1\n", {.decimal = ','}).column("u"), InputError);
}

TEST(Dialect, SignalsWithShorterTimesOfTheirOwnKeepThem) {
  const Record record = parse_record("log.csv", "t1,u,t2,y\n0,0,0,0\n1,10,2,20\n2,20,4,40\n3,30,,\n4,40,,\n",
                                     {.resampling = Resampling::Linear, .sample_time = 1.0});
  EXPECT_THAT(record.column("u").values, ElementsAre(0.0, 10.0, 20.0, 30.0, 40.0));
  EXPECT_THAT(record.column("y").values, ElementsAre(0.0, 10.0, 20.0, 30.0, 40.0));
}

TEST(Dialect, EventsOfASimulationTakeTheLaterRow) {
  const std::string text = "t,u\n0,0\n1,1\n2,2\n2,7\n3,3\n4,4\n5,5\n6,6\n";
  EXPECT_THAT(refusal_of(text), HasSubstr("--resample hold"));
  const Record record = parse_record("log.csv", text, {.resampling = Resampling::Hold});
  EXPECT_THAT(record.column("u").values, ElementsAre(0.0, 1.0, 7.0, 3.0, 4.0, 5.0, 6.0));
}

TEST(Dialect, ARangeOfRowsThatWereTurnedRoundIsOfTheirTimes) {
  const std::string text = "t,u\n4,40\n3,30\n2,20\n1,10\n0,0\n";
  EXPECT_THAT(parse_record("log.csv", text, {.begin = 1.0, .end = 3.0}).column("u").values, ElementsAre(10.0, 20.0));
}

/// A parameter file holds for records with other columns, too; an option is for this one.
TEST(Dialect, NamesThatHoldForManyRecordsMayBeMissing) {
  const std::string text = "t,u\n0,1\n1,2\n2,3\n";
  const Record record =
      parse_record("log.csv", text, {.columns = {{.name = "u", .in_file = "MAIN.u", .is_general = true}}});
  EXPECT_THAT(record.column("u").values, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(record.notes(), ElementsAre("there is no column MAIN.u, which the parameter file names for u"));
  EXPECT_THROW((void)parse_record("log.csv", text, {.columns = {{.name = "u", .in_file = "MAIN.u"}}}), InputError);
}

TEST(Dialect, ACutRowAtTheEndIsToldAsOne) {
  EXPECT_THAT(refusal_of("t,u,y\n0,1,2\n1,2,3\n2,3\n"), HasSubstr("--rows 1..2."));
}

TEST(Dialect, HeadsOfColumnsHaveTheirUnits) {
  const auto parts = [](std::string_view cell) {
    const HeaderName found = split_header(cell);
    return found.name + "|" + found.unit;
  };
  EXPECT_EQ(parts("u/mV"), "u|mV");
  EXPECT_EQ(parts("C1 in V"), "C1|V");
  EXPECT_EQ(parts("v in m/s"), "v|m/s");
  EXPECT_EQ(parts("u, mV"), "u|mV");
  EXPECT_EQ(parts("u_mV"), "u_mV|mV");
  EXPECT_EQ(parts("V(u)"), "V(u)|");
  EXPECT_EQ(parts("I(R1)"), "I(R1)|");
  EXPECT_EQ(parts("V(mV)"), "V|mV");
  EXPECT_EQ(parts("I(A)"), "I|A");
  // No units: a path, a number, a name of one letter, an angle that may be a speed.
  for (const std::string_view name : {"/u", "a/b/V", "motor_A", "velocity_deg", "u_1", "y_max", "Drop in level"}) {
    EXPECT_EQ(parts(name), std::string(name) + "|");
  }
}

TEST(TimeCell, WhatIsNoTimeIsNone) {
  for (const std::string_view text : {"May", "Mon", "3 June", "T#", "T#5", "T#5x", "20240603", "12:3", "1.2.3",
                                      "10.61.00,5", "31-Feb-2024", "0 days", "u 1", "#", "DT#", "Jun 3 10:00:00"}) {
    SCOPED_TRACE(text);
    EXPECT_FALSE(time_cell(text));
  }
  EXPECT_EQ(behind_arrival("[u] 1"), "[u] 1");
  EXPECT_EQ(behind_arrival("2024-06-03 10:00:00"), "2024-06-03 10:00:00");
  EXPECT_EQ(behind_arrival("2024-06-03 10:00:00 -0700"), "2024-06-03 10:00:00 -0700");
}

TEST(TimeCell, LengthsOfTimeAreSeconds) {
  const auto seconds = [](std::string_view text) {
    const auto found = time_cell(text);
    return found ? static_cast<double>(found->stamp.whole) + found->stamp.fraction : std::nan("");
  };
  EXPECT_DOUBLE_EQ(seconds("T#1m2s3.5ms"), 62.0035);
  EXPECT_DOUBLE_EQ(seconds("LTIME#1d_2h"), 93600.0);
  EXPECT_DOUBLE_EQ(seconds("t#-250ms"), -0.25);
  EXPECT_DOUBLE_EQ(seconds("2 days 01:00:00.5"), 176400.5);
  EXPECT_DOUBLE_EQ(seconds("12:30.5"), 750.5);
  EXPECT_DOUBLE_EQ(seconds("Mon Jun  3 10:00:00 2024"), seconds("2024-06-03 10:00:00"));
  EXPECT_DOUBLE_EQ(seconds("3. M\xC3\xA4rz 2024 10:00"), seconds("2024-03-03 10:00:00"));
}

TEST(UnitText, UnitsAreToldFromNames) {
  for (const std::string_view unit : {"V", "mV", "um", "\xC2\xB5m", "N*m", "rad/s", "m/s^2",
                                      "\xC2\xB0"
                                      "C",
                                      "%", "kg\xC2\xB7m2", "1/min"}) {
    EXPECT_TRUE(is_known_unit(unit)) << unit;
  }
  for (const std::string_view name : {"u", "y", "speed", "RN", "Smp", "Standard", "", "state", "x1", "/", "V//s"}) {
    EXPECT_FALSE(is_known_unit(name)) << name;
  }
}

TEST(Dialect, FormatsOfOtherProgramsAreNamed) {
  const std::pair<std::string, std::string_view> cases[] = {
      {"\x93NUMPY\x01", "NumPy"},
      {"ARROW1", "Feather"},
      {"ULog\x01\x12\x35\x01", "ULog"},
      {"LOGG", "BLF"},
      {"AG10", "Keysight"},
      {"7z\xBC\xAF\x27", "archive"},
      {"<html><table>", "web page"},
      {"{\"t\": 0}\n{\"t\": 1}\n", "lines=True"},
  };
  for (const auto& [bytes, said] : cases) {
    SCOPED_TRACE(bytes);
    EXPECT_THAT(refusal_of(bytes), HasSubstr("HY513"));
    EXPECT_THAT(refusal_of(bytes), HasSubstr(std::string(said)));
  }
}

}  // namespace
}  // namespace hysteron::records
