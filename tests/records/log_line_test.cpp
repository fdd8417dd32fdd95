// Logs of programs: a time in brackets or at the begin of the line, words, and values with their names.
#include "records/text/log_line.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <string_view>
#include <vector>

#include "records/read.hpp"
#include "tests/records/dialect.hpp"
#include "tests/records/refusal.hpp"

namespace hysteron::records {
namespace {

using testing::HasSubstr;

TEST(LogLine, EachHoldsTheSameNumbers) {
  const std::vector<Dialect> logs{
      {"ROS 2", written("", "[INFO] [1717408800.{k:03}000000] [stage]: u: {u:.4f}, y: {y:.4f}\n")},
      {"ROS 2 by its launcher", written("", "[stage-1] [INFO] [1717408800.{k:03}] [stage]: u: {u:.4f}, y: {y:.4f}\n")},
      {"ROS 1 in a simulation", written("", "[ INFO] [1717408800.{k:02}7, {t:.6f}]: u: {u:.4f}, y: {y:.4f}\n")},
      {"ESP-IDF", written("I (12) boot: ESP-IDF v5.1\nI (30) cpu_start: Pro cpu up.\n",
                          "I (1{k:03}) main: u:{u:.4f}, y:{y:.4f}\n")},
      {"ESP-IDF in colours", written("", "\x1B[0;32mI (1{k:03}) main: u:{u:.4f}, y:{y:.4f}\x1B[0m\n")},
      {"Zephyr", written("", "[00:00:01.{k:03},000] <inf> main: u: {u:.4f} y: {y:.4f}\n")},
      {"the kernel", written("", "[   12.{k:03}000] stage: u={u:.4f} y={y:.4f}\n")},
      {"the journal", written("", "2024-06-03T10:00:00.{k:03}000+0200 pi stage[123]: u={u:.4f} y={y:.4f}\n")},
      {"the journal without a year", written("", "Jun 03 10:00:00.{k:03}000 pi stage[123]: u={u:.4f} y={y:.4f}\n")},
      {"the journal in seconds since 1970", written("", "1717408800.{k:03}000 pi stage[123]: u={u:.4f} y={y:.4f}\n")},
      {"a line of a service", written("", "2024-06-03T10:00:00.{k:03}Z INFO u={u:.4f} y={y:.4f}\n")},
      {"Python", written("2024-06-03 09:59:59,900 - INFO - started\n",
                         "2024-06-03 10:00:00,{k:03} - INFO - u={u:.4f} y={y:.4f}\n")},
      {"spdlog", written("", "[2024-06-03 10:00:00.{k:03}] [info] u={u:.4f}, y={y:.4f}\n")},
      {"glog", written("", "I0603 10:00:00.{k:03}000  1234 loop.cc:12] u={u:.4f} y={y:.4f}\n")},
      {"logfmt", written("", "ts=2024-06-03T10:00:00.{k:03}Z level=info msg=\"one loop\" u={u:.4f} y={y:.4f}\n")},
      {"a line for each signal",
       written("", "[1717408800.{k:03}] stage: u: {u:.4f}\n[1717408800.{k:03}] stage: y: {y:.4f}\n")},
      {"units behind the values", written("", "[1717408800.{k:03}] u={u:.4f}V y={y:.4f} um\n")},
      {"names of several words",
       written("", "[1717408800.{k:03}] stage: the u: {u:.4f}, the y: {y:.4f}\n"),
       {.columns = {{"u", "the u"}, {"y", "the y"}}}},
      {"other lines between", written("", "[1717408800.{k:03}] u={u:.4f} y={y:.4f}\n[1717408800.{k:03}] tick\n")},
      {"a time of the row's own", written("", "[10:00:00.{k:02}7] t={t:.3f} u={u:.4f} y={y:.4f}\n")},
      {"a time among the values", written("", "stage: time: 10:00:00.{k:03}, u: {u:.4f}, y: {y:.4f}\n")},
      {"commas and semicolons", written("", "[1717408800.{k:03}] u={u:.4f}; y={y:.4f};\r\n")},
  };
  for (const Dialect& one : logs) {
    expect_the_numbers(one);
  }
}

/// Read by their places, the numbers of two signals would be mixed without a word.
TEST(LogLine, ValuesGoByTheirNames) {
  const Record record = parse_record("log.txt", "t:0,u:1,y:3\nt:1,y:6,u:2\nu:3,y:9,t:2\n");
  EXPECT_EQ(record.column("u").values, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(record.column("y").values, (std::vector<double>{3.0, 6.0, 9.0}));
  EXPECT_DOUBLE_EQ(record.sample_time(), 1.0);
}

TEST(LogLine, WhatIsTakenAndLeftIsSaid) {
  std::string text = "I (10) boot: v5.1\n";
  for (int k = 0; k < 30; ++k) {
    text += fmt::format("I ({}) main: u: {},5 V y: true\n", 100 + 10 * k, k);
    text += k % 15 == 7 ? "I (123) wifi: rssi: -60\n" : "";
  }
  const Record record = parse_record("log.txt", text);
  EXPECT_EQ(record.size(), 30U);
  EXPECT_DOUBLE_EQ(record.sample_time(), 0.01);
  EXPECT_DOUBLE_EQ(record.column("u").values[3], 3.5);
  EXPECT_EQ(record.column("u").unit, "V");
  EXPECT_DOUBLE_EQ(record.column("y").values[3], 1.0);
  EXPECT_THAT(notes_of(record), HasSubstr("it is a log, whose values have names: u, y"));
  EXPECT_THAT(notes_of(record), HasSubstr("3 lines of the log hold other values or none, and are left out"));
  EXPECT_THAT(notes_of(record), HasSubstr("commas in its numbers are decimal ones"));
}

TEST(LogLine, PlacesAreThoseOfTheFile) {
  const std::string said =
      refusal_of("[1717408800.0001] a: u=1 y=3\n[1717408800.0002] a: u=2 y=6\n[1717408800.0003] a: u=x y=9\n");
  EXPECT_THAT(said, HasSubstr("log.csv:3:24"));
  EXPECT_THAT(said, HasSubstr("\"x\""));
  // Of a clock that counts whole seconds, the rows have to be counted.
  EXPECT_THAT(refusal_of("Jun 03 10:00:00 pi a[1]: u=1\nJun 03 10:00:00 pi a[1]: u=2\nJun 03 10:00:00 pi a[1]: u=3\n"),
              HasSubstr("--rate"));
}

TEST(LogLine, WhatIsNoLogIsNone) {
  for (const std::string_view text :
       {"u:1,y:3\nu:2,y:6\n", "t,u,y\n0,1,3\n1,2,6\n", "Gain: 3\nOffset: 2\nBias: 1\nt,u\n0,1\n1,2\n2,3\n3,4\n4,5\n",
        "u: 3\nu: 2\nu: 1\nt,u\n0,1\n1,2\n2,3\n3,4\n4,5\n", "Kp=3\nKi=2\nKd=0\n", "[INFO] tick\n[INFO] tock\n",
        "pos:1,2,u:3\npos:4,5,u:6\n", "[1234] u=1\n[1234] u=2\n",
        "[1717408800.001] u=1 u=2\n[1717408800.002] u=1 u=2\n"}) {
    EXPECT_FALSE(table_of_log(text, 0)) << text;
  }
  EXPECT_TRUE(table_of_log("head\n[1717408800.001] u=1\n[1717408800.002] u=2\n", 1));
}

}  // namespace
}  // namespace hysteron::records
