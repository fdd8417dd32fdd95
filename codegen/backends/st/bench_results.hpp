// What a bench of tests leaves in plain variables, and how it judges a value.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/st/pou.hpp"

namespace hysteron {

/// What a person reads in the watch window, and what the program hands on.
struct BenchResult {
  std::string_view name;
  std::string_view type;
  std::string_view meaning;
};
[[nodiscard]] std::span<const BenchResult> bench_results();

[[nodiscard]] std::vector<StVariable> bench_result_variables();

struct BenchComparison {
  std::string_view prefix{};  ///< before a variable
  std::size_t slots = 1;      ///< places of expectations
  std::size_t outputs = 0;    ///< most of a block
};

/// The statement that takes an output over as a number: a truth value as 0 or 1.
[[nodiscard]] std::string bench_actual(const std::string& target, Type type, const std::string& from, bool float32);

/// First what is expected, then all outputs: whether they are numbers at all. X - X is 0 for each finite X alone.
[[nodiscard]] std::string bench_comparison(const BenchComparison& of);

/// A PROGRAM that calls one instance of the block of tests, with the results as its own variables.
[[nodiscard]] StPou bench_caller(const StPou& tests, Identifiers& names);

}  // namespace hysteron
