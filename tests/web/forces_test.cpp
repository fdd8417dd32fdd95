// Inputs that the live page forces: who may, up to which value, and that they are free when the page is gone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "runtime/task/task_door.hpp"
#include "runtime/web/responder.hpp"
#include "runtime/web/server.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/soon.hpp"
#include "tests/web/web_client.hpp"

namespace hysteron::runtime::web {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string bearer_of_forces = std::string("Bearer ") + test::token;
constexpr const char* first_session = "0123456789abcdef";
constexpr const char* second_session = "fedcba9876543210";

struct ForceBench {
  explicit ForceBench(PageRights rights = {.force = true})
      : responder(door, {.name = "ACCUMULATOR", .period = 1'000'000}, {.token = test::token, .rights = rights}) {
    responder.session_begins(first_session);
  }
  static const test::Accumulator& with_range(test::Accumulator& program) {
    program.mutable_shape().inputs[0].low = -2.0;
    program.mutable_shape().inputs[0].high = 2.0;
    program.mutable_shape().inputs.push_back({.name = "ON", .type = PointType::boolean, .low = 0.0, .high = 1.0});
    return program;
  }
  Answer post(std::string_view target, const std::string& body = {}) {
    return responder.answer(
        {.method = "POST", .target = target, .host = "localhost", .authorization = bearer_of_forces, .body = body});
  }
  Answer force(const std::string& inputs, const std::string& session = first_session) {
    return post("/api/force", R"({"session": ")" + session + R"(", "inputs": )" + inputs + "}");
  }
  std::string refusal(const std::string& inputs, const std::string& session = first_session) {
    const Answer answer = force(inputs, session);
    return std::to_string(answer.status) + ": " + json::parse(answer.body).value("refusal", "");
  }
  /// As the cyclic thread takes them.
  std::vector<std::optional<double>> forces() {
    const TaskOrders* const orders = door.take_orders();
    return orders == nullptr ? std::vector<std::optional<double>>{} : orders->forces;
  }

  test::Accumulator program;
  TaskDoor door{with_range(program), {{}, {}}, {{}, {}}};
  Responder responder;
};

TEST(WebForces, AreRefusedWhereTheRunFileDoesNotAllowThem) {
  ForceBench bench(PageRights{});
  EXPECT_EQ(bench.refusal(R"({"X": 1})"),
            "403: The live page may not do this: \"force\" is not among the rights of [web] in the run file.");
  EXPECT_EQ(bench.post("/api/release").status, 403U);
  EXPECT_TRUE(bench.forces().empty());
  ForceBench only({.parameters = false, .reset = false, .force = true});
  EXPECT_EQ(only.force(R"({"X": 1})").status, 200U);
  for (const char* const target : {"/api/stage", "/api/commit", "/api/discard", "/api/reset"}) {
    EXPECT_EQ(only.post(target, R"({"G.A": 2})").status, 403U) << target;
  }
  const json about =
      json::parse(only.responder.answer({.method = "GET", .target = "/api/description", .host = "localhost"}).body);
  EXPECT_EQ(about["rights"], json::parse(R"(["force"])"));
}

TEST(WebForces, ASetIsForcedOrNothingOfIt) {
  ForceBench bench;
  EXPECT_EQ(bench.force(R"({"X": 1.5, "ON": true})").status, 200U);
  EXPECT_THAT(bench.forces(), ElementsAre(1.5, 1.0));
  EXPECT_EQ(bench.refusal(R"({"ON": false, "X": 2.5})"), "422: X must be at most 2 V; 2.5 was given.");
  EXPECT_EQ(bench.refusal(R"({"ON": 0.5})"), "422: ON takes 0 or 1.");
  EXPECT_EQ(bench.refusal(R"({"ON": false, "G.A": 1})"), "422: There is no input G.A; inputs alone can be forced.");
  EXPECT_EQ(bench.refusal(R"({"ON": false, "X": "1"})"), "422: X is not given a number.");
  EXPECT_TRUE(bench.forces().empty()) << "nothing was ordered";
  EXPECT_EQ(bench.force(R"({"X": null})").status, 200U);
  EXPECT_THAT(bench.forces(), ElementsAre(std::nullopt, 1.0)) << "what is not named stays";
  EXPECT_EQ(bench.post("/api/release").status, 200U);
  EXPECT_THAT(bench.forces(), ElementsAre(std::nullopt, std::nullopt));
  for (const char* const body : {"", "1", "{", "{}", R"({"session": 5, "inputs": {"X": 1}})", R"({"inputs": {"X": 1}})",
                                 R"({"session": "0123456789abcdef"})"}) {
    EXPECT_EQ(bench.post("/api/force", body).status, 400U) << body;
  }
  EXPECT_EQ(bench.force("{}").status, 400U);
  EXPECT_EQ(bench.force("[1]").status, 400U);
}

TEST(WebForces, EndWithTheSessionThatForced) {
  ForceBench bench;
  EXPECT_THAT(bench.refusal(R"({"X": 1})", second_session), HasSubstr("409: The session is not open"));
  bench.responder.session_begins(second_session);
  EXPECT_EQ(bench.force(R"({"X": 1})").status, 200U);
  EXPECT_EQ(bench.force(R"({"ON": true})", second_session).status, 200U);
  EXPECT_THAT(bench.forces(), ElementsAre(1.0, 1.0));
  bench.responder.session_ends(first_session);
  EXPECT_THAT(bench.forces(), ElementsAre(std::nullopt, 1.0)) << "what the other forces stays";
  bench.responder.session_ends(first_session);
  EXPECT_TRUE(bench.forces().empty());
  bench.responder.session_ends(second_session);
  EXPECT_THAT(bench.forces(), ElementsAre(std::nullopt, std::nullopt));
  EXPECT_EQ(bench.force(R"({"X": 1})").status, 409U);
}

TEST(WebForces, WhoForcedAnInputLastHoldsIt) {
  ForceBench bench;
  bench.responder.session_begins(second_session);
  EXPECT_EQ(bench.force(R"({"X": 1})").status, 200U);
  EXPECT_EQ(bench.force(R"({"X": 2})", second_session).status, 200U);
  EXPECT_THAT(bench.forces(), ElementsAre(2.0, std::nullopt));
  bench.responder.session_ends(first_session);
  EXPECT_TRUE(bench.forces().empty());
  bench.responder.session_ends(second_session);
  EXPECT_THAT(bench.forces(), ElementsAre(std::nullopt, std::nullopt));
}

TEST(WebForces, TheValuesSayWhatIsForced) {
  ForceBench bench;
  const std::vector<double> inputs{1.5, 0.0};
  const std::vector<double> outputs{0.0, 0.0};
  const std::vector<std::optional<double>> forces{1.5, std::nullopt};
  bench.door.publish(bench.program, inputs, outputs, {.state = TaskState::running, .forced = 1}, {}, forces);
  const auto get = [&](std::string_view target) {
    return bench.responder.answer({.method = "GET", .target = target, .host = "localhost"}).body;
  };
  const json values = json::parse(get("/api/values"));
  EXPECT_EQ(values["forced"], json::parse("[0]"));
  EXPECT_EQ(values["version"], 1);
  EXPECT_THAT(get("/metrics"), HasSubstr("\nhysteron_task_forced{point=\"task.forced\"} 1\n"));
}

TEST(WebForces, ANameOfASessionIsOneThatNobodyGuesses) {
  EXPECT_EQ(session_of("/api/stream?session=0123456789abcdef"), "0123456789abcdef");
  for (const char* const wrong : {"/api/stream", "/api/stream?session=", "/api/stream?session=0123456789abcde",
                                  "/api/stream?session=0123456789abcde-", "/api/values?session=0123456789abcdef"}) {
    EXPECT_EQ(session_of(wrong), "") << wrong;
  }
  EXPECT_EQ(session_of("/api/stream?session=" + std::string(65, 'a')), "");
  ForceBench bench;
  const auto upgrade = [&](const char* target) {
    return bench.responder.upgrade({.target = target, .host = "localhost"}).status;
  };
  EXPECT_EQ(upgrade("/api/stream?session=0123456789abcdef"), 409U) << "another page has it";
  EXPECT_EQ(upgrade("/api/stream?session=fedcba9876543210"), 200U);
  EXPECT_EQ(upgrade("/api/stream?session=short"), 404U);
}

/// A door that keeps what is forced.
class ForcedDoor final : public test::MemoryDoor {
 public:
  ForcedDoor() : MemoryDoor({{.name = "X", .kind = PointKind::input}}) {}
  std::string force(std::span<const Force> inputs) override {
    const std::scoped_lock lock(mutex_);
    for (const Force& one : inputs) {
      forced_ = one.value;
    }
    return "";
  }
  [[nodiscard]] std::optional<double> forced() {
    const std::scoped_lock lock(mutex_);
    return forced_;
  }

 private:
  std::mutex mutex_;
  std::optional<double> forced_;
};

/// A tab that is closed, a browser that is killed, a page that answers no ping: its connection ends, and so do its
/// forces.
TEST(WebForces, EndWithTheConnectionOfThePage) {
  ForcedDoor door;
  const Server server(door, {.name = "T", .period = 1'000'000},
                      {.endpoint = parse_endpoint("127.0.0.1:0"),
                       .access = {.token = test::token, .rights = {.force = true}},
                       .limits = {.silence = milliseconds(400), .interval = milliseconds(5)}});
  const test::WebClient hand(server.port());
  const auto force = [&] {
    return hand.ask("POST", "/api/force", test::authorized, R"({"session": "0123456789abcdef", "inputs": {"X": 7}})")
        .status;
  };
  EXPECT_EQ(force(), 409) << "without a page nothing would end it";
  for (const bool is_closed : {true, false}) {
    auto page = std::make_optional<test::WebClient>(server.port());
    ASSERT_EQ(page->open_stream("", "/api/stream?session=0123456789abcdef"), 101);
    EXPECT_EQ(force(), 200);
    EXPECT_EQ(door.forced(), 7.0);
    if (is_closed) {
      page.reset();
    }
    EXPECT_TRUE(test::soon([&] { return !door.forced(); })) << "it reads nothing, and answers no ping";
    EXPECT_TRUE(test::soon([&] { return server.status().streams == 0; }));
  }
}

}  // namespace
}  // namespace hysteron::runtime::web
