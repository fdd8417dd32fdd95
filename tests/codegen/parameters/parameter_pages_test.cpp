// The pages of the errors of parameter files keep their word: the failing text fails with that number, the mended one
// is read.
#include <gtest/gtest.h>

#include <string>

#include "codegen/parameters/parameter_file.hpp"
#include "support/errors.hpp"
#include "tests/codegen/parameters/refusal.hpp"
#include "tests/support/error_page.hpp"

namespace hysteron::parameters {
namespace {

TEST(ErrorPages, OfParameterFiles) {
  for (const int number : {error::parameter_file_syntax, error::duplicate_key, error::unknown_key,
                           error::wrong_value_type, error::parameter_not_finite, error::contradicting_range}) {
    const auto name = "HY" + std::to_string(number);
    SCOPED_TRACE(name);
    const auto page = test::read_error_page(name);
    EXPECT_EQ(page.number, name);
    EXPECT_EQ(page.title, title_of(number));
    EXPECT_EQ(refusals_of(page.fails.text).all().front().number, number);
    EXPECT_NO_THROW((void)parse_parameter_file("plant.toml", page.mended.text));
  }
}

}  // namespace
}  // namespace hysteron::parameters
