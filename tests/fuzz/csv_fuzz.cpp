// libFuzzer: the reader and the writer of a record on any bytes.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/csv_property.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto outcome = hysteron::test::read_as_record({reinterpret_cast<const char*>(data), size});
  if (!outcome.flaw.empty()) {
    std::fprintf(stderr, "%s\n", outcome.flaw.c_str());
    std::abort();
  }
  return 0;
}
