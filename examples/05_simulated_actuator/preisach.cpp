#include "examples/05_simulated_actuator/preisach.hpp"

#include <algorithm>
#include <cmath>

namespace simulated {

Preisach::Preisach(const Thresholds& thresholds, const std::function<double(double, double)>& density)
    : thresholds_(thresholds) {
  std::vector<double> share;
  double sum = 0.0;
  for (std::size_t upper = 0; upper < thresholds.count; ++upper) {
    for (std::size_t lower = 0; lower <= upper; ++lower) {
      const auto threshold = [&](std::size_t k) {
        return thresholds.low + thresholds.distance * static_cast<double>(k);
      };
      // A cell on the diagonal is a triangle, half as large as the others.
      share.push_back(density(threshold(upper), threshold(lower)) * (upper == lower ? 0.5 : 1.0));
      sum += share.back();
    }
  }
  for (const double one : share) {
    weight_.push_back(std::llround(one / sum * 0x1p50));
    total_ += weight_.back();
  }
  is_up_.assign(weight_.size(), 0);
}

void Preisach::reset() {
  std::ranges::fill(is_up_, char{0});
  up_ = 0;
  reached_ = 0;
}

void Preisach::set(std::size_t relay, bool up) {
  if ((is_up_[relay] != 0) != up) {
    is_up_[relay] = up ? 1 : 0;
    up_ += up ? weight_[relay] : -weight_[relay];
  }
}

double Preisach::operator()(double input) {
  const double steps = std::floor((input - thresholds_.low) / thresholds_.distance) + 1.0;
  const auto reached = static_cast<std::size_t>(std::clamp(steps, 0.0, static_cast<double>(thresholds_.count)));
  while (reached_ < reached) {  // rising past v_i: every relay (i, j) goes up
    for (std::size_t lower = 0; lower <= reached_; ++lower) {
      set(index(reached_, lower), true);
    }
    ++reached_;
  }
  while (reached_ > reached) {  // falling below v_j: every relay (i, j) goes down
    --reached_;
    for (std::size_t upper = reached_; upper < thresholds_.count; ++upper) {
      set(index(upper, reached_), false);
    }
  }
  return static_cast<double>(up_) / static_cast<double>(total_);
}

}  // namespace simulated
