// A simulated piezo actuator, finer than any model that is fitted to it. Its records are simulated, not measured.
//
//   u ── amplifier lag ── hysteresis (relays) and elasticity ── creep ── sensor: noise, converter ── y
//
// It is written apart from the blocks and includes none of them, so that a model tuned on its records meets effects
// that it does not contain: minor loops that close and are wiped out, creep, lag, noise. Units: V, µm, s.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "examples/05_simulated_actuator/preisach.hpp"

namespace simulated {

/// What the simulated machine is made of. The presets are near a PICMA stack with its amplifier at the control input.
struct Settings {
  double sample_time = 0.005;               ///< of the records, s
  int substeps = 25;                        ///< steps of the simulation to one sample: 5 kHz
  double amplifier_lag = 0.003;             ///< time constant, s
  double elastic = 6.4;                     ///< displacement without memory, µm/V
  double stiffening = -0.010;               ///< its change with the voltage, 1/V
  double irreversible = 35.5;               ///< displacement of all relays together, µm
  double creep_per_decade = 0.015;          ///< growth of a displacement in each decade of time, as a share of it
  double noise = 0.06;                      ///< standard deviation of the sensor, µm
  double converter_step = 100.0 / 65536.0;  ///< 16 bits over 100 µm
  double sensor_offset = -119.0;            ///< reading at rest, µm
  std::uint64_t seed = 1;                   ///< of the noise
};

/// Normally distributed numbers from integers and sums alone, so that a seed means the same numbers everywhere.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  /// Mean 0, standard deviation 1: the sum of twelve uniform numbers, less 6.
  double operator()();

 private:
  std::uint64_t state_;
};

class Actuator {
 public:
  explicit Actuator(const Settings& settings = {});

  /// One sample: reads the sensor, then applies u until the next one, as a digital controller does. So y answers to the
  /// voltage of the sample before.
  double sample(double u);

  /// The true displacement now, without the sensor, µm from rest.
  [[nodiscard]] double displacement() const;

  [[nodiscard]] const Settings& settings() const { return settings_; }

 private:
  static constexpr std::size_t creep_terms = 10;  ///< two to a decade of time, from 0.1 s to 3162 s

  void advance(double u);

  Settings settings_;
  Preisach hysteresis_;
  Noise noise_;
  double amplifier_ = 0.0;                        ///< voltage at the stack, in volts of the control input
  double rest_ = 0.0;                             ///< displacement of the relays that are up at 0 V
  double prompt_ = 0.0;                           ///< displacement without creep
  std::array<double, creep_terms> crept_{};       ///< displacement that each term has taken up
  std::array<double, creep_terms> creep_keep_{};  ///< exp(−dt/τ)
  double amplifier_keep_ = 0.0;
};

/// Plays any voltage from rest, one value a sample.
std::vector<double> play(std::span<const double> u, const Settings& settings = {});

/// The voltage of the identification record: 40 periods of 1 Hz between 0 and 3.6 V.
std::vector<double> identification_voltage(double sample_time);

/// The reference of the feedforward test, µm about the middle: a 1 Hz sine of ±20 µm that falls slowly to a rest, and
/// rises slowly again. Its minor loops lie within one another.
std::vector<double> test_reference(double sample_time);

/// The straight line from that reference to a voltage, which a controller without a model of the hysteresis would use.
std::vector<double> voltage_without_model(std::span<const double> reference);

}  // namespace simulated
