// Two things of one kind, side by side: what differs, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "records/record.hpp"

namespace hysteron::tool {

struct Comparison {
  bool same = true;
  std::string text{};  ///< lines; what differs alone
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
};

/// a and b are the same where |b − a| ≤ absolute + relative·|a|; with both 0, where they are equal, and any two that
/// are not a number.
struct Tolerance {
  double absolute = 0.0;
  double relative = 0.0;
  [[nodiscard]] bool holds(double a, double b) const;
};

/// Column by column, at the times that both have: the largest and the RMS difference, where it is first beyond the
/// tolerance, and whether all bits are equal. Columns and rows that one alone has are differences. Throws InputError:
/// HY730 where they have no time in common, HY729 where units do not meet.
[[nodiscard]] Comparison compare_records(const records::Record& a, const records::Record& b,
                                         const Tolerance& tolerance);

/// Value by value: old, new, and the change in %. Initial states as well.
[[nodiscard]] Comparison compare_parameters(const parameters::ParameterFile& a, const parameters::ParameterFile& b,
                                            const Tolerance& tolerance);

/// By the graphs: ports, blocks, parameters, and what each pin and output is wired to. Layout, comments and the order
/// of statements are no difference.
[[nodiscard]] Comparison compare_diagrams(const Program& a, const Program& b);

/// Family, member, place, confidence and gap of two verdict.json. Throws InputError HY730 where one is no verdict.
[[nodiscard]] Comparison compare_verdicts(const std::string& a, const std::string& b, const Tolerance& tolerance);

/// "+12.5 %"; "–" where a is 0 or one of them is not finite.
[[nodiscard]] std::string change_text(double a, double b);

}  // namespace hysteron::tool
