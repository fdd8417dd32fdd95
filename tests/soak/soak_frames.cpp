// Mutated frames through framing and answers of the server, under AddressSanitizer and UndefinedBehaviorSanitizer: a
// row of the table of long counts. Whatever a sanitizer finds ends the program.
#include "tests/runtime/modbus/damaged_conversations.hpp"
#include "tests/soak/rows.hpp"

#ifndef __SANITIZE_ADDRESS__
#error "the row says that sanitizers look on"
#endif

int main(int argc, char** argv) {
  using hysteron::soak::Counted;
  const std::vector<hysteron::soak::Row> rows{
      {"frames", "mutated conversations under ASan and UBSan", 10'000'000, [](std::uint64_t count) {
         const std::string flaw = hysteron::test::flaw_of_damaged_conversations(count);
         return Counted{count, flaw.empty() ? "no flaw, and the sanitizers found nothing" : flaw, flaw.empty()};
       }}};
  return hysteron::soak::run_rows(rows, std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
}
