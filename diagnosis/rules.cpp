#include "diagnosis/rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron::diagnosis {
namespace {

const Threshold& rule_of(const std::string& name) {
  std::string spoken = name;
  std::ranges::replace_if(
      spoken, [](char letter) { return letter == '-' || letter == '_'; }, ' ');
  const auto* const found =
      std::ranges::find_if(policy::all, [&](const Threshold& one) { return one.is_rule() && one.name == spoken; });
  if (found == policy::all.end()) {
    std::vector<std::string_view> rules;
    for (const Threshold& one : policy::all) {
      if (one.is_rule()) {
        rules.push_back(one.name);
      }
    }
    throw InputError(error::bad_usage, {}, fmt::format("There is no rule {} to leave out.", name),
                     fmt::format("the rules are {}.", fmt::join(rules, ", ")));
  }
  return *found;
}

}  // namespace

Rules::Rules(const std::vector<std::string>& without) {
  std::ranges::transform(without, std::back_inserter(without_),
                         [](const std::string& one) { return rule_of(one).name; });
}

double Rules::operator[](const Threshold& threshold) const {
  return std::ranges::find(without_, threshold.name) != without_.end() ? threshold.neutral : threshold.value;
}

bool Rules::is_above(const Threshold& threshold, double measured, std::string_view about) {
  const bool above = measured > (*this)[threshold];
  keep(threshold, measured, about, above ? "above" : "below");
  return above;
}

double Rules::capped(const Threshold& threshold, double confidence) {
  const double limit = (*this)[threshold];
  if (confidence > limit) {
    keep(threshold, confidence, {}, "held down");
  }
  return std::min(confidence, limit);
}

void Rules::keep(const Threshold& threshold, double measured, std::string_view about, std::string_view outcome) {
  decisions_.push_back({.rule = std::string(threshold.name),
                        .about = std::string(about),
                        .measured = measured,
                        .threshold = (*this)[threshold],
                        .unit = std::string(threshold.unit),
                        .outcome = std::string(outcome)});
}

}  // namespace hysteron::diagnosis
