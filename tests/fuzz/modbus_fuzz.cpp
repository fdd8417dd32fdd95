// libFuzzer: framing and answers of the Modbus server on any bytes, cut anywhere.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/modbus_property.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string flaw = hysteron::test::flaw_of_conversation({data, size});
  if (!flaw.empty()) {
    std::fprintf(stderr, "%s\n", flaw.c_str());
    std::abort();
  }
  return 0;
}
