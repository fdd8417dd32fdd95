// Damaged conversations with the server; tests/fuzz drives the same property by libFuzzer.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/modbus_property.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/support/mutation.hpp"

namespace hysteron::test {

/// What is wrong with the first that is answered wrongly; empty where none is.
inline std::string flaw_of_damaged_conversations(std::uint64_t count) {
  std::vector<std::string> pieces;
  std::string all(1, '\x0b');
  for (const Bytes& request : {framed(1, {3, 0, 0, 0, 4}), framed(2, {4, 0, 0, 0, 8}), framed(3, {1, 0, 0, 0, 8}),
                               framed(4, {16, 0, 12, 0, 2, 4, 0, 1, 0, 2}), framed(5, {6, 0, 16, 0, 5}),
                               framed(6, {15, 0, 0, 0, 9, 2, 255, 1}), framed(7, {22, 0, 16, 0, 242, 0, 37}),
                               framed(8, {23, 0, 0, 0, 4, 0, 16, 0, 1, 2, 0, 9}), framed(9, {43, 14, 3, 0})}) {
    pieces.emplace_back(request.begin(), request.end());
    all += pieces.back();
  }
  std::mt19937 random(12);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string text = mutated(i % 2 == 0 ? all : all[0] + pieces[random() % pieces.size()], pieces, random);
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    if (const std::string flaw = flaw_of_conversation(bytes); !flaw.empty()) {
      return std::to_string(i) + ": " + flaw;
    }
  }
  return "";
}

}  // namespace hysteron::test
