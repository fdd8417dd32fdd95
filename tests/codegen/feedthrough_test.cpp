// Feedthrough pinned: which inputs reach which outputs within the same step decides what may stand in a loop. It is
// derived from the blocks; a change of it is meant, and then written down: HYSTERON_UPDATE=1 test_codegen.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "codegen/trace/block_type.hpp"

namespace hysteron {
namespace {

std::string table() {
  std::string text;
  for (const BlockType& type : block_types()) {
    text += std::string(type.about.name) + "\n";
    for (std::size_t port = 0; port < type.outputs.size(); ++port) {
      text += "  " + std::string(type.outputs[port].name) + " <-";
      for (std::size_t pin = 0; pin < type.inputs.size(); ++pin) {
        if (type.trace.feedthrough[port].contains(pin)) {
          text += " " + std::string(type.inputs[pin].name);
        }
      }
      text += "\n";
    }
  }
  return text;
}

TEST(Feedthrough, IsAsWrittenDown) {
  const std::string path = std::string(HYSTERON_SOURCE_DIR) + "/tests/codegen/feedthrough.txt";
  if (std::getenv("HYSTERON_UPDATE") != nullptr) {
    std::ofstream(path) << table();
  }
  std::ifstream file(path);
  std::stringstream pinned;
  pinned << file.rdbuf();
  EXPECT_EQ(table(), pinned.str());
}

TEST(Feedthrough, OfTheBlocksThatCloseLoops) {
  const auto pins = [](std::string_view name, std::size_t port) {
    return find_block_type(name)->trace.feedthrough[port];
  };
  EXPECT_TRUE(pins("HY_DELAY", 0).empty() || !pins("HY_DELAY", 0).contains(0));
  EXPECT_FALSE(pins("HY_INTEGRAL_FORWARD", 0).contains(0));
  EXPECT_FALSE(pins("HY_MOMENTUM", 0).contains(0));
  EXPECT_TRUE(pins("HY_INTEGRAL", 0).contains(0));
}

}  // namespace
}  // namespace hysteron
