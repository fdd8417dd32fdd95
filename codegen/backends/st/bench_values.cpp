#include "codegen/backends/st/bench_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/literals.hpp"

namespace hysteron {
namespace {

/// A signal that changes no more often than this is written as a CASE over the steps, else as an array.
constexpr std::size_t most_changes_in_a_case = 16;

}  // namespace

std::string BenchValues::real(double value) const {
  return st_literal(Type::Real, value, {.float32 = false, .small_literals = dialect_.small_literals});
}
std::string BenchValues::value(Type type, double value, bool float32) const {
  const std::string digits = st_literal(type, value, {.float32 = float32, .small_literals = dialect_.small_literals});
  return (float32 && type == Type::Real ? "REAL#" : "") + digits;
}

std::string BenchValues::declare(std::string_view name, std::string type, std::uint32_t count, std::string remark,
                                 std::vector<std::string> values) {
  declared_.push_back({.name = std::string(name),
                       .type = std::move(type),
                       .length = count,
                       .values = std::move(values),
                       .remark = std::move(remark)});
  return local(name);
}

void BenchValues::write_input(const BenchTarget& to, const std::vector<double>& values, std::string_view array,
                              std::string& text) {
  std::vector<std::size_t> changes;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k == 0 || std::bit_cast<std::uint64_t>(values[k]) != std::bit_cast<std::uint64_t>(values[k - 1])) {
      changes.push_back(k);
    }
  }
  if (changes.size() == 1) {
    append(text, fmt::format("        {} := {};\n", to.target, value(to.type, values.front(), to.float32)));
  } else if (changes.size() <= most_changes_in_a_case) {
    append(text, "        CASE ", local("TEST_STEP"), " OF\n");
    for (const std::size_t k : changes) {
      append(text, fmt::format("          {}: {} := {};\n", k, to.target, value(to.type, values[k], to.float32)));
    }
    text += "        END_CASE;\n";
  } else {
    append(text, fmt::format("        {} := {}[{}];\n", to.target, array_of(array, to.type, to.float32, values),
                             local("TEST_STEP")));
  }
}

std::string BenchValues::array_of(std::string_view name, Type type, bool float32, const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double one : values) {
    texts.push_back(st_literal(type, one, {.float32 = float32, .small_literals = dialect_.small_literals}));
  }
  return declare(name, std::string(st_type(type, float32)), static_cast<std::uint32_t>(values.size()), "by step",
                 std::move(texts));
}

void BenchValues::write_expectation(std::size_t slot, const StExpectation& expected, std::size_t steps,
                                    std::string_view array, std::string& text) {
  const std::string check = fmt::format("{}[{}] := {};", local("CHECKED"), slot, expected.output + 1);
  const std::string wanted = fmt::format("{}[{}]", local("WANTED"), slot);
  const auto& values = expected.values;
  const bool constant =
      std::ranges::all_of(values, [&](const auto& one) { return one.second == values.begin()->second; });
  if (values.size() == steps && constant) {
    append(text, fmt::format("        {} {} := {};\n", check, wanted, real(values.begin()->second)));
  } else if (values.size() <= most_changes_in_a_case) {
    append(text, "        CASE ", local("TEST_STEP"), " OF\n");
    for (const auto& [step, value] : values) {
      append(text, fmt::format("          {}: {} {} := {};\n", step, check, wanted, real(value)));
    }
    text += "        END_CASE;\n";
  } else {
    std::vector<double> dense(steps);
    std::vector<double> asked(steps);
    for (const auto& [step, value] : values) {
      dense[step] = value;
      asked[step] = 1.0;
    }
    const std::string from = array_of(array, Type::Real, false, dense);
    const std::string assign = fmt::format("{} {} := {}[{}];\n", check, wanted, from, local("TEST_STEP"));
    if (values.size() == steps) {
      append(text, "        ", assign);
    } else {
      const std::string which = array_of(names_.make({array, "asked"}), Type::Bool, false, asked);
      append(text,
             fmt::format("        IF {}[{}] THEN\n          {}        END_IF;\n", which, local("TEST_STEP"), assign));
    }
  }
}

}  // namespace hysteron
