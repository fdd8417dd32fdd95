#include "diagnosis/evidence/driver_lines.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {
namespace {

/// Σ (x − mean)·exp(i·angle·k). The turns follow from each other, from a new one every few dozen: rounding adds up to
/// some 1e-14.
std::complex<double> turned(const Signal& values, double mean, double angle) {
  constexpr std::size_t from_each_other = 64;
  const std::complex<double> step = std::polar(1.0, angle);
  std::complex<double> sum = 0.0;
  for (std::size_t begin = 0; begin < values.size(); begin += from_each_other) {
    std::complex<double> turn = std::polar(1.0, angle * static_cast<double>(begin));
    for (std::size_t k = begin; k < std::min(values.size(), begin + from_each_other); ++k) {
      sum += (values[k] - mean) * turn;
      turn = {turn.real() * step.real() - turn.imag() * step.imag(),
              turn.real() * step.imag() + turn.imag() * step.real()};
    }
  }
  return sum;
}

/// Of a signal's energy about its mean, what a sine of that frequency explains, within the resolution of the record.
double share_of_line(const RecordSignals& values, double frequency, double sample_time) {
  double best = 0.0;
  for (const Signal& one : values) {
    const auto n = static_cast<double>(one.size());
    const double mean = std::accumulate(one.begin(), one.end(), 0.0) / std::max(n, 1.0);
    double whole = 0.0;
    for (const double value : one) {
      whole += (value - mean) * (value - mean);
    }
    for (const double off : {-0.5, 0.0, 0.5}) {
      const double angle = 2.0 * std::numbers::pi * (frequency + off / (n * sample_time)) * sample_time;
      best = std::max(best, whole > 0.0 ? 2.0 * std::norm(turned(one, mean, angle)) / (n * whole) : 0.0);
    }
  }
  return best;
}

}  // namespace

void bar_lines_of(const std::vector<DriverSignal>& drivers, double sample_time, std::vector<double>& frequencies) {
  constexpr int harmonics = 6;
  std::erase_if(frequencies, [&](double frequency) {
    return std::ranges::any_of(drivers, [&](const DriverSignal& driver) {
      for (int k = 1; k <= harmonics; ++k) {
        if (share_of_line(driver.values, frequency / k, sample_time) > policy::line_of_driver.value) {
          return true;
        }
      }
      return false;
    });
  });
}

}  // namespace hysteron::diagnosis
