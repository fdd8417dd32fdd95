// The pages of the errors of the command line keep their word: run as they stand, the failing text fails with the
// number of the page, and the mended one does not.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/errors.hpp"
#include "tests/support/error_page.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

/// The files below `## Given`: blocks whose info string ends in a name, such as ```csv log.csv.
std::map<std::string, std::string> given_files(const std::string& page) {
  std::map<std::string, std::string> files;
  std::istringstream lines(page);
  std::string open;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("```")) {
      files[open] += open.empty() ? "" : line + "\n";
    } else if (const auto space = line.find(' '); open.empty() && space != std::string::npos) {
      open = line.substr(space + 1);
    } else {
      open.clear();
    }
  }
  files.erase("");
  return files;
}

/// What is done with a text of a kind: it becomes a file, and a command reads it.
std::string command_for(const test::Workbench& bench, const test::FencedBlock& block) {
  if (block.kind == "sh") {
    return block.text.substr(0, block.text.find('\n'));
  }
  if (block.kind == "toml") {
    bench.write("plant.test.toml", block.text);
    return "hysteron test plant.st --no-generated";
  }
  bench.write(block.kind == "st" ? "plant.st" : "log.csv", block.text);
  return "hysteron run plant.st --in log.csv --out out.csv";
}

class ErrorPages : public testing::TestWithParam<int> {};

TEST_P(ErrorPages, FailAndMend) {
  const auto number = GetParam();
  const auto name = "HY" + std::to_string(number);
  const auto page = test::read_error_page(name);
  EXPECT_EQ(page.number, name);
  std::string title;
  for (const auto& entry : error_titles()) {
    title = entry.number == number ? entry.title : title;
  }
  EXPECT_EQ(page.title, title);

  const test::Workbench bench;
  for (const auto& [file, text] :
       given_files(test::contents_of(std::string(HYSTERON_SOURCE_DIR) + "/docs/errors/" + name + ".md"))) {
    bench.write(file, text);
  }
  const auto failed = bench.shell(command_for(bench, page.fails));
  const bool warning = number == error::input_out_of_range || number == error::fmu_without_binary;
  EXPECT_EQ(failed.code, warning                                                                    ? 0
                         : number == error::output_not_finite || number == error::limits_contradict ? 1
                                                                                                    : 2)
      << failed.err;
  EXPECT_TRUE(failed.err.starts_with(name + (warning ? " warning: " : " error: "))) << failed.err;
  const auto mended = bench.shell(command_for(bench, page.mended));
  EXPECT_EQ(mended.code, 0) << mended.out;
  EXPECT_EQ(mended.err, "");
}

/// 530 to 549 are those of goals; 700 is tested with the files that it is about, 710 to 719 are those of fits.
std::vector<int> numbers() {
  std::vector<int> result;
  for (const auto& entry : error_titles()) {
    if ((entry.number >= 530 && entry.number < 550) || (entry.number >= 704 && entry.number < 710) ||
        (entry.number >= 720 && entry.number < 800)) {
      result.push_back(entry.number);
    }
  }
  return result;
}

INSTANTIATE_TEST_SUITE_P(OfTheCommandLine, ErrorPages, testing::ValuesIn(numbers()),
                         [](const auto& page) { return "HY" + std::to_string(page.param); });

}  // namespace
}  // namespace hysteron
