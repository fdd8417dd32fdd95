// Fifty thousand damaged conversations with the server; tests/fuzz drives the same property by libFuzzer.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/modbus_property.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/support/mutation.hpp"

namespace hysteron::runtime::modbus {
namespace {

TEST(Conversation, DamagedRequestsAreAnsweredOrEndedAndWriteNothingForbidden) {
  std::vector<std::string> pieces;
  std::string all(1, '\x0b');
  for (const test::Bytes& request :
       {test::framed(1, {3, 0, 0, 0, 4}), test::framed(2, {4, 0, 0, 0, 8}), test::framed(3, {1, 0, 0, 0, 8}),
        test::framed(4, {16, 0, 12, 0, 2, 4, 0, 1, 0, 2}), test::framed(5, {6, 0, 16, 0, 5}),
        test::framed(6, {15, 0, 0, 0, 9, 2, 255, 1}), test::framed(7, {22, 0, 16, 0, 242, 0, 37}),
        test::framed(8, {23, 0, 0, 0, 4, 0, 16, 0, 1, 2, 0, 9}), test::framed(9, {43, 14, 3, 0})}) {
    pieces.emplace_back(request.begin(), request.end());
    all += pieces.back();
  }
  std::mt19937 random(12);
  for (int i = 0; i < 50'000; ++i) {
    const std::string text =
        test::mutated(i % 2 == 0 ? all : all[0] + pieces[random() % pieces.size()], pieces, random);
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    ASSERT_EQ(test::flaw_of_conversation(bytes), "") << i;
  }
}

}  // namespace
}  // namespace hysteron::runtime::modbus
