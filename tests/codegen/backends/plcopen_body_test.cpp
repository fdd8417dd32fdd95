// A block with a sequential body in a network: its steps are no wires, so it is refused by its name.
#include <gtest/gtest.h>

#include <string>

#include "codegen/backends/plcopen/plcopen.hpp"
#include "codegen/compile.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

constexpr const char* counting = R"(FUNCTION_BLOCK COUNTING (* @ts 10ms @body *)
  VAR_INPUT GO : BOOL; END_VAR
  VAR_OUTPUT N : DINT; END_VAR
  IF GO THEN N := N + 1; END_IF;
END_FUNCTION_BLOCK
)";

constexpr const char* around = R"(FUNCTION_BLOCK AROUND (* @ts 10ms *)
  VAR_INPUT X : BOOL; END_VAR
  VAR_OUTPUT Y : DINT; END_VAR
  VAR C : COUNTING; END_VAR
  C(GO := X);
  Y := C.N;
END_FUNCTION_BLOCK
)";

TEST(PlcopenBody, ASequentialBodyIsNoNetwork) {
  for (const std::string& text : {std::string(counting), std::string(counting) + around}) {
    const Program program = compile_text(text, {.top = text == counting ? "COUNTING" : "AROUND"});
    for (const char* const dialect : {"portable", "openplc", "codesys", "twincat"}) {
      try {
        (void)generate_plcopen(program, {.dialect = dialect, .body = PlcopenBody::Network});
        FAIL() << "an empty network would hold 0 in all outputs";
      } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().all().size(), 1U);
        const Diagnostic& told = error.diagnostics().all().front();
        EXPECT_EQ(told.number, error::no_network);
        EXPECT_EQ(told.place.line, 1U);
        EXPECT_EQ(told.cause, "'COUNTING' has a sequential body, and a network has wires alone");
      }
    }
    EXPECT_NE(generate_plcopen(program, {}).front().text.find("<ST>"), std::string::npos);
  }
}

}  // namespace
}  // namespace hysteron
