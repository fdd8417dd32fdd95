// Loggers, drives and robots: rows that are parts of one, units with a factor, types below the names.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "records/read.hpp"
#include "records/text/csv_line.hpp"
#include "tests/records/dialect.hpp"
#include "tests/records/refusal.hpp"

namespace hysteron::records {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(LoggerDialect, EachHoldsTheSameNumbers) {
  const std::vector<Dialect> dialects{
      {"topics of ROS one below the other", written("time,u,y\n", "{t:.3f},{u:.4f},\n{t:.3f},,{y:.4f}\n")},
      {"date, time and fractional seconds of Keithley",
       written("Index,u,Unit,Date,Time,Fractional Seconds,y\n",
               "{k},{u:.4f},Volt DC,06/03/2024,10:00:00,{t:.6f},{y:.4f}\n")},
      {"two colons of Serial Studio", written("RX Date/Time,u,y\n", "2024/06/03/ 10:00:00::{k:03},{u:.4f},{y:.4f}\n")},
      {"types below the names, of INCA",
       written("ETASAsciiItemFile\trecord\nsampleCount\t40\ntime\tu\ty\nf8\tf4\tf4\ns\tV\tum\n",
               "{t:.6f}\t{u:.4f}\t{y:.4f}\n")},
      {"types below the names, of a PLC", written("time;u;y\nLREAL;REAL;REAL\n", "{t:.3f};{u:.4f};{y:.4f}\n")},
      {"settings with =, of LabChart", written("Interval=\t0.001 s\nChannelTitle=\tu\ty\nRange=\t10.000 V\t10.000 um\n",
                                               "{t:.3f}\t{u:.4f}\t{y:.4f}\n")},
      {"settings with =, without a time",
       written("Interval=\t0.001 s\nChannelTitle=\tu\ty\nRange=\t10.000 V\t10.000 um\n", "{u:.4f}\t{y:.4f}\n")},
      {"a time for each channel, of GW Instek",
       written("Format,1.0B,Format,1.0B,\nSource,u,Source,y,\nSampling Period,1.0E-03,Sampling Period,1.0E-03,\n"
               "Mode,Detail,Mode,Detail,\nWaveform Data,,Waveform Data,,\n",
               "{t:.6E},{u:.4f},{t:.6E},{y:.4f},\n")},
      {"names behind a key and an empty cell in each row, of Yokogawa",
       written("\"Model\",\"DL850\"\n\"TraceName\",\"u\",\"y\"\n\"VUnit\",\"V\",\"V\"\n\"HResolution\",1.0E-03\n"
               "\"Date\",\"2024/06/03\"\n\n",
               ",{u:.4f},{y:.4f}\n")},
      {"keys alone above the rows",
       written("Name;u;y\nData-Type;LREAL;LREAL\nSampleTime[ms];1;1\nSymbolBased;True;True\n\n",
               "{k};{u:.4f};{y:.4f}\n")},
      {"a time in seconds beside each channel, of IndraDrive",
       written("X;u;X;y\n[s];[V];[s];[um]\n", "{t:.3f};{u:.4f};{t:.3f};{y:.4f}\n")},
      {"seconds and nanoseconds of a topic",
       written("/cmd/header/stamp/sec,/cmd/header/stamp/nanosec,u,y\n", "1717408800,{k}000000,{u:.4f},{y:.4f}\n")},
      {"topics in a column", written("timestamp,topic,value\n", "{t:.3f},u,{u:.4f}\n{t:.3f},y,{y:.4f}\n")},
      {"lists of Python", written("t,u,y\n", "[{t:.3f}, {u:.4f}, {y:.4f}],\n")},
      {"tuples of Python",
       written("", "({t:.3f}, {u:.4f}, {y:.4f})\n"),
       {.time = "1", .columns = {{"u", "2"}, {"y", "3"}}}},
      {"names and units around each value", written("", "t = {t:.3f} s, u = {u:.4f} V, y = {y:.4f} um\n")},
      {"dates of Java", written("time,u,y\n", "Mon Jun 03 10:00:00.{k:03} CEST 2024,{u:.4f},{y:.4f}\n")},
      {"dates of Java with a shift",
       written("time,u,y\n", "Mon Jun 03 10:00:00.{k:03} GMT+02:00 2024,{u:.4f},{y:.4f}\n")},
      {"the time in Polish", written("Czas;u;y\n", "{t:.3f};{u:.4f};{y:.4f}\n")},
      {"the time in Russian", written("\xD0\x92\xD1\x80\xD0\xB5\xD0\xBC\xD1\x8F;u;y\n", "{t:.3f};{u:.4f};{y:.4f}\n")},
      {"the time in Japanese", written("\xE6\x99\x82\xE9\x96\x93,u,y\n", "{t:.3f},{u:.4f},{y:.4f}\n")},
      {"a rate above the channels, of GW Instek",
       written("Format,2.0B\nSource,u,y\nVertical Units,V,V\nSampling Period,1.0E-03\nMode,Detail\nWaveform Data\n",
               "{u:.4f},{y:.4f},\n"),
       {.rate = 1000.0}},
  };
  for (const Dialect& one : dialects) {
    expect_the_numbers(one);
  }
}

TEST(LoggerDialect, UnitsBelowTypesAndBeforeBracketsAreKept) {
  const std::string row = "{t:.6f}\t{u:.4f}\t{y:.4f}\n";
  for (const std::string_view head :
       {"time\tu\ty\nf8\tf4\tf4\ns\tmV\tum\n", "Time [s] [abs]\tu [mV] [control]\ty [um] [measured]\n",
        "\"Time, s\"\t\"u, mV (LGR S/N: 20, SEN S/N: 21)\"\t\"y, um (LGR S/N: 20, SEN S/N: 22)\"\n"}) {
    SCOPED_TRACE(head);
    const Record record = parse_record("log.txt", written(head, row));
    EXPECT_EQ(record.column("u").unit, "mV");
    EXPECT_EQ(record.column("y").unit, "um");
    EXPECT_DOUBLE_EQ(record.sample_time(), 1e-3);
  }
  // No unit before it: the brackets are all there is.
  EXPECT_EQ(split_header("u (LGR S/N: 20)").unit, "LGR S/N: 20");
  EXPECT_EQ(split_header("Y[2] [um]").unit, "um");
  EXPECT_EQ(split_header("x [rad/s] (filtered)").unit, "rad/s");
}

TEST(LoggerDialect, UnitsBehindKeysAreKept) {
  const std::string row = "{t:.3f}\t{u:.4f}\t{y:.4f}\n";
  const Record chart = parse_record(
      "log.txt", written("Interval=\t0.001 s\nChannelTitle=\tu\ty\nRange=\t500.0 mV\t2.0 V\nUnitName=\t*\tum\n", row));
  EXPECT_EQ(chart.column("u").unit, "mV");
  EXPECT_EQ(chart.column("y").unit, "um");
  EXPECT_THAT(notes_of(chart), HasSubstr("the units are those of Range= and UnitName= above the rows"));
  // Steps of a converter are no volts.
  for (const std::string_view mode : {"Detail", "Fast"}) {
    const Record scope =
        parse_record("log.csv",
                     written(fmt::format("Source,u,Source,y,\nVertical Units,V,Vertical Units,V,\nMode,{0},Mode,{0},\n"
                                         "Waveform Data,,Waveform Data,,\n",
                                         mode),
                             mode == "Fast" ? "{u:.4f}, ,{y:.4f}, ,\n" : "{t:.3f},{u:.4f},{t:.3f},{y:.4f},\n"),
                     {.rate = 1000.0});
    EXPECT_EQ(scope.column("u").unit, mode == "Fast" ? "" : "V");
    EXPECT_EQ(notes_of(scope).find("steps of the converter") != std::string::npos, mode == "Fast");
  }
}

/// Numbers that jump from 100059.999 to 100100.000 are times of day; without a jump, and with another, they are
/// numbers.
TEST(LoggerDialect, TimesOfDayInOneNumber) {
  const Record record = parse_record("log.csv", "Time,u\n100059.5,1\n100059.75,2\n100100.0,3\n100100.25,4\n");
  EXPECT_DOUBLE_EQ(record.sample_time(), 0.25);
  EXPECT_DOUBLE_EQ(record.time()[0], 36059.5);
  EXPECT_THAT(notes_of(record), HasSubstr("whose numbers are times of day"));
  EXPECT_DOUBLE_EQ(parse_record("log.csv", "Time,u\n100058.0,1\n100059.0,2\n100060.0,3\n100061.0,3\n").time()[2],
                   100060.0);
  EXPECT_THAT(refusal_of("Time,u\n100058.0,1\n100059.0,2\n100159.0,3\n100200.0,3\n"), HasSubstr("HY507"));
  EXPECT_THAT(refusal_of("Time,u\n100078.0,1\n100079.0,2\n100120.0,3\n100121.0,3\n"), HasSubstr("HY507"));
}

TEST(LoggerDialect, OneUnitOfAllChannelsIsTakenAndSaid) {
  for (const std::string_view head :
       {"Units:(mV),\nTime,u,y [um]\n", "#UNITS:mV\nTime,u,y [um]\n", "Unit: mV\nTime,u,y [um]\n"}) {
    SCOPED_TRACE(head);
    const Record record = parse_record("log.csv", written(head, "{t:.3f},{u:.4f},{y:.4f}\n"));
    EXPECT_EQ(record.column("u").unit, "mV");
    EXPECT_EQ(record.column("y").unit, "um");
    EXPECT_THAT(notes_of(record), HasSubstr("the unit of the channels is mV"));
  }
}

/// Taken for rad/s, they would make a machine 9.5 times too fast.
TEST(LoggerDialect, TurnsAMinuteAreRpm) {
  for (const std::string_view unit : {"U/min", "Upm", "r/min", "rev/min", "RPM", "rpm"}) {
    EXPECT_EQ(parse_record("log.csv", written(fmt::format("t,u,y [{}]\n", unit), "{t:.3f},{u:.4f},{y:.4f}\n"))
                  .column("y")
                  .unit,
              "rpm");
    EXPECT_EQ(parse_record("log.csv", written(fmt::format("t,u,y\ns,V,{}\n", unit), "{t:.3f},{u:.4f},{y:.4f}\n"))
                  .column("y")
                  .unit,
              "rpm");
  }
  const Record stated = parse_record("log.csv", "t,u\n0,1\n1,2\n", {.columns = {{"u", "u", "U/min"}}});
  EXPECT_EQ(stated.column("u").unit, "rpm");
}

TEST(LoggerDialect, TypesAndZonesInBracketsAreNoUnits) {
  const std::string row = "{t:.3f},{u:.4f},{y:.4f}\n";
  EXPECT_EQ(parse_record("log.csv", written("Time (UTC),u(REAL),y(LREAL)\n", row)).column("u").unit, "");
  // Days of a spreadsheet stay in doubt, and the mend is one that can be taken as it stands.
  const std::string said = refusal_of("Time (UTC),u\n45446.4166666667,1\n45446.4166782407,2\n45446.4166898148,3\n");
  EXPECT_THAT(said, HasSubstr("HY514"));
  EXPECT_THAT(said, HasSubstr("--time Time[d]"));
}

TEST(LoggerDialect, PartsOfARowAreToldAndNeverMixTwoNumbers) {
  const Record parts = parse_record("log.csv", "t,u,y\n0,1,\n0,,3\n1,2,\n1,,6\n2,3,\n2,,9\n");
  EXPECT_EQ(parts.column("u").values, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(parts.column("y").values, (std::vector<double>{3.0, 6.0, 9.0}));
  EXPECT_THAT(notes_of(parts), HasSubstr("put together: 6 rows are 3"));
  // A signal of half the rate keeps its gaps, and says so to who asks for it.
  const Record half = parse_record("log.csv", "t,u,y\n0,1,\n0,,3\n1,2,\n2,3,\n2,,9\n");
  EXPECT_EQ(half.column("u").values, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_ANY_THROW((void)half.column("y"));
  // Two numbers of one time: neither is taken.
  EXPECT_THAT(refusal_of("t,u,y\n0,1,\n0,2,3\n1,2,\n1,2,6\n2,3,\n2,3,9\n"), HasSubstr("HY508"));
}

TEST(LoggerDialect, AFactorBeforeAUnitIsTaken) {
  const Record record = parse_record("log.csv", "t [ms],i [0.1 A],n [1e-3 V],p (0.01%)\n0,2,3,4\n1,6,7,8\n");
  EXPECT_EQ(record.column("i").unit, "A");
  EXPECT_DOUBLE_EQ(record.column("i").values[0], 0.2);
  EXPECT_EQ(record.column("n").unit, "V");
  EXPECT_DOUBLE_EQ(record.column("n").values[1], 0.007);
  EXPECT_EQ(record.column("p").unit, "%");
  EXPECT_DOUBLE_EQ(record.column("p").values[1], 0.08);
  EXPECT_THAT(notes_of(record), HasSubstr("column i is in 0.1 A: its numbers were multiplied by 0.1"));
  // What the user says goes before it.
  const Record stated = parse_record("log.csv", "t,u [0.1 V]\n0,1\n1,5\n", {.columns = {{"u", "u", "V"}}});
  EXPECT_DOUBLE_EQ(stated.column("u").values[1], 5.0);
  EXPECT_EQ(stated.column("u").unit, "V");
  // Units that begin with a number, a number without a unit, and the time's own.
  const Record speed = parse_record("log.csv", "t (100 ns),n [1/min],ch (2)\n0,1,3\n1,5,3\n");
  EXPECT_EQ(speed.column("n").unit, "1/min");
  EXPECT_DOUBLE_EQ(speed.column("n").values[1], 5.0);
  EXPECT_DOUBLE_EQ(speed.sample_time(), 1e-7);
  EXPECT_NE(speed.find("ch (2)"), nullptr);
}

TEST(LoggerDialect, AFactorThatCouldBeARangeOrBeDoneAlreadyHasTwoReadings) {
  for (const std::string_view name : {"u [10 mV]", "u (10 V)", "u (x1000)", "u [1000x]", "u [*1000]",
                                      "u [\xC3\x97"
                                      "1000]"}) {
    const std::string said = refusal_of(fmt::format("t,{}\n0,1\n1,2\n", name));
    EXPECT_THAT(said, HasSubstr("HY514")) << name;
    EXPECT_THAT(said, HasSubstr("--column u=u[mV]")) << name;
  }
  const Record stated = parse_record("log.csv", "t,u (x1000)\n0,1\n1,2\n", {.columns = {{"u", "u", "mV"}}});
  EXPECT_EQ(stated.column("u").unit, "mV");
}

TEST(LoggerDialect, ALineThatIsNeitherNamesNorARowIsShown) {
  const std::string said = refusal_of("rig\nmin\tCH1\tCH2\t\n\t60\t60\t\n0.1\t1\t2\t\n0.2\t2\t4\t\n0.3\t2\t4\t\n");
  EXPECT_THAT(said, HasSubstr("holds no names, and is no row like them"));
  EXPECT_THAT(said, Not(HasSubstr("4 cells where the line above has 4")));
  EXPECT_THAT(said, HasSubstr("--skip 3"));
}

TEST(LoggerDialect, FormatsOfOtherProgramsAreNamed) {
  const std::pair<std::string, std::string_view> cases[] = {
      {"{'t': 0.0, 'u': 0.1}\n{'t': 0.001, 'u': 0.2}\n", "ast.literal_eval"},
      {"# HELP u voltage\n# TYPE u gauge\nu 0.1 1717408800000\n", "Prometheus"},
      {"FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n", "mavlogdump.py"},
      {">u:1717408800001:0.1\n>y:1717408800001:0.3\n", "Teleplot"},
      {std::string("SQLite format 3\0", 16) + std::string(84, '\0'), "hysteron history"},
  };
  for (const auto& [bytes, said] : cases) {
    SCOPED_TRACE(bytes);
    EXPECT_THAT(refusal_of(bytes), HasSubstr("HY513"));
    EXPECT_THAT(refusal_of(bytes), HasSubstr(std::string(said)));
  }
  EXPECT_THAT(refusal_of("> plot,\nt,u\n0,1\n0.5,x\n"), Not(HasSubstr("Teleplot")));
}

/// Python on Windows without newline='' ends lines by CR CR LF; other programs print a line feed too many.
TEST(LoggerDialect, AnEmptyLineBehindEachRowIsLeftOut) {
  const Record twice = parse_record("log.csv", "t,u\r\r\n0,1\r\r\n1,2\r\r\n2,3\r\r\n3,4\r\r\n");
  EXPECT_THAT(twice.column("u").values, ElementsAre(1.0, 2.0, 3.0, 4.0));
  const Record spaced = parse_record("log.csv", "t,u\n\n0,1\n\n1,2\n\n2,3\n\n3,4\n\n");
  EXPECT_THAT(spaced.column("u").values, ElementsAre(1.0, 2.0, 3.0, 4.0));
  EXPECT_THAT(notes_of(spaced), HasSubstr("an empty line between all rows"));
  EXPECT_THAT(refusal_of("t,u\n0,1\n1,2\n\n2,3\n3,4\n"), HasSubstr("There is a blank row"));
}

/// A unit may stand in a column of its own; so K is not a thousand times too small.
TEST(LoggerDialect, AColumnOfUnitsIsTheUnitOfItsSignal) {
  for (const std::string_view names : {"u,u_unit,y,y_unit", "u,U Unit,y,y units", "u,Unit,y,Unit", "u,Einheit,y,uom"}) {
    const Record record = parse_record("log.csv", fmt::format("t,{}\n0,1,mV,2,um\n1,2,mV,4,um\n2,3,mV,6,um\n", names));
    EXPECT_EQ(record.column("u").unit, "mV") << names;
    EXPECT_EQ(record.column("y").unit, "um") << names;
    EXPECT_THAT(notes_of(record), HasSubstr("column u is in mV, as column ")) << names;
  }
  EXPECT_THAT(refusal_of("t,u,u_unit\n0,1,mV\n1,2,V\n2,3,mV\n"), HasSubstr("says that u is in mV and in V"));
  // A unit in the head goes before, and words that are no units are none.
  EXPECT_EQ(parse_record("log.csv", "t,u [V],u_unit\n0,1,mV\n1,2,mV\n2,3,mV\n").column("u").unit, "V");
  EXPECT_EQ(parse_record("log.csv", "t,u,u_unit\n0,1,mixer\n1,2,mixer\n2,3,mixer\n").column("u").unit, "");
}

/// The pipes at the edges of a table, and separators at the ends of rows, are no columns.
TEST(LoggerDialect, AnEmptyColumnWithoutANameIsNone) {
  const Record piped = parse_record("log.txt", "| t | u |\n|---|---|\n| 0 | 1 |\n| 1 | 2 |\n| 2 | 3 |\n");
  EXPECT_THAT(piped.column("u").values, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_TRUE(piped.unreadable().empty());
  EXPECT_TRUE(parse_record("log.csv", "t;u;\n0;1;\n1;2;\n2;3;\n").unreadable().empty());
}

/// A program of a microcontroller writes ms,u,y: seconds would be a thousand times too long.
TEST(LoggerDialect, ANameThatIsAUnitOfTimeIsTheTime) {
  for (const std::string_view name : {"ms", "tick_ms", "uptime_ms", "Uptime [ms]", "Laufzeit_ms"}) {
    const Record record = parse_record("log.csv", fmt::format("{},u\n0,1\n10,2\n20,3\n30,4\n", name));
    EXPECT_EQ(record.sample_time(), 0.01) << name;
    EXPECT_THAT(notes_of(record), HasSubstr("in ms")) << name;
  }
  EXPECT_EQ(parse_record("log.csv", "u,us\n1,0\n2,50\n3,100\n4,150\n", {.time = "us"}).sample_time(), 50e-6);
  // Beside a time it is a signal, and one that does not rise is none.
  EXPECT_THAT(parse_record("log.csv", "ms,t\n0,0\n10,1\n20,2\n").column("ms").values, ElementsAre(0.0, 10.0, 20.0));
  EXPECT_THAT(refusal_of("ms,u\n0,1\n10,2\n5,3\n"), HasSubstr("There is no column of time"));
  EXPECT_THAT(refusal_of("u,tick_us\n1,0\n0,50\n3,100\n"), HasSubstr("--time tick_us[us]"));
}

}  // namespace
}  // namespace hysteron::records
