// The server: what it answers in this process, and the program over a pipe.
#include "lsp/server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "codegen/compile.hpp"
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
  EXPECT_EQ(ask_at("completion", with("@unit V", "@un~it V")), json::array());
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
