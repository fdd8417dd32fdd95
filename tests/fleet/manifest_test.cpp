// What a manifest may hold, and what it is told where it may not.
#include "fleet/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

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
  EXPECT_EQ(errors("machine,diagram,params,log,colour\n"), (Errors{{error::duplicate_column, 1}}));
  EXPECT_EQ(errors("\"machine,diagram,params,log\n"), (Errors{{error::ragged_row, 1}}));
  EXPECT_EQ(errors(header + "A,a.st,p.toml\n,a.st,p.toml,x.csv\nA,none.st,p.toml,x.csv\n\"A,a.st,p.toml,x.csv\n"
                            "\"A\" B,a.st,p.toml,x.csv\nA,a.st,p.toml,x.csv\n"),
            (Errors{{error::ragged_row, 2},
                    {error::bad_usage, 3},
                    {error::unreadable_file, 4},
                    {error::ragged_row, 5},
                    {error::ragged_row, 6}}));
}

TEST_F(Manifest, ARecordThatIsNotThereIsNoErrorOfTheManifest) {
  EXPECT_EQ(read("machine,diagram,params,log\nA,a.st,p.toml,none.csv\n").size(), 1U);
}

}  // namespace
}  // namespace hysteron::fleet
