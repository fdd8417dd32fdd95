#include "tuning/goal/wished_response.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "blocks/oscillation.hpp"

namespace hysteron {
namespace {

constexpr double band = 0.02;  // within which a response has settled

/// What is left of a step after τ = t/T.
double left_of_step(int order, double damping, double tau) {
  return order == 1 ? std::exp(-tau) : oscillate({1.0, 0.0}, oscillation_step(damping, tau)).position;
}

/// Where a condition that is false before and true behind becomes true.
double bisect(double low, double high, const std::function<bool(double)>& is_behind) {
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (is_behind(middle) ? high : low) = middle;
  }
  return high;
}

/// τ of the last time that the response leaves the band. By then the envelope, or the slower exponential, is in it.
double settling_tau(int order, double damping) {
  const double slowest = order == 1 ? 1.0 : damping <= 1.0 ? damping : 1.0 / (2.0 * damping);
  const double end = (8.0 - std::log(band)) / slowest;
  const double step = std::min(0.01, 1e-3 * end);
  double outside = 0.0;
  for (double tau = 0.0; tau < end; tau += step) {
    outside = std::fabs(left_of_step(order, damping, tau)) > band ? tau : outside;
  }
  return bisect(outside, outside + step,
                [&](double tau) { return std::fabs(left_of_step(order, damping, tau)) <= band; });
}

/// τ from 10 to 90 %: up to there the response rises.
double rise_tau(int order, double damping) {
  const double end = settling_tau(order, damping);
  const auto reaches = [&](double share) {
    double tau = 0.0;
    const double step = 1e-3 * end;
    while (left_of_step(order, damping, tau) > 1.0 - share) {
      tau += step;
    }
    return bisect(tau - step, tau, [&](double at) { return left_of_step(order, damping, at) <= 1.0 - share; });
  };
  return reaches(0.9) - reaches(0.1);
}

}  // namespace

WishedResponse wished_response(const parameters::GoalSettings& goal) {
  WishedResponse wished;
  wished.order = goal.order ? static_cast<int>(goal.order->value) : 2;
  wished.damping = goal.damping ? goal.damping->value : 1.0;
  wished.dead_time = goal.dead_time ? goal.dead_time->value : 0.0;
  const double settling = settling_tau(wished.order, wished.damping);
  wished.time = goal.settling_time ? goal.settling_time->value / settling
                                   : goal.rise_time->value / rise_tau(wished.order, wished.damping);
  wished.settling = wished.dead_time + settling * wished.time;
  return wished;
}

Signal response_to(const WishedResponse& wished, const Signal& input, double sample_time) {
  const double tau = sample_time / wished.time;
  const auto late = static_cast<std::size_t>(std::llround(wished.dead_time / sample_time));
  Signal response(input.size(), input.empty() ? 0.0 : input.front());
  Oscillation<double> left{0.0, 0.0};  // of the way from the response to the input
  for (std::size_t k = 0; k + 1 < input.size(); ++k) {
    if (k > 0) {
      left.position += input[k] - input[k - 1];
    }
    left = wished.order == 1 ? Oscillation<double>{left.position * std::exp(-tau), 0.0}
                             : oscillate(left, oscillation_step(wished.damping, tau));
    if (k + 1 + late < response.size()) {
      response[k + 1 + late] = input[k] - left.position;
    }
  }
  return response;
}

}  // namespace hysteron
