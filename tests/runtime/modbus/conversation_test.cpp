// Fifty thousand damaged conversations with the server; tests/soak has many more, under sanitizers.
#include <gtest/gtest.h>

#include "tests/runtime/modbus/damaged_conversations.hpp"

namespace hysteron::runtime::modbus {
namespace {

TEST(Conversation, DamagedRequestsAreAnsweredOrEndedAndWriteNothingForbidden) {
  EXPECT_EQ(test::flaw_of_damaged_conversations(50'000), "");
}

}  // namespace
}  // namespace hysteron::runtime::modbus
