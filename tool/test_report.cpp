#include "tool/test_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "support/markup.hpp"
#include "support/utf8.hpp"

namespace hysteron::tool {
namespace {

std::string indented(const std::string& text, std::string_view indent) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    result += fmt::format("{}{}\n", indent, line);
  }
  return result;
}

std::string failures_text(const CaseResult& one, std::string_view indent) {
  std::string text;
  for (const Failure& failure : one.failures) {
    text += indented(failure.cause, indent) + indented(failure.plot, indent);
  }
  return text;
}

std::size_t failed_in(const FileResult& result) {
  return static_cast<std::size_t>(std::count_if(result.cases.begin(), result.cases.end(),
                                                [](const CaseResult& one) { return !one.failures.empty(); }));
}

/// Text for XML, attributes included. Control characters but for tab and line feed cannot stand in XML at all.
std::string xml_text(std::string_view text) {
  std::string result;
  for (auto end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    result += printable(text.substr(0, end)) + "\n";
    text.remove_prefix(end + 1);
  }
  return escaped(result + printable(text));
}

}  // namespace

std::string report_text(const FileResult& result, bool colour) {
  const auto coloured = [&](std::string_view code, std::string_view word) {
    return colour ? fmt::format("\033[{}m{}\033[0m", code, word) : std::string(word);
  };
  std::string text = result.file + "\n";
  for (const CaseResult& one : result.cases) {
    text += fmt::format("  {}  {}{}\n", one.failures.empty() ? coloured("32", "pass") : coloured("1;31", "FAIL"),
                        printable(one.name), one.note.empty() ? "" : " (" + one.note + ")");
    text += failures_text(one, "        ");
  }
  return text;
}

std::size_t failed_cases(const std::vector<FileResult>& results) {
  std::size_t failed = 0;
  for (const FileResult& result : results) {
    failed += failed_in(result);
  }
  return failed;
}

std::string closing_line(const std::vector<FileResult>& results) {
  std::size_t all = 0;
  for (const FileResult& result : results) {
    all += result.cases.size();
  }
  const auto failed = failed_cases(results);
  return fmt::format("{} passed, {} failed\n", all - failed, failed);
}

std::string junit_text(const std::vector<FileResult>& results) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const FileResult& result : results) {
    double seconds = 0.0;
    for (const CaseResult& one : result.cases) {
      seconds += one.seconds;
    }
    text += fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" time=\"{:.3f}\">\n",
                        xml_text(result.file), result.cases.size(), failed_in(result), seconds);
    for (const CaseResult& one : result.cases) {
      text += fmt::format(R"(    <testcase name="{}" classname="{}" time="{:.3f}")", xml_text(one.name),
                          xml_text(result.file), one.seconds);
      if (one.failures.empty()) {
        text += "/>\n";
        continue;
      }
      text += fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
                          xml_text(one.failures.front().cause), xml_text(failures_text(one, "")));
    }
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace hysteron::tool
