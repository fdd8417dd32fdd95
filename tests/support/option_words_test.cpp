#include "support/option_words.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <vector>

#include "tests/house/source_files.hpp"

namespace hysteron {
namespace {

std::string in_c(std::string_view text) {
  return in_words_of(Caller::C, text);
}

std::string in_python(std::string_view text) {
  return in_words_of(Caller::Python, text);
}

TEST(OptionWords, NameAnOptionWithItsValueAsTheCallerWritesIt) {
  struct Case {
    std::string_view command_line;
    std::string_view c;
    std::string_view python;
  };
  for (const Case& one : {
           Case{"read the rows before it: --rows 1..60, or record it again.",
                R"(read the rows before it: {"rows": "1..60"}, or record it again.)",
                R"(read the rows before it: rows="1..60", or record it again.)"},
           Case{"read one part alone: --rows 1..8 or --rows 9..; done.",
                R"(read one part alone: {"rows": "1..8"} or {"rows": "9.."}; done.)",
                R"(read one part alone: rows="1..8" or rows="9.."; done.)"},
           Case{"say so: --column U=MAIN.u[mV].", R"(say so: {"columns": {"U": "MAIN.u[mV]"}}.)",
                R"(say so: columns={"U": "MAIN.u[mV]"}.)"},
           Case{"as --column U=2.", R"(as {"columns": {"U": 2}}.)", R"(as columns={"U": 2}.)"},
           Case{"write --limit U=5.0: the input.", R"(write {"limits": {"U": 5.0}}: the input.)",
                R"(write limits={"U": 5.0}: the input.)"},
           Case{"say which: --time t.", R"(say which: {"time": "t"}.)", R"(say which: time="t".)"},
           Case{"such as --rate 1000.", R"(such as {"rate": "1000"}.)", R"(such as rate="1000".)"},
           Case{"leave them out: --skip 3.", R"(leave them out: {"skip": 3}.)", "leave them out: skip=3."},
           Case{"read it with --resample hold.", R"(read it with {"resample": "hold"}.)",
                R"(read it with resample="hold".)"},
           Case{"of one signal, --resample Q=hold.", R"(of one signal, {"resample": {"Q": "hold"}}.)",
                R"(of one signal, resample={"Q": "hold"}.)"},
           Case{"With --any-order this is", R"(With {"any_order": true} this is)", "With any_order=True this is"},
           Case{"give it as --log LOG.csv.", R"(give it as the argument records, "LOG.csv".)",
                R"(give it as records="LOG.csv".)"},
           Case{"search from --start 20, or", R"(search from {"starts": 20}, or)", "search from starts=20, or"},
       }) {
    EXPECT_EQ(in_c(one.command_line), one.c);
    EXPECT_EQ(in_python(one.command_line), one.python);
    EXPECT_EQ(in_words_of(Caller::CommandLine, one.command_line), one.command_line);
  }
}

TEST(OptionWords, NameAnOptionAloneAsWhatItIs) {
  EXPECT_EQ(in_c("name one of these with --column."), "name one of these with the option \"columns\".");
  EXPECT_EQ(in_python("name one of these with --column."), "name one of these with the argument columns.");
  EXPECT_EQ(in_c("leave --log out, or"), "leave the argument records out, or");
  EXPECT_EQ(in_c("give it more time with --fmu-time-limit, or"),
            "give it more time with the option `--fmu-time-limit` of the tool, or");
  EXPECT_EQ(in_python("It drifts. --range takes a part."), "It drifts. The argument range takes a part.");
  EXPECT_EQ(in_c("name its column by --u, and"), "name its column by the argument u, and");
}

TEST(OptionWords, LeaveCommandsAndWhatTheLibraryHasNot) {
  for (const std::string_view text : {"move it, as `hysteron fmt --any-order` does.", "two -- or three -- words",
                                      "a--rows 1..2", "no option: --rowses 1"}) {
    EXPECT_EQ(in_python(text), text);
    EXPECT_EQ(in_c(text), text);
  }
}

// What a file is named as comes back whole, whatever signs are in it.
TEST(OptionWords, AValueComesBackWhole) {
  for (const std::string value :
       {"Motor speed[rpm]", "it's", "t.", "\"u\"", "a\\b", "Zeit (s)", "U=V=W", "µ", "60..", "x,y"}) {
    const std::string written = "say so: --column " + option_value("N=" + value) + ".";
    std::string literal;
    for (const char c : value) {
      literal += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
    }
    EXPECT_EQ(in_python(written), "say so: columns={\"N\": \"" + literal + "\"}.") << written;
  }
  EXPECT_EQ(option_value("MAIN.u[mV]"), "MAIN.u[mV]");
}

TEST(OptionWords, CausesAndNotesAreWorded) {
  Diagnostics found;
  found.error(730, {}, "--rows 5 cannot be read.", "write --rows 1..60.", {{.place = {}, .text = "by --rate"}});
  const Diagnostics worded = in_words_of(Caller::Python, found);
  ASSERT_EQ(worded.all().size(), 1U);
  EXPECT_EQ(worded.all()[0].cause, "rows=\"5\" cannot be read.");
  EXPECT_EQ(worded.all()[0].mend, "write rows=\"1..60\".");
  EXPECT_EQ(worded.all()[0].notes[0].text, "by the argument rate");
}

/// The texts in a line of C++, without what is a comment.
std::vector<std::string> texts_in(const std::string& line) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line.compare(at, 2, "//") == 0) {
      break;
    }
    if (line[at] != '"' || (at > 0 && line[at - 1] == '\'')) {
      continue;
    }
    std::string text;
    for (++at; at < line.size() && line[at] != '"'; ++at) {
      at += line[at] == '\\' && at + 1 < line.size() ? 1 : 0;
      text += line[at];
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

/// Whether an option of the command line is named, beside commands in backticks.
bool names_an_option(const std::string& text) {
  bool is_command = false;
  for (std::size_t at = 0; at + 2 < text.size(); ++at) {
    is_command = text[at] == '`' ? !is_command : is_command;
    const bool is_word = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
    if (!is_command && is_word && text.compare(at, 2, "--") == 0 &&
        std::islower(static_cast<unsigned char>(text[at + 2])) != 0) {
      return true;
    }
  }
  return false;
}

/// What the library does not do: it writes no file of a target and brings in none.
bool is_of_the_tool_alone(const std::string& path) {
  return path.starts_with("codegen/backends/") || path.starts_with("codegen/import/");
}

// Held over every text of the rooms that the library is made of: a new option of a mend has to be among
// library_options().
TEST(OptionWords, EveryMendThatTheLibraryCanGiveIsInTheWordsOfItsCaller) {
  std::size_t named = 0;
  for (const house::SourceText& file :
       house::source_files({"support", "records", "codegen", "tuning", "diagnosis", "bindings"})) {
    if (is_of_the_tool_alone(file.path) || file.path.starts_with("support/option_words")) {
      continue;
    }
    bool is_command = false;  // a command in backticks that goes over the end of a line
    for (const std::string& line : file.lines) {
      for (const std::string& text : texts_in(line)) {
        const std::string whole = is_command ? "`" + text : text;
        if (names_an_option(whole)) {
          ++named;
          EXPECT_FALSE(names_an_option(in_python(whole))) << file.path << ": " << whole;
          EXPECT_FALSE(names_an_option(in_c(whole))) << file.path << ": " << whole;
        }
        is_command = std::ranges::count(whole, '`') % 2 == 1;
      }
    }
  }
  EXPECT_GT(named, 40U);  // 60 and more
}

}  // namespace
}  // namespace hysteron
