// Preisach's hysteresis as what it is: very many relays side by side, each with two thresholds of its own.
//
// Written for the simulated machine alone. It shares nothing with the blocks that are tuned on its records.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace simulated {

/// Relays (i, j) with j ≤ i on evenly spaced thresholds v_0 < v_1 < …: a relay goes up as the input reaches v_i, and
/// down as the input falls below v_j. Between them it stays as it is; that is the memory.
///
/// The weights of the relays are integers, so that their sum knows no rounding: an input that returns to where a minor
/// loop began finds the very same output (return-point memory).
class Preisach {
 public:
  struct Thresholds {
    double low = 0.0;        ///< v_0
    double distance = 0.01;  ///< between neighbours
    std::size_t count = 0;
  };

  /// The density of relays over their upper and lower threshold; it need not be normalised.
  Preisach(const Thresholds& thresholds, const std::function<double(double upper, double lower)>& density);

  /// All relays down.
  void reset();
  /// Moves the input on, and gives the share of relays that are up, by weight: 0 to 1.
  double operator()(double input);

  [[nodiscard]] std::size_t relays() const { return weight_.size(); }

 private:
  [[nodiscard]] static std::size_t index(std::size_t upper, std::size_t lower) {
    return upper * (upper + 1) / 2 + lower;
  }
  void set(std::size_t relay, bool up);

  Thresholds thresholds_;
  std::vector<std::int64_t> weight_;
  std::vector<char> is_up_;
  std::int64_t total_ = 0;
  std::int64_t up_ = 0;
  std::size_t reached_ = 0;  ///< thresholds that the input has reached
};

}  // namespace simulated
