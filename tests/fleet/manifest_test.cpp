// What a manifest may hold, and what it is told where it may not.
#include "fleet/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fleet/when.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::fleet {
namespace {

class Manifest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("a.st", "diagram");
    folder_.write("p.toml", "");
  }
  std::vector<Unit> read(const std::string& text) { return read_manifest(folder_.write("fleet.csv", text)); }

  /// Number and line of each error.
  std::vector<std::pair<int, std::uint32_t>> errors(const std::string& text) {
    try {
      (void)read(text);
    } catch (const InputError& problem) {
      std::vector<std::pair<int, std::uint32_t>> found;
      for (const Diagnostic& one : problem.diagnostics().all()) {
        found.emplace_back(one.number, one.place.line);
        EXPECT_FALSE(one.cause.empty() || one.mend.empty());
      }
      return found;
    }
    return {};
  }
  test::ScratchFolder folder_;
};

TEST_F(Manifest, HasItsColumnsInAnyOrder) {
  const auto units = read(
      "\xEF\xBB\xBFlog, machine ,diagram,params,when,group\r\n\r\n# a note\r\n"
      "x.csv,\"press \"\"2\"\", left\",a.st,p.toml,2026-01-02,presses\r\n /y.csv , M2,a.st,p.toml,,");
  ASSERT_EQ(units.size(), 2U);
  EXPECT_EQ(units[0].machine, "press \"2\", left");
  EXPECT_EQ(units[0].log, folder_ / "x.csv");
  EXPECT_EQ(units[0].diagram, folder_ / "a.st");
  EXPECT_EQ(units[0].when, "2026-01-02");
  EXPECT_EQ(units[0].group, "presses");
  EXPECT_EQ(units[0].line, 4U);
  EXPECT_EQ(units[1].log, "/y.csv");
  EXPECT_EQ(units[1].when, "");
}

TEST_F(Manifest, ErrorsAreOfTheirLinesAndAllAreTold) {
  using Errors = std::vector<std::pair<int, std::uint32_t>>;
  const std::string header = "machine,diagram,params,log\n";
  EXPECT_EQ(errors(""), (Errors{{error::missing_header, 0}}));
  EXPECT_EQ(errors("\n# only a note\n"), (Errors{{error::missing_header, 0}}));
  EXPECT_EQ(errors(header), (Errors{{error::bad_usage, 0}}));
  EXPECT_EQ(errors("machine,diagram,log\nA,a.st,x.csv\n"), (Errors{{error::missing_column, 1}}));
  EXPECT_EQ(errors("machine,diagram,params,log,log\n"), (Errors{{error::duplicate_column, 1}}));
  EXPECT_EQ(errors("machine,diagram,params,log,colour\n"), (Errors{{error::unknown_manifest_column, 1}}));
  EXPECT_EQ(errors("\"machine,diagram,params,log\n"), (Errors{{error::ragged_row, 1}}));
  EXPECT_EQ(errors(header + "A,a.st,p.toml\n,a.st,p.toml,x.csv\nA,none.st,p.toml,x.csv\n\"A,a.st,p.toml,x.csv\n"
                            "\"A\" B,a.st,p.toml,x.csv\nA,a.st,p.toml,x.csv\n"),
            (Errors{{error::ragged_row, 2},
                    {error::bad_usage, 3},
                    {error::unreadable_file, 4},
                    {error::ragged_row, 5},
                    {error::ragged_row, 6}}));
}

TEST_F(Manifest, ATimeIsADateOrSecondsSince1970) {
  const auto time_of = [&](const std::string& when) {
    return read("machine,diagram,params,log,when\nA,a.st,p.toml,x.csv,\"" + when + "\"\n").at(0).time;
  };
  EXPECT_TRUE(std::isnan(time_of("")));
  EXPECT_EQ(time_of("2026-01-02"), 1767312000.0);
  EXPECT_EQ(time_of("2026-01-02T06:30"), 1767312000.0 + 23400.0);
  EXPECT_EQ(time_of("2026-01-02 06:30:00.5Z"), 1767312000.0 + 23400.5);
  EXPECT_EQ(time_of("2026-01-02T06:30:00+02:00"), 1767312000.0 + 16200.0);
  EXPECT_EQ(time_of("1767312000"), 1767312000.0);
  EXPECT_EQ(time_of("1767312000.25"), 1767312000.25);
  for (const char* const when :
       {"2026", "20260102", "1767312000000", "02.01.2026", "1/2/2026", "2026-13-01", "2026-02-30", "Monday", "06:30",
        "2026-01-02T25:00", "-1767312000", "1767312000 s", "1,767e9"}) {
    EXPECT_EQ(errors("machine,diagram,params,log,when\nA,a.st,p.toml,x.csv,\"" + std::string(when) + "\"\n"),
              (std::vector<std::pair<int, std::uint32_t>>{{error::no_date, 2}}))
        << when;
  }
  EXPECT_EQ(date_text(1767312000.0), "2026-01-02");
  EXPECT_EQ(date_text(1767312000.0 + 23400.5), "2026-01-02 06:30");
  EXPECT_EQ(date_text(-60.0), "1969-12-31 23:59");
}

TEST_F(Manifest, ALineMayNameItsCommand) {
  const auto units = read(
      "machine,command,diagram,params,log\nA,tune,a.st,p.toml,x.csv\nA,,a.st,p.toml,x.csv\n"
      "A,check,a.st,,\n");
  ASSERT_EQ(units.size(), 3U);
  EXPECT_EQ(units[0].command, Command::Tune);
  EXPECT_EQ(units[1].command, Command::Diagnose);
  EXPECT_EQ(units[2].command, Command::Check);
  EXPECT_EQ(errors("machine,command,diagram,params,log\nA,draw,a.st,p.toml,x.csv\nA,tune,a.st,,x.csv\n"),
            (std::vector<std::pair<int, std::uint32_t>>{{error::bad_usage, 2}, {error::bad_usage, 3}}));
  const std::string bare = folder_.write("bare.csv", "machine,diagram\nA,a.st\n");
  EXPECT_EQ(read_manifest(bare, Command::Check).at(0).command, Command::Check);
  EXPECT_THROW((void)read_manifest(bare, Command::Tune), InputError);
  // A goal has a signal of its own.
  const std::string goals = folder_.write("goals.csv", "machine,diagram,params\nA,a.st,p.toml\n");
  EXPECT_EQ(read_manifest(goals, Command::Tune).at(0).log, "");
  EXPECT_THROW((void)read_manifest(goals, Command::Diagnose), InputError);
}

TEST_F(Manifest, ARecordThatIsNotThereIsNoErrorOfTheManifest) {
  EXPECT_EQ(read("machine,diagram,params,log\nA,a.st,p.toml,none.csv\n").size(), 1U);
}

}  // namespace
}  // namespace hysteron::fleet
