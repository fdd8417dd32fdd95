// The server: what it answers in this process, and the program over a pipe.
#include "lsp/server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "codegen/compile.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/language/token.hpp"
#include "lsp/symbols.hpp"
#include "support/text_file.hpp"

namespace hysteron {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string uri = "file:///plant.st";
const std::string diagram = R"(FUNCTION_BLOCK PLANT
VAR_INPUT
    X : LREAL;  (* @unit V *)
END_VAR
VAR_OUTPUT
    Y : LREAL;  (* @unit V *)
END_VAR
VAR
    FILTER : HY_LAG := (T1 := 0.1);
END_VAR
FILTER(XIN := X);
Y := FILTER.XOUT;
END_FUNCTION_BLOCK
)";

class LspServer : public ::testing::Test {
 protected:
  LspServer() { ask("initialize", {{"capabilities", json::object()}}); }

  json ask(const std::string& method, const json& params) {
    return server.handle({{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}).at(0);
  }
  json tell(const std::string& method, const json& params) {
    const auto answers = server.handle({{"jsonrpc", "2.0"}, {"method", method}, {"params", params}});
    return answers.empty() ? json() : answers.front();
  }
  json open(const std::string& text) {
    return tell("textDocument/didOpen", {{"textDocument", {{"uri", uri}, {"text", text}}}})["params"]["diagnostics"];
  }
  /// Asks at the place that ~ marks; the text is opened without it.
  json ask_at(const std::string& what, std::string marked) {
    const auto at = marked.find('~');
    marked.erase(at, 1);
    open(marked);
    const auto place = lsp::position_of(marked, at, lsp::Encoding::Utf16);
    return ask("textDocument/" + what,
               {{"textDocument", {{"uri", uri}}},
                {"position", {{"line", place.line}, {"character", place.character}}}})["result"];
  }
  static std::vector<std::string> labels(const json& items) {
    std::vector<std::string> names;
    for (const auto& one : items) {
      names.push_back(one["label"]);
    }
    return names;
  }
  /// The diagram with one stretch of it replaced.
  static std::string with(const std::string& part, const std::string& other) {
    auto text = diagram;
    return text.replace(text.find(part), part.size(), other);
  }

  lsp::Server server{[](const BlockType& block) { return "card of " + std::string(block.about.name); }};
};

TEST_F(LspServer, PublishesWhatCheckFinds) {
  EXPECT_EQ(open(diagram), json::array());
  const auto text = with("XIN := X", "XIN := NOWHERE");
  Diagnostics expected;
  auto parsed = std::make_shared<const language::SourceFile>(language::parse("/plant.st", text, expected));
  check(parsed, expected);
  const auto found = open(text);
  ASSERT_EQ(found.size(), expected.all().size());
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i]["code"], fmt::format("HY{:03}", expected.all()[i].number));
    EXPECT_EQ(found[i]["range"]["start"]["line"], expected.all()[i].place.line - 1);
    EXPECT_THAT(found[i]["message"].get<std::string>(), HasSubstr(expected.all()[i].mend));
  }
}

TEST_F(LspServer, AnIncrementalChangeIsTheWholeText) {
  open(diagram);
  const auto at = lsp::position_of(diagram, diagram.find("XIN := X") + 7, lsp::Encoding::Utf16);
  const json range = {{"start", {{"line", at.line}, {"character", at.character}}},
                      {"end", {{"line", at.line}, {"character", at.character + 1}}}};
  const auto changed = tell("textDocument/didChange", {{"textDocument", {{"uri", uri}}},
                                                       {"contentChanges", {{{"range", range}, {"text", "NOWHERE"}}}}});
  EXPECT_EQ(changed["params"]["diagnostics"], open(with("XIN := X", "XIN := NOWHERE")));
}

TEST_F(LspServer, HoverGivesTheCardAndThePin) {
  EXPECT_EQ(ask_at("hover", with("HY_LAG", "HY_~LAG"))["contents"]["value"], "card of HY_LAG");
  EXPECT_EQ(ask_at("hover", with("FILTER(", "FIL~TER("))["contents"]["value"], "card of HY_LAG");
  EXPECT_THAT(ask_at("hover", with(".XOUT", ".XO~UT"))["contents"]["value"].get<std::string>(), HasSubstr("output"));
  EXPECT_THAT(ask_at("hover", with("XIN :=", "X~IN :="))["contents"]["value"].get<std::string>(), HasSubstr("input"));
  EXPECT_TRUE(ask_at("hover", with("END_FUNCTION_BLOCK", "END_FUN~CTION_BLOCK")).is_null());
}

TEST_F(LspServer, CompletesInABrokenText) {
  open(diagram);
  EXPECT_THAT(labels(ask_at("completion", with("FILTER.XOUT;", "FILTER.~"))), ::testing::ElementsAre("XOUT", "RATE"));
  const auto pins = labels(ask_at("completion", with("XIN := X);", "~")));
  EXPECT_THAT(pins, Contains("XIN"));
  EXPECT_THAT(pins, Not(Contains("XOUT")));
  EXPECT_THAT(labels(ask_at("completion", with("HY_LAG := (T1 := 0.1);", "~"))), Contains("HY_LAG"));
  EXPECT_THAT(labels(ask_at("completion", with("XIN := X", "XIN := ~"))), Contains("X"));
  EXPECT_THAT(labels(ask_at("completion", with("FILTER(XIN := X);", "~"))), Contains("END_VAR"));
}

TEST_F(LspServer, CompletesAnnotationsAndUnits) {
  EXPECT_THAT(labels(ask_at("completion", with("@unit V", "@~"))), Contains("unit"));
  EXPECT_THAT(labels(ask_at("completion", with("@unit V", "@un~"))), Contains("ts"));
  const auto units = labels(ask_at("completion", with("@unit V", "@unit ~")));
  EXPECT_EQ(units.front(), "V") << "that of the other port";
  EXPECT_THAT(units, Contains("N*m"));
  std::string reason;
  for (const std::string& unit : units) {
    EXPECT_TRUE(units::is_unit(unit, reason)) << unit << ": " << reason;
  }
  EXPECT_EQ(ask_at("completion", with("@unit V", "a wo~rd")), json::array());
  EXPECT_EQ(ask_at("completion", with("@unit V", "@doc a ~")), json::array());
}

TEST_F(LspServer, MendsAMisspeltWord) {
  const json whole{{"start", {{"line", 0}, {"character", 0}}}, {"end", {{"line", 99}, {"character", 0}}}};
  const auto actions_for = [&](const json& diagnostics) {
    return ask(
        "textDocument/codeAction",
        {{"textDocument", {{"uri", uri}}}, {"range", whole}, {"context", {{"diagnostics", diagnostics}}}})["result"];
  };
  for (const auto& [right, wrong] : {std::pair("XIN := X", "XNI := X"),
                                     {"FILTER.XOUT", "FILTER.XUOT"},
                                     {"HY_LAG", "HY_LGA"},
                                     {"T1 := 0.1", "T11 := 0.1"}}) {
    const std::string text = with(right, wrong);
    const auto found = open(text);
    ASSERT_FALSE(found.empty()) << wrong;
    const json actions = actions_for(found);
    ASSERT_FALSE(actions.empty()) << found.dump();
    EXPECT_EQ(actions[0]["kind"], "quickfix");
    const json edit = actions[0]["edit"]["changes"][uri][0];
    const auto begin = lsp::offset_of(text, {edit["range"]["start"]["line"], edit["range"]["start"]["character"]},
                                      lsp::Encoding::Utf16);
    const auto end =
        lsp::offset_of(text, {edit["range"]["end"]["line"], edit["range"]["end"]["character"]}, lsp::Encoding::Utf16);
    std::string mended = text;
    mended.replace(begin, end - begin, edit["newText"].get<std::string>());
    EXPECT_EQ(mended, diagram);
  }
  open(with("Y := FILTER.XOUT;", ""));  // an output that nothing drives: something to think about
  EXPECT_EQ(actions_for(json::array()), json::array());
}

/// Two blocks, the outer with an instance of the inner one; X and Y are names in both.
const std::string nested = R"(FUNCTION_BLOCK INNER
VAR_INPUT
    X : LREAL;  (* @unit V *)
END_VAR
VAR_OUTPUT
    Y : LREAL;
END_VAR
Y := 2.0 * X;
END_FUNCTION_BLOCK

FUNCTION_BLOCK OUTER
VAR_INPUT
    X : LREAL;
END_VAR
VAR_OUTPUT
    Y : LREAL;
END_VAR
VAR
    PART : INNER;
END_VAR
PART(X := x);
Y := PART.Y + X;  (* X stays in a comment *)
END_FUNCTION_BLOCK
)";

std::string marked_in(const std::string& text, const std::string& part, const std::string& other) {
  auto result = text;
  return result.replace(result.find(part), part.size(), other);
}

/// The text of the lines and characters of a range.
std::string text_of(const std::string& text, const json& range) {
  const auto offset = [&](const json& at) {
    return lsp::offset_of(text, {at["line"].get<std::uint64_t>(), at["character"].get<std::uint64_t>()},
                          lsp::Encoding::Utf16);
  };
  return text.substr(offset(range["start"]), offset(range["end"]) - offset(range["start"]));
}

TEST_F(LspServer, APinOfAnOwnBlockIsAVariableOfThatBlock) {
  const auto pin = ask_at("definition", marked_in(nested, "PART.Y", "PART.Y~"));
  EXPECT_EQ(pin["range"]["start"]["line"], 5);
  EXPECT_EQ(ask_at("definition", marked_in(nested, "PART(X", "PART(~X"))["range"]["start"]["line"], 2);
  EXPECT_EQ(ask_at("definition", marked_in(nested, ":= x)", ":= ~x)"))["range"]["start"]["line"], 12);
  EXPECT_EQ(ask_at("definition", marked_in(nested, "PART : INNER", "PART : IN~NER"))["range"]["start"]["line"], 0);
  EXPECT_TRUE(ask_at("definition", marked_in(nested, "@unit V", "@unit V~")).is_null());
  EXPECT_TRUE(ask_at("definition", with("HY_LAG", "HY_~LAG")).is_null());
  EXPECT_EQ(ask_at("references", marked_in(nested, "PART.Y", "PART.~Y")).size(), 3U);
  EXPECT_THAT(ask_at("hover", marked_in(nested, "PART(X", "PART(~X"))["contents"]["value"].get<std::string>(),
              HasSubstr("INNER.X : LREAL\n@unit V"));
  open(nested);
  EXPECT_THAT(labels(ask_at("completion", marked_in(nested, "PART.Y", "PART.~"))), ::testing::ElementsAre("Y"));
  EXPECT_THAT(labels(ask_at("completion", marked_in(nested, "PART(X := x", "PART(~"))), ::testing::ElementsAre("X"));
}

TEST_F(LspServer, RenamesEveryPlaceAndNoOther) {
  open(nested);
  const auto at = lsp::position_of(nested, nested.find("PART.Y") + 5, lsp::Encoding::Utf16);
  json params = {{"textDocument", {{"uri", uri}}},
                 {"position", {{"line", at.line}, {"character", at.character}}},
                 {"newName", "DOUBLED"}};
  const auto edits = ask("textDocument/rename", params)["result"]["changes"][uri];
  ASSERT_EQ(edits.size(), 3U);
  for (const auto& edit : edits) {
    EXPECT_EQ(text_of(nested, edit["range"]), "Y");
    EXPECT_EQ(edit["newText"], "DOUBLED");
  }
  EXPECT_EQ(text_of(nested, ask("textDocument/prepareRename", params)["result"]), "Y");
  for (const std::string wrong : {"X", "IF", "2Y", "", "A B", "A;", "LREAL", "A__B"}) {
    params["newName"] = wrong;
    EXPECT_EQ(ask("textDocument/rename", params)["error"]["code"], -32803) << wrong;
  }
  open(with("FILTER(XIN", "FILTER((XIN"));
  params["newName"] = "OTHER";
  EXPECT_EQ(ask("textDocument/rename", params)["error"]["code"], -32803);
}

TEST_F(LspServer, OutlinesBlocksAndVariables) {
  open(nested);
  const auto outline = ask("textDocument/documentSymbol", {{"textDocument", {{"uri", uri}}}})["result"];
  ASSERT_EQ(outline.size(), 2U);
  EXPECT_EQ(outline[1]["name"], "OUTER");
  ASSERT_EQ(outline[1]["children"].size(), 3U);
  EXPECT_EQ(outline[1]["children"][2]["detail"], "INNER");
  EXPECT_EQ(text_of(nested, outline[1]["children"][2]["selectionRange"]), "PART");
}

/// A name that is given to everything in turn: the text stays right, and the name before brings the text back.
TEST_F(LspServer, EveryNameOfTheExamplesIsRenamedAndBack) {
  std::size_t renamings = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(HYSTERON_SOURCE_DIR "/examples")) {
    if (entry.path().extension() != ".st") {
      continue;
    }
    Diagnostics none;
    const auto text = read_text_file(entry.path().string());
    const auto tree = language::parse(entry.path().string(), text, none);
    if (!tree.valid || none.has_errors()) {
      continue;
    }
    for (const auto& block : tree.blocks) {
      for (const auto& variable : block.variables) {
        const lsp::Declared what{.block = &block, .variable = &variable};
        if (!lsp::refused_name(tree, what, "ANOTHER_NAME").empty()) {
          continue;  // what a file beside it names, as an input of a record
        }
        ++renamings;
        const auto places = lsp::places_of(tree, what);
        ASSERT_FALSE(places.empty()) << variable.name.text;
        const auto other = lsp::renamed(text, places, "ANOTHER_NAME");
        const auto other_tree = language::parse(entry.path().string(), other, none);
        ASSERT_TRUE(other_tree.valid);
        const auto back = lsp::places_of(other_tree, lsp::declared_at(other_tree, places.front().offset));
        ASSERT_EQ(back.size(), places.size()) << entry.path() << " " << variable.name.text;
        // Names are the same without regard to case: the text comes back as it was, but for that.
        EXPECT_EQ(language::upper(lsp::renamed(other, back, variable.name.text)), language::upper(text));
      }
    }
  }
  EXPECT_GT(renamings, 50U);
}

TEST_F(LspServer, FormatsAsFmtDoesAndRefusesAsFmtDoes) {
  const auto text = with("    FILTER : HY_LAG", "FILTER:HY_LAG");
  open(text);
  Diagnostics none;
  const json params = {{"textDocument", {{"uri", uri}}}};
  EXPECT_EQ(ask("textDocument/formatting", params)["result"][0]["newText"], format_text("plant.st", text, none));
  open(with("FILTER(XIN", "FILTER((XIN"));
  EXPECT_EQ(ask("textDocument/formatting", params)["error"]["code"], -32803);
}

TEST_F(LspServer, FaultsOfMessagesAreErrorsOfTheProtocol) {
  EXPECT_EQ(ask("textDocument/nothing", json::object())["error"]["code"], -32601);
  EXPECT_EQ(ask("textDocument/hover", json::object())["error"]["code"], -32602);
  EXPECT_EQ(ask("textDocument/hover", json::array())["error"]["code"], -32602);
  EXPECT_EQ(server.handle(json::array()).at(0)["error"]["code"], -32600);
  EXPECT_EQ(server.handle({{"id", 1}, {"method", 5}}).at(0)["error"]["code"], -32600);
  EXPECT_TRUE(server.handle({{"method", "$/cancelRequest"}, {"params", {{"id", 1}}}}).empty());
  EXPECT_TRUE(ask("shutdown", nullptr)["result"].is_null());
  EXPECT_EQ(ask("textDocument/hover", json::object())["error"]["code"], -32600);
}

TEST_F(LspServer, RandomEditsOfTheExamplesNeverEndIt) {
  std::mt19937 random(7);
  std::size_t tried = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(HYSTERON_SOURCE_DIR "/examples")) {
    if (entry.path().extension() != ".st" || tried >= 20) {
      continue;
    }
    ++tried;
    const auto text = read_text_file(entry.path().string());
    for (int edit = 0; edit < 10; ++edit) {
      auto broken = text;
      broken.erase(random() % broken.size(), random() % 40);
      broken.insert(random() % (broken.size() + 1), std::string(1, "(*).:;~#'\""[random() % 10]));
      open(broken);
      const auto at = lsp::position_of(broken, random() % broken.size(), lsp::Encoding::Utf16);
      const json params = {{"textDocument", {{"uri", uri}}},
                           {"position", {{"line", at.line}, {"character", at.character}}}};
      EXPECT_TRUE(ask("textDocument/hover", params).contains("result"));
      EXPECT_TRUE(ask("textDocument/completion", params).contains("result"));
    }
  }
  EXPECT_GT(tried, 0U);
}

/// What the extension colours as a word of the language is one.
TEST(VsCodeExtension, ItsGrammarKnowsTheWordsOfTheLanguage) {
  const std::string folder = HYSTERON_SOURCE_DIR "/editors/vscode/";
  for (const char* file : {"package.json", "language-configuration.json"}) {
    EXPECT_TRUE(json::accept(read_text_file(folder + file))) << file;
  }
  const auto grammar = json::parse(read_text_file(folder + "syntaxes/hysteron-st.tmLanguage.json"));
  std::size_t words = 0;
  for (const auto& pattern : grammar["patterns"]) {
    const std::string match = pattern.value("match", "");
    const std::string begin = "(?i)\\b(";
    const std::string end = ")\\b";
    if (!match.starts_with(begin) || !match.ends_with(end) || match.find('[') != std::string::npos) {
      continue;
    }
    std::istringstream list(match.substr(begin.size(), match.size() - begin.size() - end.size()));
    for (std::string one; std::getline(list, one, '|'); ++words) {
      EXPECT_TRUE(language::keyword_of(one) != language::Keyword::None || language::is_elementary_type(one)) << one;
    }
  }
  EXPECT_GT(words, 40U);
}

std::string framed(const std::string& text) {
  return fmt::format("Content-Length: {}\r\n\r\n{}", text.size(), text);
}

TEST(LspFrames, BrokenFramesAreAnsweredAndReadingGoesOn) {
  std::istringstream in("Nonsense: 1\r\n\r\n" + framed("{") + framed(R"({"id":1,"method":"textDocument/hover"})") +
                        framed(R"({"id":2,"method":"initialize","params":{}})") +
                        framed(R"({"id":3,"method":"shutdown"})") + framed(R"({"method":"exit"})"));
  std::ostringstream out;
  EXPECT_EQ(lsp::serve(in, out, {}), 0);
  EXPECT_THAT(out.str(), HasSubstr("-32700"));
  EXPECT_THAT(out.str(), HasSubstr("-32002"));
  EXPECT_THAT(out.str(), HasSubstr(R"("id":3)"));
}

TEST(LspFrames, AStreamThatEndsWithoutLeaveIsAFailure) {
  std::istringstream in("Content-Length: 50\r\n\r\n{");
  std::ostringstream out;
  EXPECT_EQ(lsp::serve(in, out, {}), 1);
}

}  // namespace
}  // namespace hysteron
