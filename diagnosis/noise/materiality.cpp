#include "diagnosis/noise/materiality.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/model/task.hpp"

namespace hysteron::diagnosis {
namespace {

double excess(double high, double low) {
  return std::sqrt(std::max(0.0, high * high - low * low));
}

}  // namespace

double Materiality::rms(const VectorXd& residuals, std::size_t output) const {
  return rms_of(task_, residuals, output);
}

bool Materiality::matters(double high, double low, std::size_t output) const {
  return excess(high, low) > std::max(least_excess(floors_[output]), least_);
}

bool Materiality::is_left(const VectorXd& residuals, std::size_t output) const {
  return matters(rms(residuals, output), floors_[output].value, output);
}

bool Materiality::is_left(const VectorXd& residuals) const {
  bool left = false;
  for (std::size_t output = 0; output < floors_.size(); ++output) {
    left = left || is_left(residuals, output);
  }
  return left;
}

bool Materiality::is_too_small(const VectorXd& residuals) const {
  bool above = false;
  for (std::size_t output = 0; output < floors_.size(); ++output) {
    above = above || excess(rms(residuals, output), floors_[output].value) > least_excess(floors_[output]);
  }
  return above && !is_left(residuals);
}

bool Materiality::was_taken_for_noise(const VectorXd& before, const VectorXd& after) const {
  bool was = false;
  for (std::size_t output = 0; output < floors_.size(); ++output) {
    const double left = rms(after, output);
    was = was || (left < floors_[output].value && matters(rms(before, output), left, output));
  }
  return was;
}

}  // namespace hysteron::diagnosis
