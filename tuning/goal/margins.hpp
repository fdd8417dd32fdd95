// Margins of a sampled loop from the impulse response of its sensitivity.
//
//   S(ω) = Σ h(k)·e^(−jωk·TS) = 1/(1 + L(ω)),   L = (1 − S)/S,   up to the Nyquist frequency π/TS
//
//   largest sensitivity  Ms = max |S|
//   phase margin         min over |L| = 1 of |180° + arg L|
//   gain margin          min over arg L = −180° of the factor, up or down, that takes |L| to 1
//
// For a loop that is stable, as one whose h dies away is. Derivatives by unknowns are exact: of a maximum by Danskin's
// theorem, of a crossing by the implicit function theorem. K. J. Åström, R. M. Murray, Feedback Systems, 2nd ed.,
// ch. 10.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "tuning/simulation.hpp"

namespace hysteron {

/// A margin, where it is measured, and its derivatives. Infinite where nothing crosses.
struct Margin {
  double value = 0.0;
  double frequency = 0.0;  ///< rad/s
  Eigen::VectorXd by{};    ///< by unknown; empty without derivatives, zero where nothing crosses
};

struct LoopMargins {
  Margin gain{};           ///< dB, above 0
  Margin phase{};          ///< degrees, 0 to 180
  Margin sensitivity{};    ///< |S|
  double crossover = 0.0;  ///< rad/s, the highest with |L| = 1; 0 where there is none
};

/// One point of a frequency response.
struct FrequencyPoint {
  double frequency = 0.0;  ///< rad/s
  std::complex<double> sensitivity{};
  [[nodiscard]] std::complex<double> open_loop() const { return (1.0 - sensitivity) / sensitivity; }
};

/// The sensitivity of one loop, evaluated at any frequency.
class Sensitivity {
 public:
  /// `impulse_by` may be empty: no derivatives then. Both outlive it.
  Sensitivity(const Signal& impulse, const Eigen::MatrixXd& impulse_by, double sample_time);

  /// ln |S| at a frequency in rad/s, with its derivatives.
  [[nodiscard]] Margin log_size(double frequency) const;
  /// The local maxima of |S| that are above a level, each refined between the points of the grid; the largest first.
  [[nodiscard]] std::vector<double> peaks_above(double level) const;
  [[nodiscard]] LoopMargins margins() const;
  /// On a logarithmic grid from where h no longer tells, up to the Nyquist frequency.
  [[nodiscard]] const std::vector<FrequencyPoint>& grid() const { return grid_; }

 private:
  struct Local {
    std::complex<double> value{};
    std::complex<double> slope{};  ///< ∂S/∂ω
    Eigen::VectorXcd by{};
  };
  [[nodiscard]] std::complex<double> at(double frequency) const;
  [[nodiscard]] Local local_at(double frequency) const;
  [[nodiscard]] Margin phase_at(double frequency) const;
  [[nodiscard]] Margin gain_at(double frequency) const;
  /// Where a function of L that differs in sign at two frequencies is 0.
  template <class Function>
  [[nodiscard]] double root_between(double low, double high, Function function) const;
  [[nodiscard]] double peak_near(std::size_t point) const;

  const Signal& impulse_;
  const Eigen::MatrixXd& impulse_by_;
  double sample_time_;
  std::vector<FrequencyPoint> grid_{};
};

}  // namespace hysteron
