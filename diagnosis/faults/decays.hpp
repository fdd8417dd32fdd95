// A sum of decays in a signal: it leaps at a few samples and dies away with one time constant,
//
//   e_k = p·e_(k−1) + a_k + noise,   p = exp(−1/T),   a_k ≠ 0 at a few samples only,   T in samples.
//
// The leaps are found one after the other, each time the one that stands farthest out of white noise, all a_k fitted
// anew (orthogonal matching pursuit: Pati, Rezaiifar and Krishnaprasad 1993). From one leap to the next the sum is one
// decay, of a size that no other stretch has a part in: so each stretch is fitted by itself, and a further leap changes
// the one that it divides.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diagnosis/effects/signals.hpp"

namespace hysteron::diagnosis {

/// In one signal, which outlives them.
class Decays {
 public:
  Decays(std::span<const double> values, double pole);

  /// The next leap, and how far it stands out, as the values do.
  struct Next {
    std::size_t at = 0;
    double size = 0.0;
  };
  [[nodiscard]] Next next() const;
  void add(std::size_t leap);

  /// The sum of all decays.
  [[nodiscard]] Signal sum() const;
  [[nodiscard]] const std::vector<std::size_t>& leaps() const { return leaps_; }
  [[nodiscard]] double energy_left() const;  ///< Σ of the squares that they leave

 private:
  /// The stretch that begins at a leap.
  void fit_from(std::vector<std::size_t>::const_iterator leap);

  double pole_;
  std::span<const double> values_;
  std::vector<double> left_;
  std::vector<double> deviations_;    ///< of a sum over so many samples, of white noise; by their count less 1
  std::vector<std::size_t> leaps_{};  ///< in order
};

/// Of one time constant in several signals.
struct Train {
  double time_constant = 0.0;  ///< samples
  std::vector<Decays> signals{};
  std::size_t leaps = 0;
  double left = 0.0;       ///< energy
  double penalised = 0.0;  ///< with what each leap has to gain
};

/// With so many leaps at most, each `far` out.
[[nodiscard]] Train train_of(const std::vector<Signal>& signals, double time_constant, double far, std::size_t most);

}  // namespace hysteron::diagnosis
