// TLS as a function of bytes: a client in memory, no sockets, no clock.
#include "runtime/modbus/tls_session.hpp"

#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "tests/runtime/modbus/tls_files.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(RecordScan, KnowsWhereRecordsEndHoweverTheyAreCut) {
  Bytes stream;
  const std::vector<std::size_t> sizes{1, 0, 300, 65535, 5};
  std::vector<std::size_t> ends;
  for (const std::size_t size : sizes) {
    stream.insert(stream.end(),
                  {23, 3, 3, static_cast<std::uint8_t>(size >> 8U), static_cast<std::uint8_t>(size & 0xFFU)});
    stream.insert(stream.end(), size, 0xFF);
    ends.push_back(stream.size());
  }
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    RecordScan scan;
    std::size_t ended = 0;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t count = std::min<std::size_t>(stream.size() - at, 1 + random() % (round % 2 == 0 ? 7 : 5000));
      ended += scan.take(std::span(stream).subspan(at, count));
      at += count;
      const auto expected = static_cast<std::size_t>(std::ranges::count_if(ends, [&](auto end) { return end <= at; }));
      ASSERT_EQ(ended, expected) << at;
      ASSERT_EQ(scan.is_within(), std::ranges::find(ends, at) == ends.end()) << at;
    }
  }
}

/// A client's library over memory.
class MemoryClient {
 public:
  explicit MemoryClient(ssl_ctx_st* context) : session_(SSL_new(context), SSL_free) {
    SSL_set_bio(session_.get(), BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
    SSL_set_connect_state(session_.get());
  }
  Bytes output() {
    Bytes bytes(1U << 20U);
    const int size = BIO_read(SSL_get_wbio(session_.get()), bytes.data(), static_cast<int>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max(size, 0)));
    return bytes;
  }
  void take(std::span<const std::uint8_t> bytes) {
    BIO_write(SSL_get_rbio(session_.get()), bytes.data(), static_cast<int>(bytes.size()));
  }
  bool shake() { return SSL_do_handshake(session_.get()) == 1; }
  ssl_st* session() { return session_.get(); }

 private:
  std::unique_ptr<ssl_st, decltype(&SSL_free)> session_;
};

class TlsSessions : public ::testing::Test {
 protected:
  /// What the server has for the client, which takes it.
  void hand_over() {
    client_.take(session_.output());
    session_.sent(session_.output().size());
  }
  /// Bytes of the client, in pieces of a size.
  void give(const Bytes& bytes, std::size_t piece) {
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      ASSERT_GT(session_.wants_input(), 0U);
      session_.received(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)), now_);
    }
  }
  void establish(std::size_t piece = 4096) {
    for (int turn = 0; turn < 5 && !session_.is_established(); ++turn) {
      (void)client_.shake();
      give(client_.output(), piece);
      hand_over();
    }
    (void)client_.shake();
    ASSERT_TRUE(session_.is_established()) << session_.failure();
  }

  Instant now_{std::chrono::seconds(100)};
  test::TlsFiles files_;
  TlsContext context_{files_.options()};
  TlsSession session_{context_, {}, now_};
  test::ClientContext bring_ = files_.client_of("operator");
  MemoryClient client_{bring_.get()};
};

TEST_F(TlsSessions, AHandshakeInBytesIsOneAsWell) {
  EXPECT_EQ(session_.rights(), no_rights) << "before it, nobody may anything";
  establish(1);
  EXPECT_EQ(session_.rights(), (Rights{.read = true, .inputs = true, .parameters = false, .reset = false}));
  EXPECT_EQ(session_.due(now_ + std::chrono::hours(1)), std::nullopt) << "its deadline is over";
  const std::string text = "what is said";
  EXPECT_EQ(session_.write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())), text.size());
  EXPECT_EQ(session_.write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())), 0U)
      << "while the output has not gone, no more is taken";
  hand_over();
  std::array<char, 100> got{};
  EXPECT_EQ(SSL_read(client_.session(), got.data(), 100), static_cast<int>(text.size()));
  EXPECT_EQ(std::string(got.data()), text);
}

TEST_F(TlsSessions, WhatOneRecordBringsIsReadInPieces) {
  establish();
  const Bytes much(16000, 7);
  EXPECT_EQ(SSL_write(client_.session(), much.data(), 16000), 16000);
  const Bytes line = client_.output();
  for (std::size_t at = 0; at < line.size(); at += 1000) {
    session_.received(std::span(line).subspan(at, std::min<std::size_t>(1000, line.size() - at)), now_);
  }
  std::size_t count = 0;
  std::array<std::uint8_t, 1040> piece{};
  while (session_.has_buffered()) {
    EXPECT_EQ(session_.wants_input(), 0U) << "nothing more is taken until that is read";
    count += session_.read(piece);
  }
  EXPECT_EQ(count, 16000U);
  EXPECT_GT(session_.wants_input(), 0U);
}

TEST_F(TlsSessions, ARecordThatIsNotWholeIsLate) {
  establish();
  const std::uint8_t one = 1;
  SSL_write(client_.session(), &one, 1);
  const Bytes record = client_.output();
  session_.received(std::span(record).first(3), now_);
  EXPECT_EQ(session_.next_deadline(), now_ + milliseconds(500));
  session_.received(std::span(record).subspan(3, 5), now_ + milliseconds(400));
  EXPECT_EQ(session_.due(now_ + milliseconds(499)), std::nullopt);
  EXPECT_EQ(session_.due(now_ + milliseconds(500)), Ending::frame_late) << "its first byte counts, not its last";
  session_.received(std::span(record).subspan(8), now_ + milliseconds(450));
  EXPECT_EQ(session_.due(now_ + std::chrono::hours(1)), std::nullopt);
  std::array<std::uint8_t, 8> into{};
  EXPECT_EQ(session_.read(into), 1U);
}

TEST_F(TlsSessions, AHandshakeThatStallsIsLate) {
  EXPECT_EQ(session_.next_deadline(), now_ + milliseconds(5000));
  (void)client_.shake();
  give(client_.output(), 4096);
  EXPECT_EQ(session_.due(now_ + milliseconds(4999)), std::nullopt);
  EXPECT_EQ(session_.due(now_ + milliseconds(5000)), Ending::handshake_late);
}

TEST_F(TlsSessions, KeysThatAreUpdatedForEverFillNothing) {
  establish();
  std::size_t taken = 0;
  std::array<std::uint8_t, 64> into{};
  for (int i = 0; i < 100'000 && (session_.wants_input() > 0 || session_.has_buffered()); ++i) {
    if (session_.wants_input() > 0) {
      SSL_key_update(client_.session(), SSL_KEY_UPDATE_REQUESTED);
      ASSERT_TRUE(client_.shake());
      session_.received(client_.output(), now_);
      ++taken;
    }
    EXPECT_EQ(session_.read(into), 0U);
  }
  EXPECT_LT(session_.output().size(), 40U * 1024) << taken << " updates, and the client took no answer";
  EXPECT_GT(taken, 10U);
}

TEST_F(TlsSessions, DamagedHandshakesFailAndNothingElse) {
  (void)client_.shake();
  const Bytes hello = client_.output();
  std::mt19937 random(3);
  int failed = 0;
  for (int i = 0; i < 2000; ++i) {
    Bytes damaged = hello;
    for (int k = 0; k < 3; ++k) {
      damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
    }
    damaged.resize(1 + random() % damaged.size());
    TlsSession session(context_, {}, now_);
    session.received(damaged, now_);
    EXPECT_FALSE(session.is_established());
    EXPECT_EQ(session.rights(), no_rights);
    EXPECT_TRUE(session.due(now_ + milliseconds(5000)).has_value());
    failed += session.failure().empty() ? 0 : 1;
  }
  EXPECT_GT(failed, 20) << "most damage lies in what is random anyway, or waits for more";
}

}  // namespace
}  // namespace hysteron::runtime::modbus
