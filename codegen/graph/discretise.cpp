#include "codegen/graph/discretise.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "codegen/graph/elaborator.hpp"
#include "codegen/trace/sized_block.hpp"

namespace hysteron {

HeldSystem discretise_held(std::span<const double> num, std::span<const double> den, double ts) {
  const auto n = static_cast<Eigen::Index>(den.size()) - 1;
  // Time in units of 1/rate: no pole is faster than 2·rate (a bound of Fujiwara's kind).
  double rate = 0.0;
  for (std::size_t k = 1; k < den.size(); ++k) {
    rate = std::max(rate, std::pow(std::abs(den[k] / den[0]), 1.0 / static_cast<double>(k)));
  }
  rate = rate > 0.0 ? rate : 1.0 / ts;
  const auto scaled = [&](std::span<const double> numbers, std::size_t place) {
    return numbers[place] / (den[0] * std::pow(rate, static_cast<double>(place + den.size() - numbers.size())));
  };
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(n + 1, n + 1);
  HeldSystem held;
  held.d = num.size() == den.size() ? num[0] / den[0] : 0.0;
  held.c.assign(static_cast<std::size_t>(n), 0.0);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (k + 1 < n) {
      both(k, k + 1) = 1.0;
    }
    const auto place = static_cast<std::size_t>(n - k);  // of the coefficient of s^k in den
    const double a = scaled(den, place);
    both(n - 1, k) = -a;
    const auto missing = den.size() - num.size();
    held.c[static_cast<std::size_t>(k)] = (place >= missing ? scaled(num, place - missing) : 0.0) - held.d * a;
  }
  both(n - 1, n) = 1.0;
  const Eigen::MatrixXd exponential = (both * (ts * rate)).exp();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      held.phi.push_back(exponential(i, k));
    }
    held.gamma.push_back(exponential(i, n));
  }
  return held;
}

void Elaborator::discretise(const Instance& instance, const Declared& declared, Part& part, Rate rate) {
  if (!is_sized(declared) || !declared.block->sized->kind->is_discretised) {
    return;
  }
  std::vector<double> num;
  std::vector<double> den;
  for (const language::Argument& setting : declared.variable->settings) {
    const bool is_num = language::same_name(setting.pin.text, "NUM");
    const bool is_den = language::same_name(setting.pin.text, "DEN");
    if (is_num || is_den) {
      Field field;
      field.name = is_num ? "NUM" : "DEN";
      field.length = most_states + 1;
      const bool list = std::holds_alternative<language::ArrayLiteral>(source_.expressions[setting.value].node);
      field.length = list ? field.length : 1;
      constant_array(setting.value, field, is_num ? num : den, true);
    }
  }
  const std::size_t n = declared.block->sized->sizes.n;
  if (num.size() != declared.block->sized->sizes.m || den.size() != n + 1) {
    return;  // told
  }
  // A block that is looked at by itself may leave the sample time to those that use it.
  const double ts = (graph_.sample_time_ns > 0 ? graph_.sample_time() : 1.0) * rate.every;
  HeldSystem held = discretise_held(num, den, ts);
  for (auto i = static_cast<std::uint32_t>(declared.block->inputs.size()); i < declared.block->pin_count(); ++i) {
    const Field& field = declared.block->pin(i);
    if (graph_.wires[graph_.nodes[part.node].first_wire + i].from != Wire::From::Nothing) {
      continue;
    }
    std::vector<double> value = field.name == "PHI"     ? held.phi
                                : field.name == "GAMMA" ? held.gamma
                                : field.name == "C"     ? held.c
                                                        : std::vector<double>{held.d};
    const std::string path = upper(instance.path + std::string(declared.field.name)) + "." + upper(field.name);
    given_.emplace(path, value.size());
    open_parameters_.push_back(
        {.path = path, .field = field, .value = std::move(value), .span = declared.variable->name.span});
    graph_.wires[graph_.nodes[part.node].first_wire + i] = {Wire::From::Parameter, field.type, 0,
                                                            static_cast<std::uint32_t>(open_parameters_.size() - 1)};
  }
}

}  // namespace hysteron
