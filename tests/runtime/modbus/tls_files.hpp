// An authority, a server's files and clients' contexts, made for a test and gone with it.
#pragma once

#include <openssl/ssl.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>

#include "runtime/modbus/tls_context.hpp"
#include "tests/runtime/modbus/test_certificates.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::test {

using ClientContext = std::shared_ptr<ssl_ctx_st>;

/// What a client brings along. Without a certificate it has none. It trusts any server: what is tested is the server.
inline ClientContext client_context(const Certificate* own, int version = 0) {
  (void)std::signal(SIGPIPE, SIG_IGN);  // a server that closes must not end the test
  ClientContext context(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
  SSL_CTX_set_mode(context.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_CTX_set_options(context.get(), SSL_OP_IGNORE_UNEXPECTED_EOF);
  SSL_CTX_set_security_level(context.get(), 0);  // so that what is weak is refused by the server, not here
  if (version != 0) {
    SSL_CTX_set_min_proto_version(context.get(), version);
    SSL_CTX_set_max_proto_version(context.get(), version);
  }
  if (own != nullptr) {
    SSL_CTX_use_certificate(context.get(), own->certificate());
    SSL_CTX_use_PrivateKey(context.get(), own->key());
  }
  return context;
}

struct TlsFiles {
  TlsFiles() {
    folder.write("server.pem", server.certificate_pem());
    folder.write("clients.pem", authority.certificate_pem());
    private_file("server.key", server.key_pem());
  }

  void private_file(const std::string& name, const std::string& text) const {
    std::filesystem::permissions(folder.write(name, text), std::filesystem::perms(0600));
  }

  /// Roles as most tests want them.
  [[nodiscard]] runtime::modbus::TlsOptions options() const {
    using runtime::modbus::Rights;
    return {.certificate = folder / "server.pem",
            .key = folder / "server.key",
            .clients = folder / "clients.pem",
            .roles = {{"all", Rights{}},
                      {"reader", Rights{}.without_writes()},
                      {"operator", {.read = true, .inputs = true, .parameters = false, .reset = false}},
                      {"writer", {.read = false, .inputs = true, .parameters = true, .reset = true}}}};
  }
  [[nodiscard]] ClientContext client_of(const std::string& role, int version = 0) const {
    const Certificate own({.roles = {role}}, &authority);
    return client_context(&own, version);
  }

  ScratchFolder folder{};
  Certificate authority{{.name = "authority", .ends = 1000L * 24 * 3600}, nullptr};
  Certificate server{{.name = "server", .for_clients = false}, &authority};
};

}  // namespace hysteron::test
