#include "examples/08_served_stage/stage.hpp"

#include <cmath>
#include <numbers>

namespace simulated {
namespace {

constexpr double sensor_noise = 0.02;               ///< standard deviation, µm
constexpr double converter_step = 100.0 / 65536.0;  ///< 16 bits over 100 µm
constexpr std::uint64_t seed_of_sensor = 8;

/// The actuator of example 5 at 5 kHz, its own sensor without noise and steps.
Settings settings() {
  Settings settings;
  settings.sample_time = Stage::period;
  settings.substeps = 5;
  settings.noise = 0.0;
  settings.converter_step = 0.0;
  return settings;
}

}  // namespace

/// Up to the highest voltage and back in a second: from there on every period begins where the last one ended.
Stage::Stage() : actuator_(settings()), noise_(seed_of_sensor) {
  for (int k = 0; k < 1000; ++k) {
    (void)actuator_.sample(1.8 - 1.8 * std::cos(2.0 * std::numbers::pi * period * k));
  }
  zero_ = actuator_.displacement();
  read_sensor();
}

void Stage::advance(double u) {
  (void)actuator_.sample(u);
  read_sensor();
}

void Stage::read_sensor() {
  const double seen = actuator_.displacement() - zero_ + sensor_noise * noise_();
  reading_ = converter_step * std::round(seen / converter_step);
}

}  // namespace simulated
