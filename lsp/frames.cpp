// Content-Length framing of LSP 3.17, "Base Protocol".
#include <algorithm>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>

#include "lsp/server.hpp"
#include "support/names.hpp"
#include "support/whole_number.hpp"

namespace hysteron::lsp {
namespace {

using nlohmann::json;

constexpr int parse_error = -32700;
/// No diagram is near it; a length above it is a fault of the client, and no reason to take the memory.
constexpr std::size_t longest_message = std::size_t{64} << 20U;

void send(std::ostream& out, const json& message) {
  const auto text = message.dump(-1, ' ', false, json::error_handler_t::replace);
  out << "Content-Length: " << text.size() << "\r\n\r\n" << text << std::flush;
}

/// The Content-Length of the header at the front of a stream, none where it has no readable one. The stream is then
/// behind the header's empty line.
std::optional<std::size_t> read_header(std::istream& in) {
  constexpr std::string_view key = "Content-Length:";
  std::optional<std::size_t> length;
  for (std::string line; std::getline(in, line) && line != "\r" && !line.empty();) {
    if (equal_ignoring_case(std::string_view(line).substr(0, key.size()), key)) {
      const auto first = std::min(line.find_first_not_of(' ', key.size()), line.size());
      const auto end = line.ends_with('\r') ? line.size() - 1 : line.size();
      length = whole_number<std::size_t>(std::string_view(line).substr(first, end - first));
    }
  }
  return length;
}

json unreadable(std::string_view why) {
  return {{"jsonrpc", "2.0"}, {"id", nullptr}, {"error", {{"code", parse_error}, {"message", why}}}};
}

}  // namespace

int serve(std::istream& in, std::ostream& out, Card card) {
  Server server(std::move(card));
  while (!server.has_exited() && in.peek() != std::istream::traits_type::eof()) {
    const auto length = read_header(in);
    if (!length) {
      send(out, unreadable("A message begins with a header Content-Length: and its length in bytes."));
      continue;
    }
    if (*length > longest_message) {
      in.ignore(static_cast<std::streamsize>(*length));
      send(out, unreadable("The message is longer than 64 MiB."));
      continue;
    }
    std::string text(*length, '\0');
    if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) {
      break;
    }
    const auto message = json::parse(text, nullptr, false);
    if (message.is_discarded()) {
      send(out, unreadable("The message is not JSON."));
      continue;
    }
    for (const auto& answer : server.handle(message)) {
      send(out, answer);
    }
  }
  return server.was_shut_down() ? 0 : 1;
}

}  // namespace hysteron::lsp
