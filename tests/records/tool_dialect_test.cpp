// Further tools of the field, and what their files could be mistaken for: read to the same numbers, said, or refused.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "records/read.hpp"
#include "records/statistics.hpp"
#include "records/text/csv_line.hpp"
#include "records/text/unit_text.hpp"
#include "tests/records/dialect.hpp"
#include "tests/records/refusal.hpp"

namespace hysteron::records {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using namespace std::string_literals;

std::vector<Dialect> dialects() {
  constexpr std::string_view plain = "{t:.3f},{u:.4f},{y:.4f}\n";
  std::string parts;
  for (int part = 0; part < 4; ++part) {
    parts +=
        fmt::format("Channels\t2\t\nSamples\t10\t10\t\nX0\t{0:.3f}\t{0:.3f}\t\n***End_of_Header***\t\t\n", 0.01 * part);
    parts += "X_Value\tu\ty\tComment\n";
    for (int k = 10 * part; k < 10 * part + 10; ++k) {
      parts += fmt::format("{:.3f}\t{:.4f}\t{:.4f}\n", 1e-3 * k, drive(k), 3.0 * drive(k));
    }
    parts += "\n";
  }
  return {
      {"names and types between marks, of Ignition",
       written("#NAMES\n\"t_stamp\",\"u\",\"y\"\n#TYPES\n\"date\",\"dbl\",\"dbl\"\n#ROWS\n\"40\"\n",
               "\"2024-06-03 10:00:00.{k:03}\",\"{u:.4f}\",\"{y:.4f}\"\n")},
      {"names above a mark, of VBOX",
       written("[column names]\ntime u y\n\n[data]\n", "100000.{k:03} {u:+.4f} {y:+.4f}\n")},
      {"names above a run, of LTspice",
       written("time\tu\ty\nStep Information: K=3  (Run: 1/2)\n", "{t:.15e}\t{u:.4f}\t{y:.4f}\n")},
      {"names between other separators", written("t,u,y\n", "{t:.3f};{u:.4f};{y:.4f}\n")},
      {"settings with colons, of Keysight",
       written("Points:,40\nXInc:,1.0E-03\nXOrg:,0.0\nXUnits:,second\nYUnits:,Volt\nData:\n", "{u:.4f},{y:.4f}\n"),
       {.rate = 1000.0, .columns = {{"u", "1"}, {"y", "2"}}}},
      {"a head before each part, of LabVIEW", parts},
      {"half days in Spanish", written("Fecha;Hora;u;y\n", "03/06/2024;10:00:00,{k:03} a. m.;{u:.4f};{y:.4f}\n")},
      {"zeros behind the text", written("t,u,y\n", plain, std::string(700, '\0'))},
      {"an empty flash memory behind the text", written("t,u,y\n", plain, std::string(700, '\xFF'))},
      {"names with blanks that cannot be seen", written("t\xC2\xA0,\xE2\x80\x8Bu\xC2\xA0,y\xC2\xA0\n", plain)},
      {"names with quotes, of TIA Portal",
       written("Sample;Time;\"DB\".u;\"DB\".y\n;ms;V;um\n", "{k};{k};{u:.4f};{y:.4f}\n"),
       {.columns = {{"u", "DB.u"}, {"y", "DB.y"}}}},
      {"quotes of one stroke", written("'t','u','y'\n", "'{t:.3f}','{u:.4f}','{y:.4f}'\n")},
      {"the dash of a spreadsheet",
       [&] {
         std::string text = written("t,u,y\n", plain);
         for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos;) {
           text.replace(at, 1, "\xE2\x80\x93");
         }
         return text;
       }()},
  };
}

TEST(ToolDialect, EachHoldsTheSameNumbers) {
  for (const Dialect& one : dialects()) {
    expect_the_numbers(one);
  }
}

/// A unit that is lost makes a gain 1,000 times too small, without a word.
TEST(ToolDialect, TheUnitIsFoundWhereverItStands) {
  const std::string_view row = "{t:.3f},{u:.4f},{y:.4f}\n";
  const std::pair<std::string_view, std::string> cases[] = {
      {"above the names", written("s,mV,um\nt,u,y\n", row)},
      {"above the names, with a gap", written(",mV,um\nt,u,y\n", row)},
      {"above the names, with a key", written("Einheit;s;mV;um\nKanal;t;u;y\n", ";{t:.3f};{u:.4f};{y:.4f}\n")},
      {"beside each channel, of TwinCAT",
       written("Name;u;Name;y\nSampleTime[ms];1;SampleTime[ms];1\nUnit;mV;Unit;um\n\n", "{k};{u:.4f};{k};{y:.4f}\n")},
      {"written out", written("t,u,y\nseconds,millivolts,microns\n", row)},
      {"half written out", written("t,u,y\n(sec),(mVolts),(Mikrometer)\n", row)},
      {"in words behind in", written("t,u in millivolts,y in micrometers\n", row)},
      {"behind a colon", written("t:s,u:mV,y: um\n", row)},
      {"behind a dash", written("t - s,u - mV,y - um\n", row)},
      {"behind a blank", written("t s,u mV,y um\n", row)},
      {"in braces", written("t{s},u{mV},y {um}\n", row)},
      {"in angles", written("t <s>,u <mV>,y <um>\n", row)},
  };
  for (const auto& [name, text] : cases) {
    SCOPED_TRACE(name);
    Record record = Record::even(0.0, 1.0, 0);
    ASSERT_NO_THROW(record = parse_record("log.csv", text)) << text.substr(0, 100);
    ASSERT_NE(record.find("u"), nullptr) << fmt::format("{}", fmt::join(record.names(), ", "));
    ASSERT_NE(record.find("y"), nullptr);
    EXPECT_EQ(record.column("u").unit, "mV");
    EXPECT_EQ(record.column("y").unit, "um");
    EXPECT_DOUBLE_EQ(record.sample_time(), 1e-3);
  }
  // No units: letters of channels, a name of two words, a path.
  for (const std::string_view head : {"A,B,C\nt,u,y\n", "Rig,Run,Day\nt,u,y\n"}) {
    EXPECT_EQ(parse_record("log.csv", written(head, row)).column("u").unit, "");
  }
  for (const std::string_view name : {"Channel A", "Motor speed", "u deg", "y - max", "MAIN.u", "10:00:00", "AI0: u"}) {
    EXPECT_EQ(split_header(name).name, name);
  }
  EXPECT_EQ(unit_of_word("Millivolt"), "mV");
  EXPECT_EQ(unit_of_word("KiloNewtons"), "kN");
  EXPECT_EQ(unit_of_word("mOhm"), "mOhm");
  EXPECT_EQ(unit_of_word("meter"), "m");
  EXPECT_EQ(unit_of_word("Meteor"), "Meteor");
}

/// What is left out or taken as it stands is said.
TEST(ToolDialect, WhatIsLeftAsideIsSaid) {
  const std::pair<std::string, std::string_view> cases[] = {
      {"t,u\n0,1\n1,2\n2,3\n"s + std::string(9, '\0'), "the last 9 bytes"},
      {"t,u\n0,1\n#1,2\n2,3\n4,5\n", "1 line between the rows is a remark, with as many numbers"},
      {"Name;t;u\nScale;1;0.001\nUnit;s;V\n;0;1\n;1;2\n;2;3\n", "Scale 0.001 of column u"},
      {"Name;u;Name;y\nSampleTime[ms];1;SampleTime[ms];1\nScaleFactor;0.5;ScaleFactor;1\n\n0;1;0;3\n1;2;1;6\n2;3;2;9\n",
       "ScaleFactor 0.5 of column u"},
      {"t,u\n0,1\n1,-9999\n2,3\n3,2\n", "column u holds -9999 in 1 row, where its other numbers go from 1 to 3"},
      {"t,u\n0,1\n1,2\n2,32767\n3,2\n4,32767\n", "--rows 1..2"},
  };
  for (const auto& [text, said] : cases) {
    SCOPED_TRACE(text);
    Record record = Record::even(0.0, 1.0, 0);
    ASSERT_NO_THROW(record = parse_record("log.csv", text));
    EXPECT_THAT(fmt::format("{}", fmt::join(record.notes(), "\n")), HasSubstr(std::string(said)));
  }
  const Record plain = parse_record("log.csv", "# t,u\n# rig 4\nt,u\n0,1\n1,2\n");
  EXPECT_THAT(fmt::format("{}", fmt::join(plain.notes(), "\n")), Not(HasSubstr("remark, with")));
}

TEST(ToolDialect, MarksOfMissingLieFarOutside) {
  using Values = std::vector<double>;
  EXPECT_EQ(mark_of_missing(Values{1.0, 2.0, -7999.0, 3.0})->value, -7999.0);
  EXPECT_EQ(mark_of_missing(Values{1.0, 2.0, 3.0, 1e34})->first, 3U);
  EXPECT_FALSE(mark_of_missing(Values{9000.0, 9999.0, 10500.0}));         // a pressure that was measured
  EXPECT_FALSE(mark_of_missing(Values{0.0, 65535.0, 65535.0, 65535.0}));  // a switch
  EXPECT_FALSE(mark_of_missing(Values{-1.0, 0.0, 500.0}));
  EXPECT_FALSE(mark_of_missing(Values{}));
}

TEST(ToolDialect, MendsAreForThisFile) {
  const std::pair<std::string, std::string_view> cases[] = {
      {"t,u\n0,1\n1,(0.5)\n2,3\n", "write -0.5"},
      {"t,u\n0,1\n1,0.5-\n2,3\n", "write -0.5"},
      {"t,u\n0,[0.5]\n1,[0.6]\n2,[0.7]\n", "write the number alone, 0.5"},
      {"t,u\n0,np.float64(-0.5)\n1,np.float64(1)\n", "write the number alone, -0.5"},
      {"t,u\n0,1\n1,0.5V\n2,3\n", "write the number alone, 0.5"},
      {"t,u\n0,1\n1,500m\n2,3\n", "may be a prefix"},
      {"t,u\n0,1\n1,2\n2,+9.91E+37\n3,3\n", "--rows 1..2"},
      {"Sample,u\n0,1\n1,2\n2,3\n", "column Sample counts the rows"},
      {"t,u\n0,1\n1,2\n\nt,u\n0,1\n1,3\n", "--rows 1..2"},
      {"t,u\n0,1\n1,2\n\n0,1\n1,3\n", "--rows 1..2"},
      {"Delta_X\t0.001\t0.002\t\n***End_of_Header***\t\t\nX_Value\tu\ty\tComment\n\t1\t2\n\t2\t3\n\t3\t4\n",
       "each signal with its time"},
  };
  for (const auto& [text, mend] : cases) {
    SCOPED_TRACE(text);
    const std::string said = refusal_of(text);
    EXPECT_THAT(said.substr(said.find("mend: ")), HasSubstr(std::string(mend)));
  }
}

TEST(ToolDialect, FormatsOfOtherProgramsAreNamed) {
  const std::pair<std::string, std::string_view> cases[] = {
      {"# Created by Octave 7\n# name: t\n# type: matrix\n# rows: 2\n# columns: 1\n 0\n 1\n# name: u\n", "Octave"},
      {"rig,host=a u=0.3,y=1 1717408800000000000\n", "InfluxDB"},
      {"$date\n today\n$end\n$enddefinitions $end\n#0\n", "VCD"},
      {"    -1\n    58\n", "UFF"},
      {"--- file type: CFG ---\nrig,1,1999\n", "COMTRADE"},
      {"date Mon Jun 3 10:00:00 2024\nbase hex  timestamps absolute\n", "CAN frames"},
      {"(1717408800.001000) can0 100#0011223344556677\n", "CAN frames"},
  };
  for (const auto& [bytes, said] : cases) {
    SCOPED_TRACE(bytes);
    EXPECT_THAT(refusal_of(bytes), HasSubstr("HY513"));
    EXPECT_THAT(refusal_of(bytes), HasSubstr(std::string(said)));
  }
  // Text that only looks like them.
  EXPECT_EQ(
      parse_record("log.csv", "# Created by Octave 7\n# name: log\n# type: matrix\n0 1\n1 2\n2 3\n", {.time = "1"})
          .size(),
      3U);
}

}  // namespace
}  // namespace hysteron::records
