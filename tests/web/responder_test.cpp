// What the live page answers, and how a set of parameters gets from it to the task: through the task's own door.
#include "runtime/web/responder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "runtime/task/task_door.hpp"
#include "runtime/web/assets.hpp"
#include "runtime/web/parameter_text.hpp"
#include "tests/runtime/history/history_bench.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/web/web_client.hpp"

namespace hysteron::runtime::web {
namespace {

using nlohmann::json;

const std::string bearer = std::string("Bearer ") + test::token;

/// G.A from -1e9 to 1e9, in mm, and at least G.B.
struct PageBench {
  explicit PageBench(Access access)
      : responder(door, {.name = "ACCUMULATOR", .period = 1'000'000}, std::move(access)) {}

  static const test::Accumulator& with_unit(test::Accumulator& program) {
    program.mutable_shape().parameters[0].unit = "mm";
    program.mutable_shape().relations = {{.numbers = {{.parameter = 1}, {.parameter = 0}}}};
    program.mutable_shape().inner = {{.name = "SUM.XOUT", .unit = "um"}};
    return program;
  }
  Answer get(std::string_view target, std::string_view authorization = {}) {
    return responder.answer(
        {.method = "GET", .target = target, .host = "127.0.0.1:8080", .authorization = authorization});
  }
  Answer post(std::string_view target, std::string_view body = {}, std::string_view authorization = bearer) {
    return responder.answer(
        {.method = "POST", .target = target, .host = "localhost", .authorization = authorization, .body = body});
  }
  std::string refusal(std::string_view target, std::string_view body = {}) {
    const Answer answer = post(target, body);
    return answer.status == 422 ? json::parse(answer.body).at("refusal").get<std::string>()
                                : "status " + std::to_string(answer.status);
  }
  [[nodiscard]] std::vector<PointWrite> staged() {
    LiveValues live;
    door.read_live(live);
    return live.staged;
  }

  test::Accumulator program;
  TaskDoor door{with_unit(program), {{}}, {{}, {}}};
  Responder responder;
};

TEST(WebResponder, DescribesWhatThereIsToBeSeen) {
  PageBench bench({.token = test::token});
  const Answer answer = bench.get("/api/description");
  EXPECT_EQ(answer.status, 200U);
  const json about = json::parse(answer.body);
  EXPECT_EQ(about["name"], "ACCUMULATOR");
  EXPECT_EQ(about["period"], 0.001);
  EXPECT_EQ(about["writable"], true);
  EXPECT_EQ(about["token_to_read"], false);
  ASSERT_EQ(about["points"].size(), bench.door.points().size());
  EXPECT_EQ(about["points"][0]["name"], "X");
  EXPECT_EQ(about["points"][0]["kind"], "input");
  EXPECT_EQ(about["points"][0]["type"], "real");
  EXPECT_EQ(about["points"][0]["data_type"], "real64");
  EXPECT_EQ(about["points"][0]["unit"], "V");
  EXPECT_EQ(about["points"][0]["low"], nullptr);
  EXPECT_EQ(about["points"][3]["high"], 1e9);
  EXPECT_EQ(about["inner"],
            json::parse(R"([{"name": "SUM.XOUT", "type": "real", "data_type": "real64", "unit": "um"}])"));
}

TEST(WebResponder, GivesTheValuesOfTheNewestCycle) {
  PageBench bench({});
  const std::vector<double> inputs{0.1};
  const std::vector<double> outputs{1.0 / 3.0, std::numeric_limits<double>::quiet_NaN()};
  LoopStatistics statistics;
  statistics.run = 42;
  bench.door.publish(bench.program, inputs, outputs, {.state = TaskState::running}, statistics);
  const json values = json::parse(bench.get("/api/values").body);
  EXPECT_EQ(values["cycle"], 42);
  EXPECT_EQ(values["values"][0].get<double>(), 0.1);
  EXPECT_EQ(values["values"][1].get<double>(), 1.0 / 3.0) << "to the bit";
  EXPECT_EQ(values["values"][2], nullptr) << "JSON has no NaN";
  EXPECT_EQ(values["inner"].size(), 1U);
  EXPECT_EQ(values["staged"], json::array());
}

TEST(WebResponder, GivesMetricsWithWhatCountsNotWhatIsStaged) {
  PageBench bench({.token = test::token});
  EXPECT_EQ(bench.post("/api/stage", R"({"G.A": 2.5})").status, 200U);
  const Answer answer = bench.get("/metrics");
  EXPECT_EQ(answer.status, 200U);
  EXPECT_EQ(answer.type, metrics_type);
  EXPECT_NE(answer.body.find("\nhysteron_parameter_g_a{point=\"G.A\",unit=\"mm\"} 1\n"), std::string::npos);
  EXPECT_EQ(bench.post("/metrics").status, 404U);
}

TEST(WebResponder, AResetIsOrderedByWhoMayWrite) {
  PageBench bench({.token = test::token, .read_token = "a-token-for-reading-0123456789"});
  EXPECT_EQ(bench.post("/api/reset", {}, "").status, 401U);
  EXPECT_EQ(bench.post("/api/reset", {}, "Bearer a-token-for-reading-0123456789").status, 403U);
  EXPECT_EQ(bench.get("/api/reset").status, 404U);
  EXPECT_EQ(PageBench({}).post("/api/reset").status, 403U) << "read-only without a token file";
  EXPECT_EQ(bench.door.take_orders(), nullptr);
  EXPECT_EQ(bench.post("/api/reset").status, 200U);
  const TaskOrders* const orders = bench.door.take_orders();
  ASSERT_NE(orders, nullptr);
  EXPECT_EQ(orders->resets, 1U);
  EXPECT_EQ(orders->commits, 0U);
}

TEST(WebResponder, SavesTheParametersThatCountAndNotThoseThatWait) {
  PageBench bench({.token = test::token});
  EXPECT_EQ(bench.post("/api/stage", R"({"G.A": 2.5, "G.B": -2.5})").status, 200U);
  const Answer answer = bench.get("/api/parameters.toml");
  EXPECT_EQ(answer.status, 200U);
  EXPECT_EQ(answer.type, "application/toml");
  EXPECT_EQ(answer.body,
            "# Parameters that counted in ACCUMULATOR when this was saved.\n\n[parameters.G]\nA = 1.0\nB = -1.0\n");
  EXPECT_EQ(bench.post("/api/parameters.toml").status, 404U);
  PageBench beyond({.is_loopback = false, .token = test::token});
  EXPECT_EQ(beyond.responder.answer({.method = "GET", .target = "/api/parameters.toml", .host = "machine:80"}).status,
            401U);
}

TEST(WebParameterText, EveryKindOfParameterIsWrittenAsAParameterFileHasIt) {
  const auto parameter = [](const char* name, PointType type) {
    return Point{.name = name, .kind = PointKind::parameter, .type = type};
  };
  const std::vector<Point> points{
      {.name = "U", .kind = PointKind::input},    parameter("CTRL.INNER.KP", PointType::real64),
      parameter("K[0]", PointType::real64),       parameter("K[1]", PointType::real64),
      parameter("LAG.T1", PointType::real64),     parameter("LAG.MAX", PointType::real64),
      parameter("ON", PointType::boolean),        parameter("N", PointType::int32),
      parameter("TABLE.X[0]", PointType::real64), parameter("TABLE.X[1]", PointType::real64)};
  const std::vector<double> values{9.0,  0.1,
                                   1.0,  -2.5,
                                   0.05, std::numeric_limits<double>::infinity(),
                                   1.0,  7.0,
                                   1.0,  std::numeric_limits<double>::infinity()};
  EXPECT_EQ(parameter_text("P", points, values),
            "# Parameters that counted in P when this was saved.\n\n"
            "[parameters]\nK = [1.0, -2.5]\nON = true\nN = 7\n\n"
            "[parameters.CTRL.INNER]\nKP = 0.1\n\n"
            "[parameters.LAG]\nT1 = 0.05\n# MAX is not finite, and stays as the diagram has it\n\n"
            "[parameters.TABLE]\n# X is not finite, and stays as the diagram has it\n");
}

TEST(WebResponder, ASetIsStagedThenCommittedWhole) {
  PageBench bench({.token = test::token});
  EXPECT_EQ(bench.post("/api/stage", R"({"G.A": 2.5, "G.B": -2.5})").status, 200U);
  EXPECT_EQ(bench.staged().size(), 2U);
  EXPECT_EQ(bench.door.take_orders()->commits, 0U) << "staged values reach no step";
  const json values = json::parse(bench.get("/api/values").body);
  EXPECT_EQ(values["staged"], json::parse("[[3, 2.5], [4, -2.5]]"));
  EXPECT_EQ(values["values"][3], 1.0) << "what counts is what counted before";
  EXPECT_EQ(bench.post("/api/commit").status, 200U);
  const TaskOrders* const orders = bench.door.take_orders();
  ASSERT_NE(orders, nullptr);
  EXPECT_EQ(orders->commits, 1U);
  EXPECT_EQ(orders->parameters, (std::vector<double>{2.5, -2.5}));
  EXPECT_TRUE(bench.staged().empty());
}

TEST(WebResponder, WhatIsStagedIsHeldAgainstItsType) {
  test::Accumulator program;
  for (ProgramSignal& parameter : program.mutable_shape().parameters) {
    parameter.low = -std::numeric_limits<double>::infinity();
    parameter.high = std::numeric_limits<double>::infinity();
  }
  program.mutable_shape().parameters[0].type = PointType::int32;
  program.mutable_shape().parameters[1].type = PointType::uint16;
  TaskDoor door(program, {{}}, {{}, {}});
  Responder responder(door, {.name = "ACCUMULATOR", .period = 1'000'000}, {.token = test::token});
  const auto answered = [&](const char* body) {
    const Answer answer = responder.answer(
        {.method = "POST", .target = "/api/stage", .host = "localhost", .authorization = bearer, .body = body});
    return std::to_string(answer.status) + " " + json::parse(answer.body).value("refusal", "");
  };
  EXPECT_EQ(answered(R"({"G.A": 2147483648})"),
            "422 G.A takes whole numbers from -2147483648 to 2147483647; 2147483648 was given.");
  EXPECT_EQ(answered(R"({"G.A": 1.5})"), "422 G.A takes a whole number.");
  EXPECT_EQ(answered(R"({"G.B": -1})"), "422 G.B takes whole numbers from 0 to 65535; -1 was given.");
  EXPECT_EQ(answered(R"({"G.B": 65536})"), "422 G.B takes whole numbers from 0 to 65535; 65536 was given.");
  EXPECT_EQ(answered(R"({"G.A": -2147483648, "G.B": 65535})"), "200 ");
}

TEST(WebResponder, ARefusalSaysWhyAndChangesNothing) {
  PageBench bench({.token = test::token});
  EXPECT_EQ(bench.refusal("/api/stage", R"({"G.B": 1, "G.A": 2e9})"),
            "G.A must be at most 1000000000 mm; 2000000000 was given.");
  EXPECT_EQ(bench.refusal("/api/stage", R"({"G.A": -2e9})"),
            "G.A must be at least -1000000000 mm; -2000000000 was given.");
  EXPECT_EQ(bench.refusal("/api/stage", R"({"G.C": 1})"), "There is no parameter G.C.");
  EXPECT_EQ(bench.refusal("/api/stage", R"({"X": 1})"), "X is no parameter; parameters alone are staged.");
  EXPECT_EQ(bench.refusal("/api/stage", R"({"task.reset": 1})"),
            "task.reset is no parameter; parameters alone are staged.");
  EXPECT_EQ(bench.refusal("/api/stage", R"({"G.A": "1"})"), "G.A is not given a number.");
  EXPECT_EQ(bench.refusal("/api/stage", R"({"G.A": null})"), "G.A is not given a number.");
  EXPECT_TRUE(bench.staged().empty()) << "all or none";
  for (const char* const body : {"", "1", "[]", "{}", "{", R"({"G.A": 1e999})", R"({"G.A": NaN})"}) {
    EXPECT_EQ(bench.post("/api/stage", body).status, 400U) << body;
  }
  EXPECT_EQ(bench.post("/api/stage", std::string(60'000, '[')).status, 400U);
  const std::string beyond = bench.post("/api/stage", R"({"G.A": 1e999})").body;
  EXPECT_NE(beyond.find("beyond what a double holds"), std::string::npos) << beyond;
  // The set as a whole is refused at the commit, and stays staged to be mended.
  EXPECT_EQ(bench.post("/api/stage", R"({"G.A": -3})").status, 200U);
  (void)bench.door.take_orders();
  EXPECT_EQ(bench.refusal("/api/commit"), "G.A = -3 must be at least G.B = -1.");
  EXPECT_EQ(bench.door.take_orders(), nullptr) << "nothing reaches the task";
  EXPECT_EQ(bench.staged().size(), 1U);
  EXPECT_EQ(bench.post("/api/discard").status, 200U);
  EXPECT_TRUE(bench.staged().empty());
}

TEST(WebResponder, WithoutATokenFileEverythingIsReadOnly) {
  PageBench bench({});
  for (const char* const target : {"/api/stage", "/api/commit", "/api/discard"}) {
    EXPECT_EQ(bench.post(target, R"({"G.A": 2})").status, 403U);
    EXPECT_EQ(bench.post(target, R"({"G.A": 2})", "Bearer ").status, 403U);
  }
  EXPECT_EQ(json::parse(bench.get("/api/description").body)["writable"], false);
  EXPECT_TRUE(bench.staged().empty());
}

TEST(WebResponder, WhoWritesHasTheToken) {
  PageBench bench({.token = test::token});
  for (const char* const target : {"/api/stage", "/api/commit", "/api/discard"}) {
    for (const char* const wrong : {"", "Bearer ", "Bearer 0123456789abcdeg", "0123456789abcdef"}) {
      EXPECT_EQ(bench.post(target, R"({"G.A": 2})", wrong).status, 401U);
    }
  }
  EXPECT_TRUE(bench.staged().empty());
  EXPECT_EQ(bench.get("/api/values").status, 200U) << "on the loopback, reading is free";
}

TEST(WebResponder, BeyondTheLoopbackReadingNeedsTheTokenToo) {
  PageBench bench({.is_loopback = false, .token = test::token});
  for (const char* const target : {"/api/description", "/api/values", "/metrics"}) {
    EXPECT_EQ(bench.get(target).status, 401U);
    EXPECT_EQ(bench.get(target).body.find("ACCUMULATOR"), std::string::npos);
    EXPECT_EQ(bench.get(target, bearer).status, 200U);
  }
  EXPECT_EQ(bench.get("/").status, 200U) << "the page itself holds no values";
}

TEST(WebResponder, ATokenForReadingChangesNothing) {
  PageBench bench({.is_loopback = false, .token = test::token, .read_token = "a-token-to-read-with"});
  const std::string_view reader = "Bearer a-token-to-read-with";
  for (const char* const target : {"/api/description", "/api/values", "/metrics"}) {
    EXPECT_EQ(bench.get(target, reader).status, 200U);
    EXPECT_EQ(bench.get(target, bearer).status, 200U);
    EXPECT_EQ(bench.get(target, "Bearer a-token-to-read-wit").status, 401U);
  }
  for (const char* const target : {"/api/stage", "/api/commit", "/api/discard"}) {
    const Answer refused = bench.post(target, R"({"G.A": 2})", reader);
    EXPECT_EQ(refused.status, 403U);
    EXPECT_NE(refused.body.find("for reading"), std::string::npos);
    EXPECT_EQ(refused.body.find("a-token-to-read-with"), std::string::npos);
  }
  EXPECT_TRUE(bench.staged().empty());
  EXPECT_EQ(bench.post("/api/stage", R"({"G.A": 2})").status, 200U);

  PageBench without({.is_loopback = false, .read_token = "a-token-to-read-with"});
  EXPECT_EQ(without.get("/api/values", reader).status, 200U);
  EXPECT_EQ(without.post("/api/stage", R"({"G.A": 2})", reader).status, 403U) << "nobody writes";
  EXPECT_EQ(json::parse(without.get("/api/description", reader).body)["writable"], false);
}

TEST(WebResponder, PagesOfOthersMayNotAsk) {
  PageBench bench({.token = test::token});
  for (const char* const target : {"/", "/api/values", "/api/description", "/metrics"}) {
    EXPECT_EQ(bench.responder.answer({.method = "GET", .target = target, .host = "evil.example"}).status, 421U);
    EXPECT_EQ(bench.responder
                  .answer({.method = "GET", .target = target, .host = "localhost", .origin = "http://evil.example"})
                  .status,
              403U);
  }
  EXPECT_EQ(bench.responder.upgrade({.target = "/api/stream", .host = "evil.example"}).status, 421U);
  EXPECT_EQ(
      bench.responder.upgrade({.target = "/api/stream", .host = "localhost", .origin = "http://evil.example"}).status,
      403U);
  EXPECT_EQ(
      bench.responder.upgrade({.target = "/api/stream", .host = "localhost", .origin = "http://localhost"}).status,
      200U);
  EXPECT_EQ(bench.responder.upgrade({.target = "/other", .host = "localhost"}).status, 404U);
}

TEST(WebResponder, WhatIsNotThereIsNotFound) {
  PageBench bench({.token = test::token});
  EXPECT_EQ(bench.get("/nothing").status, 404U);
  EXPECT_EQ(bench.get("/../etc/passwd").status, 404U);
  EXPECT_EQ(bench.get("/api/stage").status, 404U);
  EXPECT_EQ(bench.post("/api/values").status, 404U);
  EXPECT_EQ(bench.responder.answer({.method = "PUT", .target = "/", .host = "localhost"}).status, 405U);
}

/// The page refers to nothing outside of itself, and its policy forbids that it could.
TEST(WebResponder, NoOtherHostIsNamed) {
  EXPECT_EQ(common_headers()[0].name, "Content-Security-Policy");
  EXPECT_TRUE(common_headers()[0].value.starts_with("default-src 'self';"));
  EXPECT_EQ(common_headers()[0].value.find("unsafe"), std::string_view::npos);
  ASSERT_EQ(assets().size(), 9U);
  for (const Asset& asset : assets()) {
    EXPECT_GT(asset.text.size(), 100U) << asset.target;
    if (asset.target.starts_with("/dygraph") || asset.target == "/icon.svg") {
      continue;  // names of licences and of the SVG standard
    }
    EXPECT_EQ(asset.text.find("//www"), std::string_view::npos) << asset.target;
    EXPECT_EQ(asset.text.find("http://"), std::string_view::npos) << asset.target;
    EXPECT_EQ(asset.text.find(" style="), std::string_view::npos) << asset.target << ": the policy would block it";
  }
}

TEST(WebResponder, AsksTheHistoryUnderTheRulesOfThePage) {
  const hysteron::test::ScratchFolder folder;
  test::HistoryBench history(folder / "history.sqlite");
  history.start();
  history.second();
  history.stop();
  test::Accumulator program;
  TaskDoor door(program, {{}}, {{}, {}});
  const Subject subject{.name = "A", .history = history.file(), .history_points = {"U", "Y"}};
  const auto ask = [&](Responder& responder, std::string_view target, std::string_view authorization = {}) {
    Answer answer =
        responder.answer({.method = "GET", .target = target, .host = "127.0.0.1:8080", .authorization = authorization});
    return answer.later ? answer_of(*answer.later) : answer;
  };
  Responder open(door, subject, {});
  EXPECT_EQ(json::parse(ask(open, "/api/description").body)["history"], json::parse(R"(["U", "Y"])"));
  const Answer answer = ask(open, "/api/history?point=Y&hours=1");
  EXPECT_EQ(answer.status, 200U) << answer.body;
  const json trend = json::parse(answer.body);
  EXPECT_EQ(trend["unit"], "um");
  EXPECT_EQ(trend["rows"], 101);
  EXPECT_EQ(trend["places"].size(), 101U);
  EXPECT_EQ(trend["places"].back()[3], 500.0);
  EXPECT_EQ(ask(open, "/api/history?point=NOTHING").status, 404U);
  for (const char* const wrong :
       {"point=Y&hours=-1", "point=Y&hours=x", "point=Y&hours=1e9", "column=Y", "point=Y&hours="}) {
    EXPECT_EQ(ask(open, std::string("/api/history?") + wrong).status, 400U) << wrong;
  }
  Responder closed(door, subject, {.is_loopback = false, .token = test::token});
  EXPECT_EQ(ask(closed, "/api/history?point=Y").status, 401U);
  EXPECT_EQ(ask(closed, "/api/history?point=Y", bearer).status, 200U);
  Responder none(door, {.name = "A"}, {});
  EXPECT_EQ(ask(none, "/api/history?point=Y").status, 404U);
  std::filesystem::remove(history.file());
  EXPECT_EQ(ask(open, "/api/history?point=Y").status, 503U);
}

}  // namespace
}  // namespace hysteron::runtime::web
