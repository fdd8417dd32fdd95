// The helpers of a generated header: each operation brings what it needs, also where it stands alone.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "codegen/backends/cpp/cpp.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

TEST(CppHelpers, EveryIntegerOperationCompilesAlone) {
  for (const std::string expression : {"A + 3", "A - 3", "A * 3", "A / 3", "A MOD 3", "-A", "MIN(A, 3)", "MAX(A, 3)"}) {
    const auto header = generate_cpp_header(compile_text(
        "FUNCTION_BLOCK D (* @ts 1ms *)\n  VAR_INPUT A : DINT; END_VAR\n  VAR_OUTPUT Q : DINT; END_VAR\n  Q := " +
        expression + ";\nEND_FUNCTION_BLOCK\n"));
    const test::ScratchFolder folder;
    const auto path = folder.write(header.name, header.text);
    const std::string compile =
        "c++ -std=c++20 -fsyntax-only -x c++ -include " + path + " /dev/null > " + (folder / "log") + " 2>&1";
    EXPECT_EQ(std::system(compile.c_str()), 0) << expression << "\n" << test::contents_of(folder / "log");
  }
}

}  // namespace
}  // namespace hysteron::testing
