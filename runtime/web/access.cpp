#include "runtime/web/access.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <optional>

#include "runtime/modbus/allow_list.hpp"
#include "support/byte_order_mark.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "support/whole_number.hpp"

namespace hysteron::runtime::web {
namespace {

constexpr std::size_t shortest_token = 16;
constexpr std::size_t longest_token = 256;

/// The address of HOST:PORT or [HOST]:PORT, without brackets; the port is empty where there is none.
struct Parts {
  std::string_view address;
  std::string_view port;
};

Parts parts_of(std::string_view text) {
  if (text.starts_with('[')) {
    const auto end = text.find(']');
    if (end == std::string_view::npos || (end + 1 < text.size() && text[end + 1] != ':')) {
      return {};
    }
    return {text.substr(1, end - 1), end + 1 < text.size() ? text.substr(end + 2) : std::string_view()};
  }
  const auto colon = text.find(':');
  return colon == std::string_view::npos ? Parts{text, {}} : Parts{text.substr(0, colon), text.substr(colon + 1)};
}

/// Every character of what was given is looked at, whether it fits or not. No text is an empty token.
bool is_same(const std::string& token, std::string_view text) {
  if (token.empty()) {
    return false;
  }
  unsigned difference = text.size() == token.size() ? 0U : 1U;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char own = token[i % token.size()];
    difference |= static_cast<unsigned>(static_cast<unsigned char>(text[i]) ^ static_cast<unsigned char>(own));
  }
  return difference == 0;
}

/// Of Authorization: Bearer TOKEN; empty where there is none.
std::string_view bearer_in(std::string_view authorization) {
  constexpr std::string_view scheme = "Bearer ";
  return authorization.starts_with(scheme) ? authorization.substr(scheme.size()) : std::string_view();
}

bool is_loopback_address(const modbus::AddressBytes& bytes) {
  static const auto four = modbus::Network::parse("127.0.0.0/8");
  static const auto six = modbus::Network::parse("::1/128");
  return four->contains(bytes) || six->contains(bytes);
}

}  // namespace

Endpoint parse_endpoint(std::string_view text) {
  const Parts parts = parts_of(text);
  const auto bytes = modbus::address_bytes(parts.address);
  const auto port = whole_number<std::uint16_t>(parts.port);
  if (!bytes || !port) {
    throw InputError(error::malformed_web_address, {}, fmt::format("{} is no numeric address with a port.", text),
                     "write 127.0.0.1:8080, or [::1]:8080 for IPv6.");
  }
  return {.address = std::string(parts.address), .port = *port, .is_loopback = is_loopback_address(*bytes)};
}

std::string text_of(const Endpoint& endpoint, std::uint16_t port) {
  const bool six = endpoint.address.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", six ? "[" : "", endpoint.address, six ? "]" : "", port);
}

std::string read_token(const std::string& file) {
  const auto refuse = [&](const std::string& cause, const std::string& mend) -> InputError {
    return {error::unfit_token_file, Place{.file = file}, cause, mend};
  };
  std::string text = without_mark(read_text_file(file));
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || (status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw refuse("Others than its owner may read or change the token file.", fmt::format("chmod 600 {}", file));
  }
  while (text.ends_with('\n') || text.ends_with('\r')) {
    text.pop_back();
  }
  const bool printable = std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
  if (!printable || text.size() < shortest_token || text.size() > longest_token) {
    throw refuse(fmt::format("The token file does not hold one line of {} to {} printable characters without spaces.",
                             shortest_token, longest_token),
                 fmt::format("head -c 24 /dev/urandom | base64 > {}", file));
  }
  return text;
}

void check_access(const Endpoint& endpoint, const Access& access) {
  if (access.can_write() && access.token == access.read_token) {
    throw InputError(error::unfit_token_file, {},
                     "Both token files hold the same token: who may only look could change parameters.",
                     "let each hold one of its own: head -c 24 /dev/urandom | base64.");
  }
  if (!endpoint.is_loopback && !access.can_write() && access.read_token.empty()) {
    throw InputError(error::open_web_page, {},
                     fmt::format("On {} the live page would show every value to whoever reaches it.", endpoint.address),
                     "listen on 127.0.0.1 and reach it through a tunnel, or give it a token: --web-token-file FILE or "
                     "--web-read-token-file FILE, in the run file token_file or read_token_file under [web].");
  }
}

bool is_token(const Access& access, std::string_view text) {
  return is_same(access.token, text);
}

bool is_authorized(const Access& access, std::string_view authorization) {
  return is_token(access, bearer_in(authorization));
}

bool is_reading_token(const Access& access, std::string_view text) {
  const bool is_reader = is_same(access.read_token, text);
  return is_token(access, text) || is_reader;
}

bool may_read(const Access& access, std::string_view authorization) {
  return is_reading_token(access, bearer_in(authorization));
}

bool is_loopback_host(std::string_view host) {
  const Parts parts = parts_of(host);
  if (!parts.port.empty() && !whole_number<std::uint16_t>(parts.port)) {
    return false;
  }
  const auto bytes = modbus::address_bytes(parts.address);
  return parts.address == "localhost" || (bytes && is_loopback_address(*bytes));
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  if (origin.empty()) {
    return true;
  }
  for (const std::string_view scheme : {"http://", "https://"}) {  // https where a proxy stands before it
    if (origin.starts_with(scheme)) {
      return origin.substr(scheme.size()) == host;
    }
  }
  return false;
}

}  // namespace hysteron::runtime::web
