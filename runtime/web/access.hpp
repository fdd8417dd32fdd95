// Who may see and who may change what the live page shows: the address it listens on, the token, and the headers by
// which a browser says on whose behalf it asks.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/point.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime::web {

/// A numeric address and a port.
struct Endpoint {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0 takes any that is free
  bool is_loopback = true;
};

/// 127.0.0.1:8080 or [::1]:8080. Throws InputError HY842.
[[nodiscard]] Endpoint parse_endpoint(std::string_view text);

/// The token that a file holds: one line, 16 to 256 printable characters without spaces, to be read by its owner alone.
/// Throws InputError HY844, which never quotes it.
[[nodiscard]] std::string read_token(const std::string& file);

/// The names under which a service manager hands the token files over.
inline constexpr const char* token_credential = "web-token";
inline constexpr const char* read_token_credential = "web-read-token";

/// ADDRESS:PORT as a link has it, with the port that was taken.
[[nodiscard]] std::string text_of(const Endpoint& endpoint, std::uint16_t port);

struct Access {
  bool is_loopback = true;
  std::string token{};       ///< empty: nobody may change anything
  std::string read_token{};  ///< of who may only look, as a scraper of /metrics; empty: there is none
  PageRights rights{};       ///< of who has the token

  [[nodiscard]] bool can_write() const { return !token.empty(); }
  /// Beyond the loopback nothing is shown to strangers.
  [[nodiscard]] bool reading_needs_token() const { return !is_loopback; }
};

/// Throws InputError HY843 where the page would be open to a network without a token, and HY844 where who may only look
/// would have the token of who may write.
void check_access(const Endpoint& endpoint, const Access& access);

/// Whether a text is the token; takes as long whatever its first wrong character is. Never where there is no token.
[[nodiscard]] bool is_token(const Access& access, std::string_view text);
/// The same for the header Authorization: Bearer TOKEN.
[[nodiscard]] bool is_authorized(const Access& access, std::string_view authorization);
/// Whether a text is one of the tokens, so that who has it may look.
[[nodiscard]] bool is_reading_token(const Access& access, std::string_view text);
[[nodiscard]] bool may_read(const Access& access, std::string_view authorization);

/// Whether the header Host names this machine's loopback. A page of a stranger whose name resolves to 127.0.0.1 does
/// not.
[[nodiscard]] bool is_loopback_host(std::string_view host);
/// Whether a request comes from a page of this server, or from no page at all: Origin is empty, or names Host.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host);

}  // namespace hysteron::runtime::web
