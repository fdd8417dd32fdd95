#include "examples/05_simulated_actuator/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace simulated {
namespace {

constexpr Preisach::Thresholds thresholds{.low = -0.5, .distance = 0.01, .count = 501};

/// Most relays have thresholds close together, and more of them stand at low voltages: the loop is not symmetric.
double density(double upper, double lower) {
  const double width = upper - lower;
  const double middle = 0.5 * (upper + lower);
  return std::exp(-width / 1.8) * (1.0 - 0.12 * (middle - 1.8));
}

}  // namespace

double Noise::operator()() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) {
    // splitmix64, by S. Vigna
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    z ^= z >> 31U;
    sum += static_cast<double>(z >> 11U) * 0x1p-53;
  }
  return sum;
}

Actuator::Actuator(const Settings& settings)
    : settings_(settings),
      hysteresis_(thresholds, density),
      noise_(settings.seed),
      rest_(settings.irreversible * hysteresis_(0.0)) {
  const double step = settings.sample_time / settings.substeps;
  amplifier_keep_ = std::exp(-step / settings.amplifier_lag);
  for (std::size_t i = 0; i < creep_terms; ++i) {
    const double tau = 0.1 * std::pow(10.0, 0.5 * static_cast<double>(i));
    creep_keep_[i] = std::exp(-step / tau);
  }
}

void Actuator::advance(double u) {
  amplifier_ = u + (amplifier_ - u) * amplifier_keep_;
  prompt_ = settings_.elastic * amplifier_ * (1.0 + settings_.stiffening * amplifier_) +
            settings_.irreversible * hysteresis_(amplifier_) - rest_;
  for (std::size_t i = 0; i < creep_terms; ++i) {
    crept_[i] = prompt_ + (crept_[i] - prompt_) * creep_keep_[i];
  }
}

double Actuator::displacement() const {
  double creep = 0.0;
  for (const double term : crept_) {
    creep += term;
  }
  return prompt_ + 0.5 * settings_.creep_per_decade * creep;
}

double Actuator::sample(double u) {
  const double reading = settings_.sensor_offset + displacement() + settings_.noise * noise_();
  for (int i = 0; i < settings_.substeps; ++i) {
    advance(u);
  }
  return settings_.converter_step > 0.0 ? settings_.converter_step * std::round(reading / settings_.converter_step)
                                        : reading;
}

std::vector<double> play(std::span<const double> u, const Settings& settings) {
  Actuator actuator(settings);
  std::vector<double> y;
  y.reserve(u.size());
  for (const double value : u) {
    y.push_back(actuator.sample(value));
  }
  return y;
}

std::vector<double> identification_voltage(double sample_time) {
  const auto count = static_cast<std::size_t>(std::lround(40.0 / sample_time)) + 1;
  std::vector<double> u;
  for (std::size_t k = 0; k < count; ++k) {
    u.push_back(1.8 + 1.8 * std::sin(2.0 * std::numbers::pi * sample_time * static_cast<double>(k)));
  }
  return u;
}

std::vector<double> test_reference(double sample_time) {
  const auto count = static_cast<std::size_t>(std::lround(36.0 / sample_time));
  std::vector<double> reference;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = sample_time * static_cast<double>(k);
    const double amplitude =
        std::clamp(std::max(60.0 - 4.0 * t, 4.0 * t - 100.0), 0.0, 20.0);  // rest from 15 s to 25 s
    reference.push_back(amplitude * std::sin(2.0 * std::numbers::pi * t));
  }
  return reference;
}

std::vector<double> voltage_without_model(std::span<const double> reference) {
  std::vector<double> u;
  u.reserve(reference.size());
  for (const double value : reference) {
    u.push_back(1.83 + value / 12.55);
  }
  return u;
}

}  // namespace simulated
