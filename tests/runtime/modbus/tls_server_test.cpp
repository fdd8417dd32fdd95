// Modbus/TCP Security: real handshakes with the server, what each role may do, and who is refused.
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <cstdlib>
#include <functional>
#include <mutex>
#include <thread>

#include "runtime/modbus/map_text.hpp"
#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/tls_files.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using test::ask;
using test::Bytes;
using test::Certificate;
using test::ClientSocket;
using test::framed;

constexpr milliseconds patience{5000};

/// Register 0 is an input, register 1 a parameter, register 2 the command that resets.
std::vector<Point> served_points() {
  auto list = test::registers_to_serve();
  list[0].right = WriteRight::inputs;
  list[1].right = WriteRight::parameters;
  list[2].right = WriteRight::reset;
  return list;
}

class TlsServer : public ::testing::Test {
 protected:
  explicit TlsServer(ServerOptions options = {}) {
    options.port = 0;
    options.tls = std::make_shared<const TlsContext>(files_.options());
    options.tell = [this](const std::string& line) {
      const std::scoped_lock lock(mutex_);
      told_ += line + "\n";
    };
    server_ = std::make_unique<Server>(make_register_map(door_.points(), {.title = "T"}), door_, options);
  }

  [[nodiscard]] ClientSocket connect(ssl_ctx_st* context) const {
    return ClientSocket(server_->port(), patience, context);
  }
  [[nodiscard]] ClientSocket connect(const test::ClientContext& context) const { return connect(context.get()); }
  [[nodiscard]] static bool soon(const std::function<bool()>& holds) {
    return test::soon(holds, std::chrono::seconds(10));
  }
  std::string told() {
    const std::scoped_lock lock(mutex_);
    return told_;
  }

  test::TlsFiles files_;
  test::MemoryDoor door_{served_points()};
  std::mutex mutex_;
  std::string told_;
  std::unique_ptr<Server> server_;
};

Bytes write_to(int address) {
  return framed(2, {6, 0, address, 0, 9});
}
Bytes refused(int function) {
  return framed(2, {function + 128, 1});
}

TEST_F(TlsServer, AnswersByTls12And13) {
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    const auto context = files_.client_of("all", version);
    const ClientSocket client = connect(context);
    EXPECT_EQ(SSL_version(client.tls()), version);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(ask(client, write_to(i)), write_to(i));
    }
    EXPECT_EQ(ask(client, framed(3, {3, 0, 2, 0, 1})), framed(3, {3, 2, 0, 9}));
  }
  EXPECT_TRUE(soon([&] { return server_->status().open == 0; }));
  EXPECT_EQ(server_->status().closed_by_client, 2U);
  EXPECT_EQ(server_->status().requests, 8U);
}

TEST_F(TlsServer, ANewCertificateIsShownToNewConnectionsAndLeavesOpenOnesAlone) {
  const auto shown = [](const ClientSocket& client) {
    const std::unique_ptr<X509, decltype(&X509_free)> certificate(SSL_get1_peer_certificate(client.tls()), X509_free);
    return X509_NAME_hash_ex(X509_get_subject_name(certificate.get()), nullptr, nullptr, nullptr);
  };
  const auto context = files_.client_of("all");
  const ClientSocket before = connect(context);
  const auto old = shown(before);
  const Certificate fresh({.name = "renewed", .for_clients = false}, &files_.authority);
  files_.folder.write("server.pem", fresh.certificate_pem());
  files_.private_file("server.key", fresh.key_pem());
  server_->renew(std::make_shared<const TlsContext>(files_.options()));
  const ClientSocket after = connect(context);
  EXPECT_NE(shown(after), old);
  EXPECT_EQ(ask(before, write_to(0)), write_to(0)) << "as before";
  EXPECT_EQ(ask(after, write_to(1)), write_to(1));
}

TEST_F(TlsServer, ARoleMayDoWhatItIsGivenAndIsElseAnsweredByException01) {
  const ClientSocket reader = connect(files_.client_of("reader"));
  EXPECT_EQ(ask(reader, test::read_one), framed(1, {3, 2, 0, 0}));
  EXPECT_EQ(ask(reader, write_to(0)), refused(6));
  EXPECT_EQ(ask(reader, framed(2, {43, 14, 1, 0})).at(7), 43);

  const ClientSocket worker = connect(files_.client_of("operator"));
  EXPECT_EQ(ask(worker, write_to(0)), write_to(0));
  EXPECT_EQ(ask(worker, write_to(1)), refused(6));
  EXPECT_EQ(ask(worker, write_to(2)), refused(6));
  EXPECT_EQ(ask(worker, framed(2, {16, 0, 0, 0, 2, 4, 0, 1, 0, 2})), refused(16)) << "whole or not at all";
  EXPECT_EQ(ask(worker, framed(2, {22, 0, 1, 0, 0, 0, 1})), refused(22));
  EXPECT_EQ(ask(worker, framed(2, {6, 0, 99, 0, 9})), framed(2, {134, 2})) << "the address is looked at first";
  EXPECT_EQ(door_.value(0), 9);

  const ClientSocket writer = connect(files_.client_of("writer"));
  EXPECT_EQ(ask(writer, write_to(1)), write_to(1));
  EXPECT_EQ(ask(writer, framed(2, {3, 0, 0, 0, 1})), refused(3));
  EXPECT_EQ(ask(writer, framed(2, {43, 14, 1, 0})), refused(43));
  EXPECT_EQ(ask(writer, framed(2, {23, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 1})), refused(23));
  EXPECT_EQ(door_.writes(), 2U);
}

TEST_F(TlsServer, WhatIsNotOneKnownRoleMayNothing) {
  const std::string text =
      "\x0C\x03"
      "all";
  for (const test::CertificateRequest& request : {test::CertificateRequest{},
                                                  {.roles = {"unknown"}},
                                                  {.roles = {"All"}},
                                                  {.roles = {"all", "reader"}},
                                                  {.raw_role = "all"},
                                                  {.raw_role = text + "x"},
                                                  {.raw_role = "\x04\x03"
                                                               "all"},
                                                  {.raw_role = std::string("\x0C\x04"
                                                                           "all\0",
                                                                           6)},
                                                  {.raw_role = "\x0C\x7F"
                                                               "all"},
                                                  {.raw_role = std::string("\x0C\x00", 2)}}) {
    const Certificate own(request, &files_.authority);
    const auto context = test::client_context(&own);
    const ClientSocket client = connect(context);
    ASSERT_TRUE(client.connected());
    EXPECT_EQ(ask(client, framed(2, {3, 0, 0, 0, 1})), refused(3));
    EXPECT_EQ(ask(client, write_to(0)), refused(6));
  }
  EXPECT_EQ(door_.writes(), 0U);
}

TEST_F(TlsServer, ACertificateWithoutARoleHasRightsOfItsOwn) {
  TlsOptions options = files_.options();
  options.without_role = Rights{}.without_writes();
  const TlsContext context(options);
  const Certificate none({}, &files_.authority);
  const Certificate broken({.raw_role = "all"}, &files_.authority);
  const Certificate one({.roles = {"all"}}, &files_.authority);
  EXPECT_EQ(context.rights_of(*none.certificate()), Rights{}.without_writes());
  EXPECT_EQ(context.rights_of(*broken.certificate()), no_rights);
  EXPECT_EQ(context.rights_of(*one.certificate()), Rights{});
}

TEST_F(TlsServer, WhoHasNoCertificateThatCountsIsRefusedAndToldOf) {
  const Certificate stranger_authority({.name = "authority"}, nullptr);
  const std::vector<std::pair<std::string, std::unique_ptr<Certificate>>> cases = [&] {
    std::vector<std::pair<std::string, std::unique_ptr<Certificate>>> list;
    const auto add = [&](const char* reason, const test::CertificateRequest& request, const Certificate* authority) {
      list.emplace_back(reason, std::make_unique<Certificate>(request, authority));
    };
    add("certificate has expired", {.roles = {"all"}, .begins = -7200, .ends = -3600}, &files_.authority);
    add("certificate is not yet valid", {.roles = {"all"}, .begins = 3600, .ends = 7200}, &files_.authority);
    add("", {.roles = {"all"}}, &stranger_authority);
    add("self", {.roles = {"all"}}, nullptr);
    add("", {.roles = {"all"}, .for_clients = false}, &files_.authority);
    return list;
  }();
  std::uint64_t count = 0;
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    for (const auto& [reason, own] : cases) {
      const auto context = test::client_context(own.get(), version);
      const ClientSocket client = connect(context);
      EXPECT_EQ(ask(client, write_to(0)), Bytes()) << reason;
      ++count;
      EXPECT_TRUE(soon([&] { return server_->status().tls_failed == count; })) << reason;
    }
  }
  const auto nothing = test::client_context(nullptr);
  EXPECT_EQ(ask(connect(nothing), write_to(0)), Bytes());
  const ClientSocket plain(server_->port());
  EXPECT_EQ(ask(plain, write_to(0)).size() < 7, true) << "an alert, or nothing";
  const auto old = files_.client_of("all", TLS1_1_VERSION);
  EXPECT_FALSE(connect(old).connected());
  EXPECT_TRUE(soon([&] { return server_->status().tls_failed == count + 3; }));
  EXPECT_EQ(server_->status().requests, 0U);
  EXPECT_EQ(door_.writes(), 0U);
  EXPECT_TRUE(told().starts_with("127.0.0.1 is refused by TLS: certificate has expired.\n")) << told();
  EXPECT_LT(std::ranges::count(told(), '\n'), 13) << "a line a second, however many there are";
}

TEST_F(TlsServer, TheOneWhoseCertificateIsListedItselfIsServed) {
  const Certificate own({.roles = {"all"}}, nullptr);
  files_.folder.write("clients.pem", files_.authority.certificate_pem() + own.certificate_pem());
  const Server server(make_register_map(door_.points(), {.title = "T"}), door_,
                      {.port = 0, .tls = std::make_shared<const TlsContext>(files_.options())});
  const auto context = test::client_context(&own);
  EXPECT_EQ(ask(ClientSocket(server.port(), patience, context.get()), write_to(0)), write_to(0));
}

TEST_F(TlsServer, ManyRequestsInOneRecordAreAllAnswered) {
  const ClientSocket client = connect(files_.client_of("all"));
  Bytes many;
  for (int i = 0; i < 1300; ++i) {
    const Bytes request = framed(static_cast<std::uint16_t>(i), {3, 0, 0, 0, 1});
    many.insert(many.end(), request.begin(), request.end());
  }
  std::jthread sender([&] { EXPECT_TRUE(client.send(many)); });
  sender.join();
  for (int i = 0; i < 1300; ++i) {
    ASSERT_EQ(client.receive_frame(), framed(static_cast<std::uint16_t>(i), {3, 2, 0, 0})) << i;
  }
  SSL_shutdown(client.tls());
  EXPECT_TRUE(soon([&] { return server_->status().open == 0; })) << "who says good-bye is gone";
  EXPECT_EQ(server_->status().closed_by_client, 1U);
}

TEST_F(TlsServer, RequestsThatComeWithTheGoodByeAreAnswered) {
  const ClientSocket client = connect(files_.client_of("all"));
  client.send(write_to(0));
  SSL_shutdown(client.tls());
  EXPECT_TRUE(soon([&] { return server_->status().open == 0; }));
  EXPECT_EQ(server_->status().writes, 1U);
}

TEST_F(TlsServer, NoNewHandshakeInAConnection) {
  const auto context = files_.client_of("all", TLS1_2_VERSION);
  const ClientSocket client = connect(context);
  EXPECT_EQ(ask(client, write_to(0)), write_to(0));
  EXPECT_EQ(SSL_renegotiate(client.tls()), 1);
  EXPECT_NE(SSL_do_handshake(client.tls()), 1);
}

TEST_F(TlsServer, ASessionIsNotResumed) {
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    const auto context = files_.client_of("all", version);
    const ClientSocket first = connect(context);
    EXPECT_EQ(ask(first, write_to(0)), write_to(0));
    SSL_SESSION* const session = SSL_get1_session(first.tls());
    const std::unique_ptr<ssl_st, decltype(&SSL_free)> second(SSL_new(context.get()), SSL_free);
    const ClientSocket below(server_->port(), patience);
    SSL_set_session(second.get(), session);
    SSL_set_fd(second.get(), below.number());
    EXPECT_EQ(SSL_connect(second.get()), 1);
    EXPECT_EQ(SSL_session_reused(second.get()), 0) << "its certificate is looked at again";
    SSL_SESSION_free(session);
  }
}

class ImpatientTlsServer : public TlsServer {
 protected:
  ImpatientTlsServer() : TlsServer({.limits = {.frame_deadline = milliseconds(100), .handshake = milliseconds(400)}}) {}
};

TEST_F(ImpatientTlsServer, DeadlinesEndAHandshakeAndARecord) {
  const ClientSocket silent(server_->port());
  EXPECT_TRUE(silent.sees_the_end());
  EXPECT_EQ(server_->status().handshake_late, 1U);
  EXPECT_TRUE(told().ends_with("127.0.0.1 is refused by TLS: the handshake took too long.\n")) << told();
  const ClientSocket begun(server_->port());
  begun.send(Bytes{22, 3, 1, 0, 200, 1});
  EXPECT_TRUE(begun.sees_the_end());
  EXPECT_EQ(server_->status().frame_late, 1U);
  const auto context = files_.client_of("all");
  const ClientSocket half = connect(context);
  EXPECT_EQ(ask(half, write_to(0)), write_to(0));
  const Bytes record{23, 3, 3, 0, 64, 1, 2};
  EXPECT_EQ(::send(half.number(), record.data(), record.size(), 0), 7);
  EXPECT_TRUE(half.sees_the_end());
  EXPECT_EQ(server_->status().frame_late, 2U);
}

TEST_F(TlsServer, ReadOnlyGoesBeforeRoles) {
  const Server server(make_register_map(door_.points(), {.title = "T"}), door_,
                      {.port = 0, .read_only = true, .tls = std::make_shared<const TlsContext>(files_.options())});
  const auto context = files_.client_of("all");
  const ClientSocket client(server.port(), patience, context.get());
  EXPECT_EQ(ask(client, write_to(0)), refused(6));
  EXPECT_EQ(ask(client, test::read_one), framed(1, {3, 2, 0, 0}));
}

/// Other people's clients. Both come with Debian.
class OtherTlsClients : public TlsServer {
 protected:
  OtherTlsClients() {
    const Certificate own({.roles = {"all"}}, &files_.authority);
    files_.folder.write("client.pem", own.certificate_pem());
    files_.private_file("client.key", own.key_pem());
  }
  int run(const std::string& command) const {
    return std::system((command + " > " + (files_.folder / "out") + " 2> " + (files_.folder / "err")).c_str());
  }
  [[nodiscard]] std::string said() const {
    return test::contents_of(files_.folder / "out") + test::contents_of(files_.folder / "err");
  }
};

TEST_F(OtherTlsClients, OpensslSClient) {
  const std::string request = R"(printf '\000\007\000\000\000\006\001\006\000\000\000\011')";
  const auto line = [&](const std::string& more) {
    return "( " + request + "; sleep 1 ) | openssl s_client -quiet -no_ign_eof -verify_return_error -CAfile " +
           (files_.folder / "clients.pem") + " -connect 127.0.0.1:" + std::to_string(server_->port()) + more;
  };
  const std::string own = " -cert " + (files_.folder / "client.pem") + " -key " + (files_.folder / "client.key");
  EXPECT_EQ(run(line(own)), 0) << said();
  EXPECT_EQ(test::contents_of(files_.folder / "out"), std::string("\0\7\0\0\0\6\1\6\0\0\0\11", 12)) << said();
  EXPECT_EQ(door_.value(0), 9);
  (void)run(line(""));
  EXPECT_EQ(test::contents_of(files_.folder / "out"), "") << said();
  EXPECT_EQ(door_.writes(), 1U);
}

TEST_F(OtherTlsClients, Pymodbus) {
  EXPECT_EQ(run("/usr/bin/python3 " HYSTERON_SOURCE_DIR "/tests/runtime/modbus/tls_pymodbus.py " +
                std::to_string(server_->port()) + " " + (files_.folder / "client.pem") + " " +
                (files_.folder / "client.key")),
            0)
      << said();
  EXPECT_EQ(door_.value(1), 1234);
}

}  // namespace
}  // namespace hysteron::runtime::modbus
