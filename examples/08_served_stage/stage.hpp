// The simulated piezo stage of example 8: hysteresis by relays, creep and an amplifier's lag from example 5, behind a
// sensor with noise and a converter. It includes none of the blocks.
#pragma once

#include "examples/05_simulated_actuator/simulator.hpp"

namespace simulated {

class Stage {
 public:
  Stage();

  /// One period of 1 ms with a voltage; then the sensor is read.
  void advance(double u);
  /// What the sensor showed at the end of the last period, µm from rest.
  [[nodiscard]] double reading() const { return reading_; }

  static constexpr double period = 1e-3;  ///< s

 private:
  void read_sensor();

  Actuator actuator_;
  Noise noise_;
  double zero_ = 0.0;  ///< displacement that the sensor shows as 0
  double reading_ = 0.0;
};

}  // namespace simulated
