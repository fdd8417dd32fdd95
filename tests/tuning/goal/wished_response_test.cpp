// Wished responses against their closed forms.
#include "tuning/goal/wished_response.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hysteron {
namespace {

parameters::GoalSettings wish_of(double settling, double order, double damping) {
  parameters::GoalSettings settings;
  settings.settling_time = {.value = settling};
  settings.order = {.value = order};
  if (order == 2.0) {
    settings.damping = {.value = damping};
  }
  return settings;
}

TEST(WishedResponse, OfFirstOrderSettlesAfterLnFiftyTimeConstants) {
  EXPECT_NEAR(wished_response(wish_of(1.0, 1.0, 1.0)).time, 1.0 / std::log(50.0), 1e-9);
  parameters::GoalSettings rising;
  rising.order = {.value = 1.0};
  rising.rise_time = {.value = 1.0};
  EXPECT_NEAR(wished_response(rising).time, 1.0 / std::log(9.0), 1e-9);
}

TEST(WishedResponse, OfSecondOrderSettlesWhereItSays) {
  for (const double damping : {0.4, 0.7, 1.0, 2.5}) {
    const WishedResponse wished = wished_response(wish_of(0.8, 2.0, damping));
    Signal step(4000, 1.0);
    step.front() = 0.0;
    const Signal y = response_to(wished, step, 1e-3);
    double last_outside = 0.0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      last_outside = std::fabs(y[k] - 1.0) > 0.02 ? 1e-3 * (static_cast<double>(k) - 1.0) : last_outside;
    }
    EXPECT_NEAR(last_outside, 0.8, 1.5e-3) << damping;
  }
}

TEST(WishedResponse, OfSecondOrderIsTheClosedForm) {
  const WishedResponse wished{.order = 2, .time = 0.1, .damping = 1.0, .dead_time = 0.02};
  Signal step(500, 3.0);
  std::fill(step.begin(), step.begin() + 10, 1.0);
  const Signal y = response_to(wished, step, 1e-2);
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double t = 1e-2 * (static_cast<double>(k) - 12.0) / 0.1;
    EXPECT_NEAR(y[k], t <= 0.0 ? 1.0 : 3.0 - 2.0 * (1.0 + t) * std::exp(-t), 1e-12) << k;
  }
}

/// A lag follows a ramp late by its time constant; held from sample to sample, by half a sample more.
TEST(WishedResponse, FollowsARampLate) {
  const WishedResponse wished{.order = 1, .time = 0.2};
  Signal ramp;
  for (int k = 0; k < 600; ++k) {
    ramp.push_back(0.01 * k);
  }
  EXPECT_NEAR(ramp.back() - response_to(wished, ramp, 0.01).back(), 0.01 / (1.0 - std::exp(-0.05)), 1e-9);
}

}  // namespace
}  // namespace hysteron
