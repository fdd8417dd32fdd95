#include "support/render.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "support/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

Diagnostic at(std::uint32_t line, std::uint32_t column, std::uint32_t length) {
  return {.number = error::unknown_pin,
          .severity = Severity::Error,
          .place = {.file = "plant.st", .line = line, .column = column, .length = length},
          .cause = "HY_GAIN has no pin XNI.",
          .mend = "did you mean XIN?"};
}

Note note(Place place, std::string text) {
  Note result;
  result.place = std::move(place);
  result.text = std::move(text);
  return result;
}

Sources with(std::string_view text) {
  Sources sources;
  sources.put("plant.st", text);
  return sources;
}

/// The column (in characters) at which the carets begin in the third line of a rendering.
std::pair<std::string, std::string> lines_two_and_three(const std::string& text) {
  const auto second = text.find('\n') + 1;
  const auto third = text.find('\n', second) + 1;
  return {text.substr(second, third - 1 - second), text.substr(third, text.find('\n', third) - third)};
}

TEST(Render, LineCaretMendAndNotes) {
  auto sources = with("first\n  AMP(XNI := U);\nlast\n");
  auto diagnostic = at(2, 7, 3);
  diagnostic.notes.push_back(note(Place{.file = "plant.st", .line = 1, .column = 1, .length = 5}, "declared here"));
  EXPECT_EQ(as_text(diagnostic, sources),
            "HY202 error: plant.st:2:7: HY_GAIN has no pin XNI.\n"
            "    2 |   AMP(XNI := U);\n"
            "      |       ^^^\n"
            "mend: did you mean XIN?\n"
            "note: plant.st:1:1: declared here\n"
            "    1 | first\n"
            "      | ^^^^^\n");
}

TEST(Render, CaretsStayBelowTheirCharacters) {
  auto tabs = with("\tA\t(XNI)\n");
  EXPECT_EQ(lines_two_and_three(as_text(at(1, 5, 3), tabs)),
            std::pair(std::string("    1 | \tA\t(XNI)"), std::string("      | \t \t ^^^")));
  auto beyond_ascii = with("(* µΩ *) XNI\n");
  EXPECT_EQ(lines_two_and_three(as_text(at(1, 10, 3), beyond_ascii)),
            std::pair(std::string("    1 | (* µΩ *) XNI"), std::string("      |          ^^^")));
  auto windows = with("Weg [\xB5m];XNI\n");  // as loggers of Windows write it
  EXPECT_EQ(lines_two_and_three(as_text(at(1, 10, 3), windows)),
            std::pair(std::string("    1 | Weg [µm];XNI"), std::string("      |          ^^^")));
}

TEST(Render, CaretsEndWithTheLine) {
  auto sources = with("\xEF\xBB\xBFX := 1\r\nY");
  EXPECT_EQ(lines_two_and_three(as_text(at(1, 6, 500), sources)).second, "      |      ^");
  EXPECT_EQ(lines_two_and_three(as_text(at(1, 99, 1), sources)).second, "      |       ^") << "just behind the end";
  EXPECT_THAT(as_text(at(2, 1, 1), sources), HasSubstr("    2 | Y\n"));
}

TEST(Render, OfALongLineAnExcerpt) {
  const std::string line = std::string(5000, 'a') + "µXNI" + std::string(5000, 'b');
  auto sources = with(line);
  const auto [text, carets] = lines_two_and_three(as_text(at(1, 5002, 3), sources, {.width = 60}));
  EXPECT_LT(text.size(), 80U);
  EXPECT_THAT(text, HasSubstr("| …a"));
  EXPECT_THAT(text, EndsWith("b…"));
  // 20 characters of lead, of which the µ takes two bytes; the ellipsis takes three.
  EXPECT_EQ(text.find("XNI"), std::string("    1 | ").size() + 3 + 20 + 1);
  EXPECT_EQ(carets, "      | " + std::string(21, ' ') + "^^^");
  EXPECT_EQ(lines_two_and_three(as_text(at(1, 1, 10004), sources, {.width = 60})).second,
            "      | " + std::string(60, '^'));
}

TEST(Render, WithoutTextOrPlaceTheMessageStands) {
  Sources sources;
  EXPECT_EQ(as_text(at(3, 1, 1), sources),
            "HY202 error: plant.st:3:1: HY_GAIN has no pin XNI.\nmend: did you mean XIN?\n");
  Diagnostic nowhere;
  nowhere.number = 700;
  nowhere.severity = Severity::Warning;
  nowhere.cause = "So.";
  EXPECT_EQ(as_text(nowhere, sources), "HY700 warning: So.\n");
  auto short_text = with("one line");
  EXPECT_THAT(as_text(at(9, 1, 1), short_text), Not(HasSubstr("|")));
}

/// Nobody writes into it any more: to open it again would wait for ever.
TEST(Render, APipeIsNotWaitedFor) {
  const test::ScratchFolder folder;
  const std::string pipe = folder / "pipe.st";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  Sources sources;
  EXPECT_EQ(sources.line(pipe, 1), std::nullopt);
}

TEST(Render, CountsAtTheEnd) {
  Sources sources;
  Diagnostics list;
  EXPECT_EQ(as_text(list, sources), "");
  list.add(at(1, 1, 1));
  EXPECT_THAT(as_text(list, sources), EndsWith("\n\n1 error\n"));
  list.add(at(2, 1, 1));
  list.warning(error::unit_mismatch, {}, "cause", "mend");
  EXPECT_THAT(as_text(list, sources), EndsWith("\n\n2 errors, 1 warning\n"));
}

TEST(Render, OfManyAlikeTheFirst) {
  Sources sources;
  Diagnostics list;
  for (std::uint32_t line = 1; line <= 25; ++line) {
    list.add(at(line, 1, 1));
  }
  list.warning(error::unit_mismatch, {}, "another cause", "mend");
  const std::string text = as_text(list, sources, {.alike = 3});
  EXPECT_THAT(text, HasSubstr("plant.st:3:1:"));
  EXPECT_THAT(text, Not(HasSubstr("plant.st:4:1:")));
  EXPECT_THAT(text, HasSubstr("another cause"));
  EXPECT_THAT(text, EndsWith("\n\nHY202: 22 more like these; the first 3 are shown.\n\n25 errors, 1 warning\n"));
}

TEST(Render, EveryLineOfALongTextIsFound) {
  std::string text = "\xEF\xBB\xBF";
  for (int line = 1; line <= 1000; ++line) {
    text += "line " + std::to_string(line) + (line % 2 == 0 ? "\r\n" : "\n");
  }
  Sources sources = with(text + "end");
  for (std::uint32_t line = 1; line <= 1000; ++line) {
    EXPECT_EQ(sources.line("plant.st", line), "line " + std::to_string(line));
  }
  EXPECT_EQ(sources.line("plant.st", 1001), "end");
  EXPECT_EQ(sources.line("plant.st", 1002), std::nullopt);
}

TEST(Render, ColourOnlyWhereAskedFor) {
  auto sources = with("XNI");
  EXPECT_THAT(as_text(at(1, 1, 3), sources), Not(HasSubstr("\033")));
  EXPECT_THAT(as_text(at(1, 1, 3), sources, {.colour = true}), HasSubstr("\033[1;31m^^^\033[0m"));
  std::FILE* const no_terminal = std::tmpfile();
  EXPECT_FALSE(wants_colour(no_terminal));
  std::fclose(no_terminal);
}

TEST(Render, HostileTextIsMadeHarmless) {
  auto sources = with("X\033[2J\xB5");
  auto diagnostic = at(1, 7, 1);
  diagnostic.cause = "no pin \033]0;title\007.";
  const auto text = as_text(diagnostic, sources);
  EXPECT_THAT(text, Not(HasSubstr("\033")));
  EXPECT_THAT(text, Not(HasSubstr("\007")));
  Diagnostics list;
  list.add(diagnostic);
  EXPECT_NO_THROW((void)as_json(list).dump());
}

TEST(Render, JsonHasEveryField) {
  Diagnostics list;
  auto diagnostic = at(2, 7, 3);
  diagnostic.notes.push_back(note(Place{.file = "plant.st"}, "declared here"));
  list.add(diagnostic);
  const auto json = nlohmann::json::parse(as_json(list).dump());
  EXPECT_EQ(json, nlohmann::json::parse(R"([{"number": "HY202", "title": "Unknown pin", "severity": "error",
    "file": "plant.st", "line": 2, "column": 7, "length": 3, "cause": "HY_GAIN has no pin XNI.",
    "mend": "did you mean XIN?", "page": "docs/errors/HY202.md",
    "notes": [{"file": "plant.st", "text": "declared here"}]}])"));
}

TEST(ErrorTitles, AreSortedAndUnique) {
  std::set<std::string_view> titles;
  int last = 0;
  for (const auto& [number, title] : error_titles()) {
    EXPECT_GT(number, last);
    EXPECT_TRUE(titles.insert(title).second) << title;
    EXPECT_EQ(title_of(number), title);
    last = number;
  }
  EXPECT_EQ(title_of(999), "");
}

}  // namespace
}  // namespace hysteron
