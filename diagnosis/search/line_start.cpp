#include "diagnosis/search/line_start.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace hysteron::diagnosis {
namespace {

/// What each output shows at one frequency: real and imaginary parts of its Fourier sum. The window sin⁴ keeps out what
/// is slow, however large.
VectorXd at_frequency(const Task& task, const VectorXd& values, double frequency) {
  const Index rows = values.size() / std::ssize(task.outputs);
  VectorXd result(2 * std::ssize(task.outputs));
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    std::complex<double> sum;
    Index row = output * rows;
    for (const records::Record& record : task.records) {
      const auto size = static_cast<Index>(record.size());
      const double turn = 2.0 * std::numbers::pi * frequency * record.sample_time();
      for (Index k = 0; k < size; ++k, ++row) {
        const double window =
            std::pow(std::sin(std::numbers::pi * static_cast<double>(k) / static_cast<double>(size)), 4);
        sum += std::polar(window * values[row], -turn * static_cast<double>(k));
      }
    }
    result[2 * output] = sum.real();
    result[2 * output + 1] = sum.imag();
  }
  return result;
}

const Start* line_of(const Screened& one) {
  const Applied& own = one.candidate.own();
  const auto found = std::ranges::find_if(one.starts, &Start::measured);
  return own.has(Role::Frequency) && found != one.starts.end() ? &*found : nullptr;
}

}  // namespace

bool is_line(const Screened& one) {
  return line_of(one) != nullptr;
}

Explanation with_line(const Task& task, const Screened& one, const Explanation& from) {
  Explanation result = placed(task, one, *line_of(one), from.fit.x);
  Model model(task, *result.variant.program, result.variant.further);
  const Index first = model.first_further() + std::ssize(result.variant.further) - std::ssize(one.unknowns);
  double frequency = 0.0;
  std::vector<Index> sizes;
  VectorXd neutral = result.fit.x;
  for (Index k = 0; k < std::ssize(one.unknowns); ++k) {
    const EffectParameter& parameter = one.candidate.own().parameter(one.unknowns[static_cast<std::size_t>(k)].path);
    if (parameter.role == Role::Frequency) {
      frequency = result.fit.x[first + k];
    } else if (parameter.strength) {
      sizes.push_back(first + k);
      neutral[first + k] = parameter.field.neutral;
    }
  }
  VectorXd without;
  if (sizes.empty() || !model.residuals(neutral, without)) {
    return result;
  }
  MatrixXd lines(2 * std::ssize(task.outputs), std::ssize(sizes));
  for (Index k = 0; k < lines.cols(); ++k) {
    const Index at = sizes[static_cast<std::size_t>(k)];
    VectorXd x = neutral;
    x[at] = result.fit.x[at];
    VectorXd with;
    if (!model.residuals(x, with)) {
      return result;
    }
    lines.col(k) = at_frequency(task, with - without, frequency);
  }
  const VectorXd shares = lines.completeOrthogonalDecomposition().solve(-at_frequency(task, without, frequency));
  for (Index k = 0; k < lines.cols(); ++k) {
    const Index at = sizes[static_cast<std::size_t>(k)];
    const double size = neutral[at] + shares[k] * (result.fit.x[at] - neutral[at]);
    result.fit.x[at] = std::clamp(size, model.lower()[at], model.upper()[at]);
  }
  result.fit = fit(model, result.fit.x, {.iterations = 0});
  keep_starts(result, model);
  return result;
}

}  // namespace hysteron::diagnosis
