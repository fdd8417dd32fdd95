// What is said of a file that is no TOML: the line as it should be.
#include "support/toml_text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

std::string mend_of(const std::string& text) {
  const TomlKind kind{error::parameter_file_syntax, error::duplicate_key, "a value as K = 2.0"};
  try {
    (void)parse_toml("p.toml", text, kind);
  } catch (const InputError& refused) {
    return refused.diagnostics().all().front().mend;
  }
  return "read";
}

TEST(TomlText, TheMendIsTheLineAsItShouldBe) {
  const std::pair<std::string, std::string> cases[] = {
      {"[fit.A]\nK = 0,05  # um/V\n", "write a decimal point: K = 0.05."},
      {"K = -1234,5\n", "write a decimal point: K = -1234.5."},
      {"K = .5\n", "write digits on both sides of the point: K = 0.5."},
      {"K = 5.\n", "write digits on both sides of the point: K = 5.0."},
      {"C1 := 0.05\n", "write an equals sign between name and value: C1 = 0.05."},
      {"C1: 0,05\n", "write an equals sign between name and value: C1 = 0.05."},
      {"K = TRUE\n", "write true in small letters."},
      {"K = 0.05\n", "read"},
  };
  for (const auto& [text, mend] : cases) {
    EXPECT_EQ(mend_of(text), mend) << text;
  }
}

}  // namespace
}  // namespace hysteron
