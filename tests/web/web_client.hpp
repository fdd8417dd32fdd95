// A client of the live page for tests: requests and frames byte by byte, well-formed or not.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "tests/runtime/modbus/client_socket.hpp"

namespace hysteron::test {

inline constexpr const char* token = "0123456789abcdef";
inline const std::string authorized = std::string("Authorization: Bearer ") + token + "\r\n";

struct WebReply {
  int status = 0;  ///< 0: none came
  std::map<std::string, std::string> headers{};
  std::string body{};
};

struct WebFrame {
  unsigned opcode = 0;  ///< 1 text, 8 close, 9 ping
  std::string payload{};
};

class WebClient {
 public:
  explicit WebClient(std::uint16_t port, std::chrono::milliseconds patience = std::chrono::seconds(10))
      : socket_(port, patience), host_("127.0.0.1:" + std::to_string(port)) {}

  [[nodiscard]] const ClientSocket& socket() const { return socket_; }

  bool send(std::string_view text) const {
    return socket_.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

  /// `lines`: further headers, each with its end of line.
  bool request(std::string_view method, std::string_view target, const std::string& lines = {},
               const std::string& body = {}) const {
    std::string text = std::string(method) + " " + std::string(target) + " HTTP/1.1\r\nHost: " + host_ + "\r\n" + lines;
    text += body.empty() ? "\r\n" : "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
    return send(text);
  }

  [[nodiscard]] WebReply ask(std::string_view method, std::string_view target, const std::string& lines = {},
                             const std::string& body = {}) const {
    return request(method, target, lines, body) ? reply() : WebReply{};
  }

  [[nodiscard]] WebReply reply() const {
    WebReply reply;
    std::string head;
    while (!head.ends_with("\r\n\r\n")) {
      const std::string one = receive(1);
      if (one.empty()) {
        return {};
      }
      head += one;
    }
    reply.status = std::atoi(head.c_str() + 9);  // behind HTTP/1.1
    for (auto at = head.find("\r\n") + 2; at + 2 < head.size();) {
      const auto end = head.find("\r\n", at);
      const auto colon = head.find(": ", at);
      reply.headers[head.substr(at, colon - at)] = head.substr(colon + 2, end - colon - 2);
      at = end + 2;
    }
    if (reply.headers.contains("Content-Length")) {
      reply.body = receive(static_cast<std::size_t>(std::stoul(reply.headers["Content-Length"])));
    }
    return reply;
  }

  /// Asks for the stream; the status of the answer, 101 where it is open.
  [[nodiscard]] int open_stream(const std::string& lines = {}, std::string_view target = "/api/stream") const {
    return ask("GET", target,
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   lines)
        .status;
  }

  /// A frame as a client has to send it; a mask of zeros leaves the payload as it is.
  bool send_frame(unsigned opcode, std::string_view payload, bool masked = true, unsigned first_bits = 0x80) const {
    std::string frame(1, static_cast<char>(first_bits | opcode));
    const unsigned mask = masked ? 0x80 : 0;
    if (payload.size() < 126) {
      frame += static_cast<char>(mask | payload.size());
    } else {
      frame += static_cast<char>(mask | 127U);
      for (int shift = 56; shift >= 0; shift -= 8) {
        frame += static_cast<char>((payload.size() >> static_cast<unsigned>(shift)) & 0xFFU);
      }
    }
    return send(frame + (masked ? std::string(4, '\0') : "") + std::string(payload));
  }

  /// The next message, in one piece or several; none where the server closed or the patience is at an end. Pings are
  /// answered.
  [[nodiscard]] std::optional<WebFrame> frame() const {
    WebFrame all;
    for (bool last = false; !last;) {
      const std::string head = receive(2);
      if (head.size() < 2) {
        return {};
      }
      const auto byte = [&](const std::string& text, std::size_t i) { return static_cast<unsigned char>(text[i]); };
      const unsigned opcode = byte(head, 0) & 0x0FU;
      std::size_t size = byte(head, 1) & 0x7FU;
      if (size >= 126) {
        const std::string more = receive(size == 126 ? 2 : 8);
        size = 0;
        for (std::size_t i = 0; i < more.size(); ++i) {
          size = size << 8U | byte(more, i);
        }
      }
      const std::string payload = receive(size);
      if (opcode == 9) {
        (void)send_frame(10, payload);
        continue;
      }
      last = (byte(head, 0) & 0x80U) != 0;
      all.opcode = opcode != 0 ? opcode : all.opcode;
      all.payload += payload;
    }
    return all;
  }

  [[nodiscard]] std::string receive(std::size_t count) const {
    const Bytes bytes = socket_.receive(count);
    return {bytes.begin(), bytes.end()};
  }

 private:
  ClientSocket socket_;
  std::string host_;
};

}  // namespace hysteron::test
