// `hysteron new`: each template makes a folder that runs, and its README is true.
#include <gmock/gmock.h>

#include <set>
#include <string>

#include "tests/docs/page.hpp"
#include "tests/support/expected_text.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class NewFolder : public testing::TestWithParam<const char*> {};

TEST_P(NewFolder, EachCommandOfItsReadmePrintsWhatItSays) {
  const test::Workbench bench;
  const auto made = bench.shell(std::string("hysteron new mine --template ") + GetParam());
  ASSERT_EQ(made.code, 0) << made.err;
  for (const char* file : {"plant.st", "plant.toml", "plant.test.toml", "machine.st", "log.csv", "README.md"}) {
    EXPECT_TRUE(bench.has(std::string("mine/") + file)) << file;
    EXPECT_THAT(made.out, HasSubstr(std::string("mine/") + file + "\n"));
  }
  EXPECT_THAT(bench.read("mine/README.md"), AllOf(HasSubstr("# mine\n"), testing::Not(HasSubstr("@NAME@"))));
  const auto page = test::read_page(bench.path() / "mine" / "README.md");
  std::size_t commands = 0;
  std::string printed;
  for (const test::Snippet& snippet : page.snippets) {
    if (snippet.kind == "sh") {
      const auto outcome = bench.shell("cd mine && " + snippet.text);
      EXPECT_EQ(outcome.code, 0) << snippet.text << outcome.err;
      printed = outcome.out;
      ++commands;
    } else if (snippet.kind == "text") {
      const auto patterns = test::lines_of(snippet.text);
      EXPECT_TRUE(test::lines_match(test::lines_of(printed), 0, patterns, 0)) << snippet.text << "is not\n" << printed;
      EXPECT_GT(patterns.size(), 1U);
    }
  }
  EXPECT_EQ(commands, 3U);
  // The one that a line of its table gives, too.
  const std::string of_own_log = "hysteron record LOG --for plant.st --params plant.toml";
  EXPECT_THAT(bench.read("mine/README.md"), HasSubstr("`" + of_own_log + "`"));
  const auto own = bench.shell("cd mine && LOG=log.csv && " + std::string(of_own_log).replace(16, 3, "$LOG"));
  EXPECT_EQ(own.code, 0) << own.err;
}

TEST_P(NewFolder, ItsTextsAreInTheLayoutOfTheHouse) {
  const test::Workbench bench;
  ASSERT_EQ(bench.shell(std::string("hysteron new mine --template ") + GetParam()).code, 0);
  const auto checked =
      bench.shell("cd mine && hysteron check plant.st machine.st && hysteron fmt --check plant.st machine.st");
  EXPECT_EQ(checked.code, 0) << checked.out << checked.err;
  // The record is that of the machine, whoever runs it.
  EXPECT_EQ(
      bench
          .shell(
              "cd mine && hysteron run machine.st --in log.csv --out again.csv && hysteron compare log.csv again.csv")
          .code,
      0);
}

INSTANTIATE_TEST_SUITE_P(Templates, NewFolder, testing::Values("piezo", "servo", "heater", "tank", "pid"),
                         [](const auto& one) { return std::string(one.param); });

TEST(NewCommand, AllTemplatesAreTested) {
  const test::Workbench bench;
  std::string options = bench.shell("hysteron new --help").out;
  EXPECT_THAT(options, HasSubstr("heater|pid|piezo|servo|tank"));
}

TEST(NewCommand, NeverOverwrites) {
  const test::Workbench bench;
  bench.write("there/README.md", "mine");
  bench.write("file", "mine");
  for (const char* name : {"there", "there/", "./there", "file", "there/../there"}) {
    const auto outcome = bench.shell(std::string("hysteron new ") + name + " --template piezo");
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("HY730"), HasSubstr("there already"))) << name;
  }
  EXPECT_EQ(bench.shell("ln -s nowhere link && hysteron new link --template piezo").code, 2);
  EXPECT_EQ(bench.read("there/README.md"), "mine");
  EXPECT_EQ(bench.read("file"), "mine");
  EXPECT_EQ(bench.names(), (std::set<std::string>{"file", "link", "there", "there/README.md"}));
}

TEST(NewCommand, SaysWhatThereIs) {
  const test::Workbench bench;
  EXPECT_THAT(bench.shell("hysteron new x --template pieso").err,
              AllOf(HasSubstr("HY730"), HasSubstr("did you mean piezo?")));
  EXPECT_THAT(bench.shell("hysteron new x --template 9").err, HasSubstr("heater, pid, piezo, servo, tank"));
  EXPECT_THAT(bench.shell("hysteron new no/such/x --template pid").err, HasSubstr("HY700"));
  EXPECT_TRUE(bench.names().empty());
}

}  // namespace
}  // namespace hysteron
