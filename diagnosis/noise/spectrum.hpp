// Lines in a residual: over time, for disturbances that the clock drives, and over a position, for ripple.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

namespace hysteron::diagnosis {

/// With a Hann window. Its lines are its peaks, refined by a parabola through the logarithms of three bins.
class Periodogram {
 public:
  Periodogram(const Eigen::VectorXd& values, double sample_time);

  /// The frequencies of the strongest lines, Hz, strongest first.
  [[nodiscard]] std::vector<double> strongest_lines(std::size_t count) const;
  /// Those that stand at least twenty times above the median about them, highest first: what acts before an integrator
  /// leaves a line that slow residuals outweigh a thousandfold.
  [[nodiscard]] std::vector<double> outstanding_lines(std::size_t count) const;

 private:
  [[nodiscard]] double frequency_of(std::size_t peak) const;

  std::vector<double> power_{};
  std::vector<std::size_t> peaks_{};  ///< of them, by their bins
  double bin_ = 0.0;                  ///< Hz
};

/// The step on which values lie, 0 where on none: the largest |Σ exp(2πi y/q)|/N over q from a third to 1/4096 of their
/// range, if above 0.5, with N the narrow bins that hold a value. Values that are rounded by a sensor and then get
/// noise of less than a tenth of the step show it. A few levels near which a signal rests lie on some step by chance,
/// and are none: what is off them is neither little nor as fast as noise.
[[nodiscard]] double common_step(const std::vector<double>& values);

/// That step, and behind it the largest one with more than 0.9 in the place of 0.5 where that is another: of values
/// that were rounded twice the first is the fine one and the second the coarse one. Empty where they lie on none.
[[nodiscard]] std::vector<double> clear_steps(const std::vector<double>& values);

/// What rounding to a step takes off, RMS: step/√12.
[[nodiscard]] double rounded_off(double step);

/// Those steps, or where there are none one that noise of up to a third of it hides: the peak of |Σ exp(2πi y/q)| that
/// stands highest over the median about it, if six times as high. A start for a fit, no finding: where a machine rests
/// now and then, its levels may lie on a step by chance.
[[nodiscard]] std::vector<double> likely_steps(const std::vector<double>& values);

/// The step next to a likely one of which the values are multiples: a step q that begins anywhere may be off by some of
/// its own thousandths, and where the values are hundreds of steps from 0 that is a part of a step there. Their phase
/// over 2π, arg(mean of exp(2πi y/q)), has then to be 0. The step itself where no other near it gives that.
[[nodiscard]] double step_from_zero(const std::vector<double>& values, double step);

/// How well values y lie on a step q: |mean of exp(2πi y/q)|, 1 on the step itself, wherever it begins.
[[nodiscard]] double alignment(const std::vector<double>& values, double step);

/// Of values about steps that are aligned so well, the deviation of the normal noise that takes them off: the mean of
/// exp(2πi y/q) is exp(−2π²σ²/q²) long.
[[nodiscard]] double deviation_off_steps(double step, double alignment);

/// The deviation of white noise by the sizes of second differences, σ² = E(∆²y)²/6; of slow noise less.
[[nodiscard]] double deviation_by_second_differences(std::vector<double> sizes);

/// The periods over a signal at which the residual oscillates most, in the unit of the signal, strongest first: least
/// squares of sine and cosine on a fine grid (Lomb 1976). `signal` by record, in the order of the residual's rows.
[[nodiscard]] std::vector<double> strongest_periods(const Eigen::VectorXd& residuals,
                                                    const std::vector<std::vector<double>>& signal, std::size_t count);

/// So many periods over a signal are tried for an effect.
inline constexpr std::size_t periods_tried = 8;

/// The same of one residual over many signals, those of equal ones found once. Threads may ask side by side. The
/// residual and the signals have to outlive it.
class StrongestPeriods {
 public:
  using Signals = std::vector<std::vector<double>>;
  StrongestPeriods(const Eigen::VectorXd& residuals, std::size_t count) : residuals_(residuals), count_(count) {}

  [[nodiscard]] const std::vector<double>& over(const Signals& signal);

 private:
  struct ByValue {
    bool operator()(const Signals* a, const Signals* b) const { return a != b && *a < *b; }
  };

  const Eigen::VectorXd& residuals_;
  std::size_t count_;
  std::mutex mutex_{};
  std::map<const Signals*, std::vector<double>, ByValue> found_{};
};

}  // namespace hysteron::diagnosis
