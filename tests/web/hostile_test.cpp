// Clients that mean harm, beside one that asks in good faith: it is answered all the while, what they hold is bounded,
// and nothing of them is left over.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <thread>

#include "runtime/web/server.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/soon.hpp"
#include "tests/web/web_client.hpp"

namespace hysteron::runtime::web {
namespace {

using test::WebClient;

/// Short deadlines, so that the test sees them.
constexpr Limits quick{.request = milliseconds(300),
                       .answer = milliseconds(1000),
                       .unread = milliseconds(300),
                       .interval = milliseconds(2)};

std::size_t descriptors() {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}));
}

/// Pages that this process holds in memory, in KiB.
std::size_t resident() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0;
  std::size_t held = 0;
  file >> all >> held;
  return held * 4;
}

struct HostileBench {
  explicit HostileBench(Limits limits = quick)
      : server(door, {.name = "T", .period = 1'000'000},
               {.endpoint = parse_endpoint("127.0.0.1:0"), .limits = limits}) {}
  /// A client in good faith: a connection, a request, the answer.
  [[nodiscard]] int victim() const { return WebClient(server.port()).ask("GET", "/api/values").status; }
  test::MemoryDoor door{test::points_of_every_type()};
  Server server;
};

/// A page in good faith: it takes what it is sent, all the time.
class Page {
 public:
  explicit Page(std::uint16_t port) : client_(port), is_open_(client_.open_stream() == 101) {
    thread_ = std::thread([this] {
      while (is_open_ && !stop_) {
        is_open_ = client_.frame().has_value();
        ++frames_;
      }
    });
  }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  Page(Page&&) = delete;
  Page& operator=(Page&&) = delete;
  ~Page() {
    stop_ = true;
    thread_.join();
  }
  /// Further values come.
  [[nodiscard]] bool goes_on() const {
    const std::uint64_t before = frames_;
    return test::soon([&] { return frames_ > before + 1 || !is_open_; }) && is_open_;
  }

 private:
  WebClient client_;
  std::atomic<bool> is_open_;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> frames_{0};
  std::thread thread_;
};

TEST(WebHostile, ASlowSenderLosesItsConnectionAtTheDeadline) {
  const HostileBench bench;
  std::vector<std::unique_ptr<WebClient>> slow;
  for (int i = 0; i < 20; ++i) {
    slow.push_back(std::make_unique<WebClient>(bench.server.port()));
  }
  const std::string head = "GET /api/values HTTP/1.1\r\nHost: 127.0.0.1\r\nX-A: " + std::string(1000, 'a');
  for (std::size_t at = 0; at < 12; ++at) {
    for (const auto& client : slow) {
      (void)client->send(head.substr(at, 1));
    }
    EXPECT_EQ(bench.victim(), 200);
    std::this_thread::sleep_for(milliseconds(40));
  }
  for (const auto& client : slow) {
    EXPECT_TRUE(client->socket().sees_the_end()) << "its bytes came in time, its request did not";
  }
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 0; }));
}

TEST(WebHostile, AThousandConnectionsLeaveRoomAndNothingBehind) {
  const HostileBench bench;
  EXPECT_EQ(bench.victim(), 200);
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 0; }));
  const std::size_t before = descriptors();
  {
    std::vector<std::unique_ptr<WebClient>> many;
    for (int i = 0; i < 1000; ++i) {
      many.push_back(std::make_unique<WebClient>(bench.server.port()));
      if (i % 100 == 99) {
        EXPECT_EQ(bench.victim(), 200) << i;
        EXPECT_LE(bench.server.status().open, 32U);
      }
    }
    EXPECT_TRUE(test::soon([&] { return bench.server.status().accepted >= 1000; }));
    EXPECT_GT(bench.server.status().gave_way, 0U) << "the oldest that owe a request give way";
  }
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 0 && descriptors() == before; }));
}

/// All places are taken by streams and by clients that are being answered: then a newcomer is refused, and no stream
/// ends.
TEST(WebHostile, StreamsDoNotGiveWay) {
  Limits limits = quick;
  limits.connections = 4;
  const HostileBench bench(limits);
  std::vector<std::unique_ptr<Page>> streams;
  for (int i = 0; i < 4; ++i) {
    streams.push_back(std::make_unique<Page>(bench.server.port()));
    ASSERT_TRUE(streams.back()->goes_on());
  }
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(WebClient(bench.server.port()).socket().sees_the_end());
  }
  EXPECT_EQ(bench.server.status().refused_full, 50U);
  for (const auto& stream : streams) {
    EXPECT_TRUE(stream->goes_on());
  }
}

TEST(WebHostile, AStreamThatDoesNotReadLosesValuesThenItsPlace) {
  const HostileBench bench;
  std::vector<std::unique_ptr<WebClient>> deaf;
  for (int i = 0; i < 8; ++i) {
    deaf.push_back(std::make_unique<WebClient>(bench.server.port()));
    deaf.back()->socket().keep_little();
    ASSERT_EQ(deaf.back()->open_stream(), 101);
  }
  const Page reader(bench.server.port());
  EXPECT_TRUE(test::soon([&] { return bench.server.status().dropped > 0; }));
  const std::size_t held = resident();
  EXPECT_TRUE(test::soon([&] { return bench.server.status().unread == 8; })) << bench.server.status().unread;
  EXPECT_TRUE(reader.goes_on());
  EXPECT_TRUE(test::soon([&] { return bench.server.status().streams == 1; }));
  EXPECT_LT(resident(), held + 8 * 1024) << "KiB: what is not read is dropped, and queued nowhere";
}

TEST(WebHostile, AStreamThatAnswersNoPingEnds) {
  Limits limits = quick;
  limits.silence = milliseconds(400);
  const HostileBench bench(limits);
  const WebClient mute(bench.server.port());
  ASSERT_EQ(mute.open_stream(), 101);
  EXPECT_TRUE(mute.socket().sees_the_end()) << "it reads, and says nothing";
}

struct BadFrame {
  const char* name;
  std::function<void(const WebClient&)> send;
};

class WebHostileFrames : public ::testing::TestWithParam<BadFrame> {};

TEST_P(WebHostileFrames, EndTheirStreamAndNoOther) {
  const HostileBench bench;
  const Page other(bench.server.port());
  for (int i = 0; i < 10; ++i) {
    const WebClient bad(bench.server.port());
    ASSERT_EQ(bad.open_stream(), 101);
    GetParam().send(bad);
    EXPECT_TRUE(bad.socket().sees_the_end());
    ASSERT_TRUE(other.goes_on());
  }
  EXPECT_EQ(bench.victim(), 200);
}

INSTANTIATE_TEST_SUITE_P(
    Of, WebHostileFrames,
    ::testing::Values(BadFrame{"AnOversizedOne",
                               [](const WebClient& one) { one.send_frame(1, std::string(1 << 20, 'a')); }},
                      BadFrame{"AnOversizedOneThatIsOnlyAnnounced",
                               [](const WebClient& one) {
                                 one.send(std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14));
                               }},
                      BadFrame{"ABadText", [](const WebClient& one) { one.send_frame(1, "\xc0\xaf\xed\xa0\x80"); }},
                      BadFrame{"AnUnmaskedOne", [](const WebClient& one) { one.send_frame(1, "hello", false); }},
                      BadFrame{"AReservedBit", [](const WebClient& one) { one.send_frame(1, "hello", true, 0xF0); }},
                      BadFrame{"AReservedOpcode", [](const WebClient& one) { one.send_frame(5, "hello"); }},
                      BadFrame{"AContinuationOfNothing", [](const WebClient& one) { one.send_frame(0, "hello"); }},
                      BadFrame{"ALongPing", [](const WebClient& one) { one.send_frame(9, std::string(126, 'a')); }},
                      BadFrame{"AMessageThatNobodyAskedFor", [](const WebClient& one) { one.send_frame(1, "hello"); }},
                      BadFrame{"RequestsInsteadOfFrames", [](const WebClient& one) { one.request("GET", "/"); }}),
    [](const auto& frame) { return std::string(frame.param.name); });

struct BadRequest {
  const char* name;
  std::string text;
  int status;  ///< 0: no answer, only the end
};

class WebHostileRequests : public ::testing::TestWithParam<BadRequest> {};

TEST_P(WebHostileRequests, AreAnsweredAndEnd) {
  const HostileBench bench;
  for (int i = 0; i < 20; ++i) {
    const WebClient bad(bench.server.port());
    (void)bad.send(GetParam().text);
    if (GetParam().status != 0) {
      EXPECT_EQ(bad.reply().status, GetParam().status);
    }
    EXPECT_TRUE(bad.socket().sees_the_end());
    EXPECT_EQ(bench.victim(), 200);
  }
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 0; }));
}

INSTANTIATE_TEST_SUITE_P(
    Of, WebHostileRequests,
    ::testing::Values(
        BadRequest{"NoHttp", "\x16\x03\x01 hello, is this TLS?\r\n\r\n", 400},
        BadRequest{"AHeaderWithoutEnd", "GET / HTTP/1.1\r\nX: " + std::string(9 * 1024, 'a'), 413},
        BadRequest{"ManyHeaders",
                   [] {
                     std::string text = "GET / HTTP/1.1\r\n";
                     for (int i = 0; i < 2000; ++i) {
                       text += "X" + std::to_string(i) + ": 1\r\n";
                     }
                     return text;
                   }(),
                   413},
        BadRequest{"ABodyThatIsAnnouncedTooLong",
                   "POST /api/stage HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n", 413},
        BadRequest{"ALengthThatIsNone", "POST /api/stage HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n",
                   400},
        BadRequest{"TwoLengths",
                   "POST /api/stage HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab",
                   400},
        BadRequest{"AChunkTooLong",
                   "POST /api/stage HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nfffffffff\r\n",
                   413},
        BadRequest{"ABodyThatDoesNotCome",
                   "POST /api/stage HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n{", 0}),
    [](const auto& request) { return std::string(request.param.name); });

TEST(WebHostile, RandomBytesHarmNobody) {
  const HostileBench bench;
  std::mt19937 random(7);
  const Page other(bench.server.port());
  for (int i = 0; i < 100; ++i) {
    const WebClient bad(bench.server.port());
    if (i % 2 == 0) {
      ASSERT_EQ(bad.open_stream(), 101);
    }
    std::string bytes(random() % 3000, '\0');
    std::ranges::generate(bytes, [&] { return static_cast<char>(random()); });
    (void)bad.send(bytes);
    ASSERT_TRUE(other.goes_on());
  }
  EXPECT_EQ(bench.victim(), 200);
  EXPECT_TRUE(test::soon([&] { return bench.server.status().open == 1; }));
}

}  // namespace
}  // namespace hysteron::runtime::web
