// What a test case says of the outputs of a run: what is expected, the golden record, and equal bits.
#pragma once

#include <string>
#include <vector>

#include "records/record.hpp"
#include "tool/test_plan.hpp"

namespace hysteron::tool {

/// One failure of a case: a line, and a plot or nothing.
struct Failure {
  std::string cause{};
  std::string plot{};
};

/// Outputs against what the case expects, and against infinities and not-a-numbers.
[[nodiscard]] std::vector<Failure> judge(const PlannedCase& planned, const std::vector<Signal>& outputs);

/// Outputs of the generated code against the interpreter's, bit for bit.
[[nodiscard]] std::vector<Failure> judge_bits(const PlannedCase& planned, const std::vector<Signal>& interpreted,
                                              const std::vector<Signal>& generated);

/// Outputs against the golden record.
[[nodiscard]] std::vector<Failure> judge_golden(const PlannedCase& planned, const std::vector<Signal>& outputs);

/// The golden record of a case.
[[nodiscard]] records::Record read_golden(const PlannedCase& planned);

/// What a column of a golden record says of an output.
[[nodiscard]] ValuesByStep golden_values(const records::Column& column);

/// The golden record that these outputs make.
[[nodiscard]] std::string golden_text(const PlannedCase& planned, const std::vector<Signal>& outputs);

}  // namespace hysteron::tool
