#include "runtime/web/server.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "support/errors.hpp"
#include "tests/runtime/history/history_bench.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"
#include "tests/web/web_client.hpp"

namespace hysteron::runtime::web {
namespace {

using nlohmann::json;
using test::WebClient;
using test::WebFrame;
using test::WebReply;

struct PageServerBench {
  explicit PageServerBench(Limits limits = {}, Access access = {.token = test::token})
      : server(door, {.name = "T", .period = 1'000'000},
               {.endpoint = parse_endpoint("127.0.0.1:0"), .access = std::move(access), .limits = limits}) {}
  test::MemoryDoor door{{{.name = "Y", .kind = PointKind::output, .unit = "um"},
                         {.name = "K", .kind = PointKind::parameter, .low = 0.0, .high = 9.0, .writable = true},
                         {.name = "task.commit", .kind = PointKind::command, .writable = true}}};
  Server server;
};

TEST(WebServer, GivesThePageWithItsPolicy) {
  const PageServerBench bench;
  const WebClient client(bench.server.port());
  for (const auto& [target, type, text] : {std::tuple{"/", "text/html", "<!DOCTYPE html>"},
                                           {"/page.js", "text/javascript", "use strict"},
                                           {"/dygraph.js", "text/javascript", "Dygraph"},
                                           {"/page.css", "text/css", "--paper"}}) {
    const WebReply reply = client.ask("GET", target);
    EXPECT_EQ(reply.status, 200) << target;
    EXPECT_NE(reply.body.find(text), std::string::npos) << target;
    EXPECT_EQ(reply.headers.at("Content-Type"), type);
    EXPECT_TRUE(reply.headers.at("Content-Security-Policy").starts_with("default-src 'self';"));
    EXPECT_EQ(reply.headers.at("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(reply.headers.at("Cache-Control"), "no-store");
    EXPECT_FALSE(reply.headers.contains("Access-Control-Allow-Origin"));
  }
  EXPECT_EQ(bench.server.status().accepted, 1U) << "one connection for all of them";
  EXPECT_EQ(bench.server.status().answers, 4U);
}

TEST(WebServer, StagesAndCommitsForWhoHasTheToken) {
  PageServerBench bench;
  const WebClient client(bench.server.port());
  EXPECT_EQ(client.ask("POST", "/api/stage", test::authorized, R"({"K": 4.5})").status, 200);
  EXPECT_EQ(bench.door.value(1), 4.5);
  EXPECT_EQ(client.ask("POST", "/api/commit", test::authorized).status, 200);
  EXPECT_EQ(bench.door.value(2), 1.0);
  const WebReply refused = client.ask("POST", "/api/stage", test::authorized, R"({"K": 10})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body)["refusal"], "K must be at most 9; 10 was given.");
  const WebReply stranger = client.ask("POST", "/api/stage", "", R"({"K": 1})");
  EXPECT_EQ(stranger.status, 401);
  EXPECT_EQ(stranger.headers.at("WWW-Authenticate"), "Bearer");
  EXPECT_EQ(bench.door.value(1), 4.5);
  bench.door.refuse("not while the machine moves.");
  EXPECT_EQ(json::parse(client.ask("POST", "/api/commit", test::authorized).body)["refusal"],
            "not while the machine moves.");
}

TEST(WebServer, StreamsTheValues) {
  PageServerBench bench({.interval = milliseconds(5)});
  bench.door.set(0, 0.1);
  const WebClient client(bench.server.port());
  ASSERT_EQ(client.open_stream(), 101);
  std::uint64_t last = 0;
  for (int i = 0; i < 20; ++i) {
    const auto frame = client.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->opcode, 1U);
    const json values = json::parse(frame->payload);
    EXPECT_GT(values["cycle"].get<std::uint64_t>(), last);
    last = values["cycle"];
    EXPECT_EQ(values["values"][0].get<double>(), 0.1);
  }
  EXPECT_EQ(bench.server.status().streams, 1U);
  client.send_frame(8, std::string("\x03\xe8", 2));
  EXPECT_TRUE(client.socket().sees_the_end());
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 0; }));
}

TEST(WebServer, BeyondTheLoopbackAStreamBeginsWithTheToken) {
  PageServerBench bench({.interval = milliseconds(5)}, {.is_loopback = false, .token = test::token});
  const WebClient silent(bench.server.port(), milliseconds(200));
  ASSERT_EQ(silent.open_stream(), 101);
  EXPECT_FALSE(silent.frame()) << "nothing is shown before the token is";
  const WebClient wrong(bench.server.port());
  ASSERT_EQ(wrong.open_stream(), 101);
  wrong.send_frame(1, "0123456789abcdeg");
  const auto farewell = wrong.frame();
  ASSERT_TRUE(farewell);
  EXPECT_EQ(farewell->opcode, 8U);
  EXPECT_EQ(farewell->payload.substr(0, 2), std::string("\x03\xf0", 2)) << "1008, against the policy";
  const WebClient right(bench.server.port());
  ASSERT_EQ(right.open_stream(), 101);
  right.send_frame(1, test::token);
  const auto frame = right.frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->opcode, 1U);
  const WebClient reader(bench.server.port());
  EXPECT_EQ(reader.ask("GET", "/api/values").status, 401);
  EXPECT_EQ(reader.ask("GET", "/api/values", test::authorized).status, 200);
}

TEST(WebServer, AForeignPageGetsNoStream) {
  const PageServerBench bench;
  EXPECT_EQ(WebClient(bench.server.port()).open_stream("Origin: http://evil.example\r\n"), 403);
  const std::string port = std::to_string(bench.server.port());
  EXPECT_EQ(WebClient(bench.server.port()).open_stream("Origin: http://127.0.0.1:" + port + "\r\n"), 101);
}

TEST(WebServer, TheSeventeenthStreamIsTold) {
  PageServerBench bench;
  std::vector<std::unique_ptr<WebClient>> streams;
  for (int i = 0; i < 16; ++i) {
    streams.push_back(std::make_unique<WebClient>(bench.server.port()));
    ASSERT_EQ(streams.back()->open_stream(), 101) << i;
    ASSERT_TRUE(streams.back()->frame());
  }
  EXPECT_EQ(WebClient(bench.server.port()).open_stream(), 503);
  streams.pop_back();
  EXPECT_TRUE(test::soon([&] { return bench.server.status().streams == 15; }));
  EXPECT_EQ(WebClient(bench.server.port()).open_stream(), 101);
}

TEST(WebServer, APortInUseIsAnErrorWithItsNumber) {
  PageServerBench bench;
  try {
    const Server second(
        bench.door, {},
        {.endpoint = {.address = "127.0.0.1", .port = bench.server.port()}, .access = {.token = test::token}});
    FAIL();
  } catch (const InputError& refused) {
    EXPECT_EQ(refused.diagnostics().all().front().number, error::port_in_use);
  }
  try {
    const Server open(bench.door, {}, {.endpoint = parse_endpoint("0.0.0.0:0"), .access = {.is_loopback = false}});
    FAIL();
  } catch (const InputError& refused) {
    EXPECT_EQ(refused.diagnostics().all().front().number, error::open_web_page);
  }
}

TEST(WebServer, LooksUpTheHistoryBesideItsThread) {
  const hysteron::test::ScratchFolder folder;
  runtime::test::HistoryBench history(folder / "history.sqlite");
  history.start();
  history.second();
  history.stop();
  test::MemoryDoor door{{{.name = "U"}}};
  const Server server(door, {.name = "A", .history = history.file(), .history_points = {"U"}},
                      {.endpoint = {.port = 0}});
  const WebClient client(server.port());
  for (int time = 0; time < 20; ++time) {
    const WebReply reply = client.ask("GET", "/api/history?point=U&hours=1");
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(json::parse(reply.body)["rows"], 101);
    EXPECT_EQ(client.ask("GET", "/api/values").status, 200) << "the connection goes on";
  }
  // Those who do not wait for their answer do no harm.
  for (int time = 0; time < 20; ++time) {
    EXPECT_TRUE(WebClient(server.port()).request("GET", "/api/history?point=U&hours=1"));
  }
  EXPECT_EQ(client.ask("GET", "/api/values").status, 200);
}

}  // namespace
}  // namespace hysteron::runtime::web
