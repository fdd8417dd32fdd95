// A signal of an axis as a sum of what a joint has. Internal to joint.cpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "robots/joint.hpp"

namespace hysteron::robots {

/// What an input contributes to a signal.
struct DrivePart {
  std::size_t input = 0;
  double gain = 1.0;
  double lag = 0.0;
  Range control{};
  Range force{};  ///< of the signal
};

/// A signal, as a sum: its own numbers, of which the velocity's is v and ∫v dt stands for the position.
struct Terms {
  double velocity = 0.0;
  double position = 0.0;
  double constant = 0.0;
  double friction = 0.0;  ///< size of what turns with the sign of v
  std::vector<DrivePart> drives{};

  [[nodiscard]] bool is_one_drive() const {
    return drives.size() == 1 && velocity == 0.0 && position == 0.0 && constant == 0.0 && friction == 0.0;
  }
  [[nodiscard]] bool is_velocity_alone() const {
    return velocity != 0.0 && drives.empty() && position == 0.0 && constant == 0.0 && friction == 0.0;
  }
  [[nodiscard]] Terms times(double factor) const {
    Terms result = *this;
    result.velocity *= factor;
    result.position *= factor;
    result.constant *= factor;
    result.friction *= std::fabs(factor);
    for (DrivePart& drive : result.drives) {
      drive.gain *= factor;
      drive.force = drive.force.times(factor);
    }
    return result;
  }
  void add(const Terms& other) {
    velocity += other.velocity;
    position += other.position;
    constant += other.constant;
    friction += other.friction;
    drives.insert(drives.end(), other.drives.begin(), other.drives.end());
  }
};

}  // namespace hysteron::robots
