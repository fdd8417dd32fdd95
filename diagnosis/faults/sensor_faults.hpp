// What a measured output does that no machine does: a sensor that stands still, readings that drop out, a piece of the
// record that is missing.
//
// A stretch of exactly equal readings is a stuck sensor where the sensor is noisy elsewhere, by three of its steps or
// more, the model moves on meanwhile, and the stretch is no end of its range, which is a clipped sensor. A sensor that
// stands in many places is coarse, or its record was resampled: it stands where the machine rests. A stretch is a
// dropout where the readings leap there and back by far more than anywhere else. A single leap, far beyond all others
// and beyond the model's fastest change, is a gap in the record whose rows were numbered anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "records/record.hpp"

namespace hysteron::diagnosis {

struct SensorFault {
  enum class Kind : std::uint8_t { Stuck, Dropout, Leap };
  Kind kind = Kind::Stuck;
  records::RowRange rows{};  ///< of a leap, the first row behind it
  double value = 0.0;        ///< the reading that stays; of a leap, its size
};

/// Of one output in one record; `left_out`: rows that do not count, as glitches, in ascending order.
[[nodiscard]] std::vector<SensorFault> find_sensor_faults(std::span<const double> measured,
                                                          std::span<const double> model,
                                                          std::span<const std::size_t> left_out);

}  // namespace hysteron::diagnosis
