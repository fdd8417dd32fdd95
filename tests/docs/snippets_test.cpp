// Every snippet of the documentation is run: commands in the order of their page, in a folder of their own, with the
// tool that was just built; what they print is held against what the page shows.
//
//   ```st file=plant.st     a file, written to the folder (any kind)
//   ```st                   a diagram, checked: no error and no warning
//   ```toml                 a parameter file, read
//   ```sh                   commands; ```sh exit=1 where they end so
//   ```text expected        what the commands before it print; … stands for any text, alone on a line for any lines
//   ```cpp                 an excerpt of what is generated from the diagram before it
//   ```text ```console ```ebnf     shown only: formulas, commands that change the machine, grammar
//
// The commands of the README install and build; they are shown only.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/compile.hpp"
#include "codegen/language/syntax.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "tests/docs/page.hpp"
#include "tests/support/expected_text.hpp"

namespace hysteron::test {
namespace {

struct Outcome {
  int exit_code = 0;
  std::string output{};
};

/// Runs commands with the built programs first on the path; both streams, in their order.
Outcome run_shell(const std::filesystem::path& folder, const std::string& commands) {
  const auto tools = std::filesystem::path(HYSTERON_TOOL).parent_path();
  const auto script = folder.string() + "/.commands";
  std::ofstream(script) << "exec 2>&1\nset -e\ncd '" << folder.string() << "'\nPATH='" << tools.string() << "':'"
                        << (tools / "examples").string() << "':$PATH\n"
                        << "export HYSTERON_LIBRARY='" << (tools / "libhysteron.so").string() << "' PYTHONPATH='"
                        << (source_folder() / "bindings/python").string() << "' PYTHONDONTWRITEBYTECODE=1\n"
                        << "python3() { /usr/bin/python3 \"$@\"; }\n"
                        << commands;
  const std::string shell = "/bin/sh '" + script + "'";
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(shell.c_str(), "r"), nullptr);
  Outcome outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe.get())) > 0;) {
    outcome.output.append(buffer.data(), count);
  }
  const int status = ::pclose(pipe.release());
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// What is wrong with a diagram, one line each; empty where nothing is.
std::string faults_of_diagram(const std::string& text) {
  Diagnostics diagnostics;
  auto file = language::parse("snippet.st", text, diagnostics);
  if (file.valid) {
    check(std::make_shared<const language::SourceFile>(std::move(file)), diagnostics);
  }
  std::string faults;
  for (const Diagnostic& one : diagnostics.all()) {
    faults += "line " + std::to_string(one.place.line) + ": " + one.cause + "\n";
  }
  return faults;
}

/// The lines of an excerpt that the C++ generated from a diagram does not have, wherever it stands there.
std::string lines_not_generated(const std::string& diagram, const std::string& excerpt) {
  const auto without_indent = [](const std::string& line) {
    return line.substr(std::min(line.find_first_not_of(' '), line.size()));
  };
  std::set<std::string> generated;
  for (const std::string& line : lines_of(generate_cpp_header(compile_text(diagram)).text)) {
    generated.insert(without_indent(line));
  }
  std::string missing;
  for (const std::string& line : lines_of(excerpt)) {
    missing += generated.contains(without_indent(line)) ? "" : line + "\n";
  }
  return missing;
}

class PageRunner {
 public:
  explicit PageRunner(const Page& page) : page_(page) {}

  void run(const Snippet& snippet) {
    SCOPED_TRACE(page_.path.string() + ":" + std::to_string(snippet.line));
    if (snippet.has("file")) {
      folder_.write(snippet.attributes.find("file")->second, snippet.text);
    } else if (snippet.kind == "sh" && is_below(page_.path, "docs/")) {
      const auto exit_code = snippet.attributes.find("exit");
      last_ = run_shell(folder_.path(), snippet.text);
      EXPECT_EQ(last_.exit_code, exit_code == snippet.attributes.end() ? 0 : std::stoi(exit_code->second))
          << snippet.text << last_.output;
    } else if (snippet.kind == "text" && snippet.has("expected")) {
      EXPECT_TRUE(lines_match(lines_of(last_.output), 0, lines_of(snippet.text), 0)) << "expected\n"
                                                                                     << snippet.text << "printed\n"
                                                                                     << last_.output;
    } else if (snippet.kind == "st") {
      EXPECT_EQ(faults_of_diagram(snippet.text), "") << snippet.text;
      diagram_ = snippet.text;
    } else if (snippet.kind == "cpp") {
      EXPECT_EQ(lines_not_generated(diagram_, snippet.text), "");
    } else if (snippet.kind == "toml") {
      EXPECT_NO_THROW((void)parameters::parse_parameter_file("snippet.toml", snippet.text)) << snippet.text;
    } else {
      EXPECT_TRUE(snippet.kind == "text" || snippet.kind == "console" || snippet.kind == "ebnf" || snippet.kind == "sh")
          << "nothing runs a snippet of the kind '" << snippet.kind << "'";
    }
  }

 private:
  const Page& page_;
  ScratchFolder folder_;
  Outcome last_;
  std::string diagram_;  ///< the last one of the page
};

/// Pages whose snippets are not run here: those of diagnostics by the tests of their rooms, those of blocks printed.
bool has_runner_elsewhere(const std::filesystem::path& page) {
  return is_below(page, "docs/errors/") || is_below(page, "docs/reference/blocks/");
}

std::vector<std::filesystem::path> pages_with_snippets() {
  std::vector<std::filesystem::path> pages;
  for (const auto& path : all_pages()) {
    if (!has_runner_elsewhere(path) && !read_page(path).snippets.empty()) {
      pages.push_back(path);
    }
  }
  return pages;
}

std::string test_name(const testing::TestParamInfo<std::filesystem::path>& info) {
  auto name = info.param.lexically_relative(source_folder()).replace_extension().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

class Snippets : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Snippets, DoWhatThePageSays) {
  const Page page = read_page(GetParam());
  PageRunner runner(page);
  for (const Snippet& snippet : page.snippets) {
    runner.run(snippet);
    if (HasFailure()) {
      break;  // what follows builds on it
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Docs, Snippets, testing::ValuesIn(pages_with_snippets()), test_name);

/// A viewer shows no word that stands behind a fence, so the prose has to say which file a snippet is, and where what
/// is typed ends and what is printed begins.
TEST(SnippetCaptions, NameEachFileAndWhatIsPrinted) {
  std::size_t files = 0;
  std::size_t printed = 0;
  for (const auto& path : pages_with_snippets()) {
    for (const Snippet& snippet : read_page(path).snippets) {
      if (snippet.has("file")) {
        const auto name = "`" + snippet.attributes.find("file")->second + "`";
        EXPECT_NE(snippet.before.find(name), std::string::npos)
            << path.string() << ":" << snippet.line << ": the text before it does not name " << name;
        ++files;
      } else if (snippet.has("expected")) {
        EXPECT_NE(snippet.before.find("prints"), std::string::npos)
            << path.string() << ":" << snippet.line << ": the text before it does not say that this is printed";
        ++printed;
      }
    }
  }
  EXPECT_GT(files, 100U);
  EXPECT_GT(printed, 100U);
}

TEST(ExpectedText, GapsStandForAnyTextAndAnyLines) {
  const auto matches = [](const std::string& text, const std::string& pattern) {
    return lines_match(lines_of(text), 0, lines_of(pattern), 0);
  };
  EXPECT_TRUE(matches("a\nb 1.5 s\nc\n", "a\nb … s\n…\n"));
  EXPECT_TRUE(matches("a\n", "…\na\n…\n"));
  EXPECT_FALSE(matches("a\nb\n", "a\n"));
  EXPECT_FALSE(matches("a\n", "a\nb\n"));
  EXPECT_FALSE(matches("b 1.5 V\n", "b … s\n"));
}

}  // namespace
}  // namespace hysteron::test
