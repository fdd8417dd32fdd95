// One record in every dress in which a tool of the field writes it: the numbers are the same.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "records/read.hpp"
#include "support/errors.hpp"
#include "tests/records/refusal.hpp"

namespace hysteron::records {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int rows = 20;

double u_of(int k) {
  return std::round(1e4 * std::sin(0.7 * k)) / 1e4;
}

/// A row for each sample; {t}, {u}, {y} and {k} stand in `row`.
std::string table(std::string_view head, std::string_view row, double time_scale = 1e-3, std::string_view tail = "") {
  std::string text(head);
  for (int k = 0; k < rows; ++k) {
    text += fmt::format(fmt::runtime(row), fmt::arg("t", time_scale * k), fmt::arg("u", u_of(k)),
                        fmt::arg("y", 3.0 * u_of(k)), fmt::arg("k", k), fmt::arg("m", k / 60000.0),
                        fmt::arg("d", fmt::format("{:.9f}", k / 86.4).substr(1)));
    text += '\n';
  }
  return text + std::string(tail);
}

std::string with_decimal_commas(std::string text) {
  for (char& c : text) {
    c = c == '.' ? ',' : c;
  }
  return text;
}

void expect_the_record(const Record& record) {
  ASSERT_EQ(record.size(), static_cast<std::size_t>(rows));
  EXPECT_DOUBLE_EQ(record.sample_time(), 1e-3);
  const Column& u = record.column("u");
  const Column& y = record.column("y");
  for (int k = 0; k < rows; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_NEAR(record.time()[at] - record.time()[0], 1e-3 * k, 1e-9);
    EXPECT_NEAR(u.values[at], u_of(k), 1e-12);
    EXPECT_NEAR(y.values[at], 3.0 * u_of(k), 1e-12);
  }
}

struct Dress {
  std::string_view name;
  std::string text;
  ReadOptions options{};
};

std::vector<Dress> dresses() {
  const std::string plain = "{t:.3f},{u:.4f},{y:.4f}";
  std::vector<Dress> all{
      {"plain", table("t,u,y\n", plain)},
      {"capitals", table("T,U,Y\n", plain)},
      {"time", table("time,u,y\n", plain)},
      {"Time (s)", table("Time (s),u (V),y (um)\n", plain)},
      {"timestamp", table("timestamp,u,y\n", plain)},
      {"Zeit", ""},
      {"milliseconds by unit", table("t [ms],u,y\n", "{k},{u:.4f},{y:.4f}")},
      {"milliseconds by name", table("t_ms,u,y\n", "{k},{u:.4f},{y:.4f}")},
      {"microseconds", table("Time/us,u,y\n", "{k}000,{u:.4f},{y:.4f}")},
      {"minutes", table("time [min],u,y\n", "{m:.12f},{u:.4f},{y:.4f}")},
      {"row of units", table("time,u,y\nms,V,um\n", "{k},{u:.4f},{y:.4f}")},
      {"row of units in brackets", table("time,u,y\n(ms),(V),(um)\n\n", "{k},{u:.4f},{y:.4f}")},
      {"oscilloscope",
       table("x-axis,1,2\nsecond,Volt,Volt\n", "{t:.6e},{u:.5e},{y:.5e}"),
       {.columns = {{"u", "1"}, {"y", "2"}}}},
      {"labels", table("Model,X\nInterval,0.001,0.001\n,,\nLabel,u,y\nTIME,CH1,CH2\n", plain)},
      {"counted",
       table("X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-3.0e-02,1.0e-03\n", "{k},{u:.4f},{y:.4f},"),
       {.columns = {{"u", "CH1"}, {"y", "CH2"}}}},
      {"blanks", table("  t   u    y\n", "  {t:.3f}  {u:.4f}   {y:.4f}")},
      {"pipes", table("| t | u | y |\n", "| {t:.3f} | {u:.4f} | {y:.4f} |")},
      {"tabs and commas", ""},
      {"sep", table("sep=;\r\nt;u;y\r\n", "{t:.3f};{u:.4f};{y:.4f}\r")},
      {"EOF", table("t,u,y\n", plain, 1e-3, "EOF\n")},
      {"title", table("Measurement of 3 June\n\nt,u,y\n", plain)},
      {"remarks", table("# rig 4\n# 1 kHz\nt,u,y\n", plain)},
      {"percent", table("% rig 4\nt,u,y\n", plain)},
      {"sigrok", table("; made by a logger\n; Rate: 1 kHz\nt, u, y\n", "{t:.3f}, {u:.4f}, {y:.4f}")},
      {"numpy", table("# t u y\n", "{t:.18e} {u:.18e} {y:.18e}")},
      {"index", table(",t,u,y\n", "{k},{t:.3f},{u:.4f},{y:.4f}")},
      {"separator at the end", table("t,u,y\n", "{t:.3f},{u:.4f},{y:.4f},")},
      {"words", table("t,u,y,b,note\n", "{t:.3f},{u:.4f},{y:.4f},TRUE,idle")},
      {"units in cells", table("t,u,y\n", "{t:.3f} sec,{u:.4f} V,{y:.4f} um")},
      {"named cells", table("", "t:{t:.3f},u:{u:.4f},y:{y:.4f}")},
      {"Fortran", table("t,u,y\n", "{t:.3f}D+00,{u:.4f}D+00,{y:.4f}d+00")},
      {"arrival", table("t,u,y\n", "10:00:00.{k:03} -> {t:.3f},{u:.4f},{y:.4f}")},
      {"ISO 8601", table("Time,u,y\n", "2024-06-03T10:00:00.{k:03}Z,{u:.4f},{y:.4f}")},
      {"ISO 8601 with a zone", table("t,u,y\n", "2024-06-03 10:00:00.{k:03}+02:00,{u:.4f},{y:.4f}")},
      {"German date", table("Datum;u;y\n", "03.06.2024 10:00:00,{k:03};{u:.4f};{y:.4f}")},
      {"clock", table("Uhrzeit;u;y\n", "10:00:00.{k:03};{u:.4f};{y:.4f}")},
      {"trend", table("\"Trend Tags:\",\"2\"\n\"Header:\",\"Date\",\"Time\",\"u\",\"y\"\n",
                      "\"Data\",\"6/3/2024\",\"10:00:00;{k:03}\",{u:.4f},{y:.4f}")},
      {"epoch in s", table("t,u,y\n", "1717408800.{k:03}000,{u:.4f},{y:.4f}")},
      {"epoch in ms", table("t,u,y\n", "1717408800{k:03},{u:.4f},{y:.4f}")},
      {"epoch in us", table("ts,u,y\n", "1717408800{k:03}000,{u:.4f},{y:.4f}"), {.time = "ts"}},
      {"epoch in ns", table("t,u,y\n", "1717408800{k:03}000000,{u:.4f},{y:.4f}")},
      {"FILETIME", table("t,u,y\n", "133618824000{k:02}0000,{u:.4f},{y:.4f}")},
      {"time twice", table("t,u,t,y\n", "{t:.3f},{u:.4f},{t:.3f},{y:.4f}")},
      {"a torque T beside the time", table("time,T,u,y\n", "{t:.3f},{u:.4f},{u:.4f},{y:.4f}")},
      {"no time", table("u,y\n", "{u:.4f},{y:.4f}"), {.rate = 1000.0}},
      {"no names", table("", plain), {.time = "1", .columns = {{"u", "2"}, {"y", "3"}}}},
      {"paths", table("time,MAIN.u,MAIN.y\n", plain), {.columns = {{"u", "MAIN.u"}, {"y", "MAIN.y"}}}},
      {"lines above", table("1,2,3,4\nt,u,y\n", plain), {.skip = 1}},
      {"Scope of TwinCAT",
       table("Name\tScope\nFile\tX\n\nName\tu\tName\ty\nSampleTime[ms]\t1\tSampleTime[ms]\t1\nPort\t851\tPort\t851\n\n",
             "{k}\t{u:.4f}\t{k}\t{y:.4f}")},
      {"WinCC",
       table("\"VarName\";\"TimeString\";\"VarValue\";\"Validity\";\"Time_ms\"\n",
             "u;03.06.2024 10:00:00;{u:.4f};1;45446416666{d}\ny;03.06.2024 10:00:00;{y:.4f};1;45446416666{d}")},
      {"Influx",
       table("#datatype,string,long,dateTime,double\n#default,_result,,,\n,result,table,_time,_field,_value\n",
             ",,0,2024-06-03T10:00:00.{k:03}Z,u,{u:.4f}\n,,0,2024-06-03T10:00:00.{k:03}Z,y,{y:.4f}")},
      {"Windows-1252", table("t,u [V],y [\xB5m]\n", plain)},
      {"byte order mark", table("\xEF\xBB\xBFt,u,y\n", plain)},
  };
  for (Dress& one : all) {
    if (one.name == "Zeit") {
      one.text = with_decimal_commas(table("Zeit;u;y\n", "{t:.3f};{u:.4f};{y:.4f}"));
    } else if (one.name == "tabs and commas") {
      one.text = with_decimal_commas(table("t\tu\ty\n", "{t:.3f}\t{u:.4f}\t{y:.4f}"));
    }
  }
  std::string wide;
  for (const char c : table("t,u,y\n", plain)) {
    wide += c;
    wide += '\0';
  }
  all.push_back({"UTF-16 without a mark", wide});
  all.push_back({"UTF-16", "\xFF\xFE" + wide});
  return all;
}

TEST(Dress, EveryOneHoldsTheSameRecord) {
  for (const Dress& one : dresses()) {
    SCOPED_TRACE(one.name);
    SCOPED_TRACE(one.text.substr(0, 300));
    ASSERT_NO_THROW(expect_the_record(parse_record("log.csv", one.text, one.options)));
  }
}

/// A dress says nothing of the numbers: what holds of the record in one holds in all.
TEST(Dress, PlacesOfErrorsAreThoseOfTheFile) {
  const Record record = parse_record("log.csv", "# rig\ntime;a;u\nms;;V\n0;x;1\n1;y;2\n2;z;3\n");
  const Place place = record.place("u", 1);
  EXPECT_EQ(place.line, 5U);
  EXPECT_EQ(place.column, 5U);
}

TEST(Dress, ColumnsThatNobodyAsksForMayHoldWhatTheyWill) {
  const Record record = parse_record("log.csv", "t,u,state,y,note\n0,1,idle,nan,\n1,2,run,3,a\n2,3,run,4,b\n");
  EXPECT_THAT(record.names(), ElementsAre("u"));
  ASSERT_EQ(record.unreadable().size(), 3U);
  EXPECT_THROW((void)record.find("state"), InputError);
  EXPECT_THROW((void)record.column("y"), InputError);
}

/// 1.118 is read as that number, and not as 1 and 0.118.
TEST(Dress, TimesHaveTheBitsOfTheirDigits) {
  std::string text = "t [ms],u\n";
  std::string seconds = "t,u\n";
  for (int k = 0; k < 3000; ++k) {
    text += fmt::format("{},1\n", k);
    seconds += fmt::format("{:.3f},1\n", 1e-3 * k);
  }
  const Record a = parse_record("log.csv", text);
  const Record b = parse_record("log.csv", seconds);
  for (std::size_t k = 0; k < 3000; ++k) {
    EXPECT_EQ(b.time()[k], std::stod(fmt::format("{:.3f}", 1e-3 * static_cast<double>(k))));
    EXPECT_EQ(a.time()[k], b.time()[k]);
  }
}

TEST(Dress, TruthsAreOneAndZero) {
  const Record record = parse_record("log.csv", "t,u,v\n0,TRUE,on\n1,false,OFF\n2,True,On\n");
  EXPECT_THAT(record.column("u").values, ElementsAre(1.0, 0.0, 1.0));
  EXPECT_THAT(record.column("v").values, ElementsAre(1.0, 0.0, 1.0));
}

TEST(Dress, UnitsAreKeptWhereverTheyStand) {
  for (const std::string_view text : {"t,u [mV]\n0,1\n1,2\n", "t,u (mV)\n0,1\n1,2\n", "t,u / mV\n0,1\n1,2\n",
                                      "t,u\ns,mV\n0,1\n1,2\n", "t,u\n0,1 mV\n1,2 mV\n"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(parse_record("log.csv", std::string(text)).column("u").unit, "mV");
  }
}

TEST(Dress, PartsAreReadByTimesAndByRows) {
  const std::string text = "t,u\n0,1\n1,2\n2,nan\n3,4\n4,5\n0,6\n1,7\n";
  const Record behind = parse_record("log.csv", text, {.first_row = 4, .last_row = 5});
  EXPECT_THAT(behind.time(), ElementsAre(3.0, 4.0));
  EXPECT_THAT(behind.column("u").values, ElementsAre(4.0, 5.0));
  EXPECT_EQ(behind.place("u", 0).line, 5U);
  const Record second = parse_record("log.csv", text, {.first_row = 6});
  EXPECT_THAT(second.column("u").values, ElementsAre(6.0, 7.0));
  const Record ranged = parse_record("log.csv", "t,u\n0,1\n1,2\n2,nan\n3,4\n4,5\n", {.begin = 3.0});
  EXPECT_THAT(ranged.column("u").values, ElementsAre(4.0, 5.0));
  EXPECT_THAT(parse_record("log.csv", "t,u\n0,1\n1,2\n2,3\n3,4\n", {.begin = 1.0, .end = 3.0}).column("u").values,
              ElementsAre(2.0, 3.0));
}

TEST(Dress, UnevenTimesAreBroughtToAnEvenGrid) {
  const std::string text = "t,u\n0,0\n1,10\n2.5,25\n3,30\n4,40\n";
  EXPECT_THROW((void)parse_record("log.csv", text), InputError);
  const Record linear = parse_record("log.csv", text, {.resampling = Resampling::Linear});
  EXPECT_EQ(linear.sample_time(), 1.0);
  EXPECT_THAT(linear.column("u").values, ElementsAre(0.0, 10.0, 20.0, 30.0, 40.0));
  EXPECT_THAT(linear.notes().back(), HasSubstr("resampled (linear) to 1 s: 5 rows"));
  const Record held = parse_record("log.csv", text, {.resampling = Resampling::Hold});
  EXPECT_THAT(held.column("u").values, ElementsAre(0.0, 10.0, 10.0, 30.0, 40.0));
  EXPECT_THAT(held.notes().back(), HasSubstr("late by 0.2 s"));
  const Record mean = parse_record("log.csv", "t,u\n0,0\n1,10\n2,20\n3,30\n4,40\n5,50\n",
                                   {.resampling = Resampling::Average, .sample_time = 2.0});
  EXPECT_THAT(mean.time(), ElementsAre(0.0, 2.0, 4.0));
  EXPECT_THAT(mean.column("u").values, ElementsAre(0.0, 20.0, 40.0));
}

/// A line between two readings of an encoder hides its step, and makes it no finer.
TEST(Dress, TheStepOfAColumnOutlivesItsResampling) {
  const std::string text = "t,u\n0,0\n1,10\n2.5,20\n3,30\n4,40\n";
  EXPECT_EQ(parse_record("log.csv", "t,u\n0,0\n1,10\n2,20\n3,30\n").column("u").step, 0.0);
  Record linear = parse_record("log.csv", text, {.resampling = Resampling::Linear});
  EXPECT_EQ(linear.column("u").step, 10.0);
  EXPECT_EQ(linear.slice({.first = 1, .last = 3}).column("u").step, 10.0);
  linear.convert("u", -0.001, "V");
  EXPECT_EQ(linear.column("u").step, 0.01);
  EXPECT_EQ(linear.column("u").values.back(), -0.04);
  EXPECT_EQ(parse_record("log.csv", text, {.resampling = Resampling::Average}).column("u").step, 0.0);
}

/// A mean over samples on both sides is late by nothing: of a ramp it is the ramp.
TEST(Dress, TheMeanOfARampIsTheRamp) {
  for (const int times : {2, 3, 5, 10}) {
    std::string text = "t,u\n";
    for (int k = 0; k <= 20 * times; ++k) {
      text += fmt::format("{:.9f},{}\n", 1e-3 * k / times, k);
    }
    const Record record = parse_record("log.csv", text, {.resampling = Resampling::Average, .sample_time = 1e-3});
    ASSERT_EQ(record.size(), 21U);
    for (int k = 0; k <= 20; ++k) {
      EXPECT_NEAR(record.column("u").values[static_cast<std::size_t>(k)], k * times, 1e-9) << times;
    }
  }
}

TEST(Dress, TimesThatCouldBeReadInTwoWaysAreRefused) {
  EXPECT_THAT(refusal_of("clock,u\n00:58,1\n00:59,2\n01:00,3\n"), HasSubstr("HY514"));
  EXPECT_THAT(refusal_of("Time,u\n46176.4166666667,1\n46176.4166782407,2\n46176.4166898148,3\n"),
              HasSubstr("--time Time[d]"));
  EXPECT_NO_THROW((void)parse_record("log.csv", "t,u\n46176.001,1\n46176.002,2\n46176.003,3\n"));
  EXPECT_DOUBLE_EQ(parse_record("log.csv", "Time,u\n46176.4166666667,1\n46176.4166782407,2\n46176.4166898148,3\n",
                                {.time_unit = "d"})
                       .sample_time(),
                   1.0);
}

TEST(Dress, APartIsReadWhateverStandsBesideIt) {
  const std::string text = "t,u\n0,1\n1,2\n2,3\nt,u\n0,4\n1,5\n2,6\n";
  EXPECT_THAT(parse_record("log.csv", text, {.last_row = 3}).column("u").values, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(parse_record("log.csv", text, {.first_row = 4}).column("u").values, ElementsAre(4.0, 5.0, 6.0));
  EXPECT_THAT(refusal_of("t,u\n0,--\n1,2\n2,3\n"), HasSubstr("Column u holds \"--\" here: no value was measured."));
}

TEST(Dress, SignalsWithTimesOfTheirOwnAreBroughtTogether) {
  const Record record = parse_record("log.csv", "t_u,u,t_y,y\n0,0,0.5,5\n1,10,1.5,15\n2,20,2.5,25\n3,30,3.5,35\n",
                                     {.resampling = Resampling::Linear});
  EXPECT_THAT(record.time(), ElementsAre(0.5, 1.5, 2.5));
  EXPECT_THAT(record.column("u").values, ElementsAre(5.0, 15.0, 25.0));
  EXPECT_THAT(record.column("y").values, ElementsAre(5.0, 15.0, 25.0));
}

TEST(Dress, ASignalAtARateOfItsOwnIsBroughtToTheOthers) {
  const std::string text = "t,u,y\n0,0,0\n1,1,\n2,2,6\n3,3,\n4,4,12\n";
  EXPECT_THROW((void)parse_record("log.csv", text).column("y"), InputError);
  EXPECT_THAT(parse_record("log.csv", text, {.resampling = Resampling::Linear}).column("y").values,
              ElementsAre(0.0, 3.0, 6.0, 9.0, 12.0));
  EXPECT_THAT(parse_record("log.csv", text, {.resampling = Resampling::Hold}).column("y").values,
              ElementsAre(0.0, 0.0, 6.0, 6.0, 12.0));
  // A word among the numbers is no gap.
  EXPECT_THROW((void)parse_record("log.csv", "t,y\n0,0\n1,\n2,x\n3,4\n", {.resampling = Resampling::Hold}).column("y"),
               InputError);
}

TEST(Dress, MidnightIsNoStepBack) {
  const Record record = parse_record("log.csv", "clock,u\n23:59:58,1\n23:59:59,2\n00:00:00,3\n00:00:01,4\n");
  EXPECT_THAT(record.time(), ElementsAre(0.0, 1.0, 2.0, 3.0));
}

TEST(Dress, FormatsThatAreNotReadAreNamedWithTheWayOut) {
  const std::pair<std::string, std::string_view> cases[] = {
      {"TDSm\x0E", "TDMS"},    {"MATLAB 5.0 MAT-file, x", "MATLAB"}, {"\x89HDF\r\n\x1A\n", "HDF5"},
      {"PAR1\x15", "Parquet"}, {"#ROSBAG V2.0\n", "ROS bag"},        {"PK\x03\x04", "zip"},
      {"MDF     4.10", "MDF"}, {"RIFF\x24\x08  WAVEfmt ", "WAV"},    {"\x1F\x8B\x08", "gzip"},
  };
  for (const auto& [bytes, name] : cases) {
    SCOPED_TRACE(bytes);
    const std::string said = refusal_of(bytes);
    EXPECT_THAT(said, HasSubstr("HY513"));
    EXPECT_THAT(said, HasSubstr(std::string(name)));
    EXPECT_THAT(said, HasSubstr("mend: "));
  }
}

}  // namespace
}  // namespace hysteron::records
