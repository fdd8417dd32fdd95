#include "diagnosis/model/ignored_columns.hpp"

#include <gmock/gmock.h>

#include <string>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::AllOf;
using testing::HasSubstr;

DiagnosisInput ignoring(const std::string& column) {
  DiagnosisInput input = test::input_of(test::axis(), "[diagnose]\nignore = [\"" + column + "\"]\n",
                                        {test::warm_sensor(), test::record_of("FORCE", test::rich_force())});
  ignore_columns(input);
  return input;
}

TEST(IgnoredColumns, AreTakenOutOfEveryRecordThatHasThem) {
  const DiagnosisInput input = ignoring("Temp");
  EXPECT_EQ(input.records[0].find("temp"), nullptr);
  EXPECT_NE(input.records[0].find("FORCE"), nullptr);
  EXPECT_EQ(input.records[1].names(), std::vector<std::string>{"FORCE"});
}

TEST(IgnoredColumns, ANameThatIsNoneIsRefused) {
  const auto refusal = [](const std::string& column) {
    try {
      (void)ignoring(column);
    } catch (const InputError& error) {
      const Diagnostic& first = error.diagnostics().all().front();
      return fmt::format("{} {}: {} {}", first.number, first.place.line, first.cause, first.mend);
    }
    return std::string("taken");
  };
  EXPECT_THAT(refusal("temmp"), AllOf(HasSubstr("502 2: temmp is to be ignored"), HasSubstr("did you mean temp?")));
  EXPECT_THAT(refusal("force"), HasSubstr("603 2: force is an input of AXIS"));
  EXPECT_THAT(refusal("V"), AllOf(HasSubstr("603 2: V is an output of AXIS"), HasSubstr("[tune]")));
}

}  // namespace
}  // namespace hysteron::diagnosis
