// Oscilloscopes that count samples and state where the count begins and how far it steps.
//
//   X,CH1,CH2,Start,Increment,
//   Sequence,Volt,Volt,-3.000000e-02,1.000000e-03
//   0,0.000e+00,0.000e+00,
#pragma once

#include <optional>
#include <string_view>

namespace hysteron::records {

struct CountedTime {
  double start = 0.0;      ///< s
  double increment = 0.0;  ///< s
};

/// What the two lines of names and of units say; nothing where they do not.
[[nodiscard]] std::optional<CountedTime> counted_time(std::string_view names, std::string_view units);

}  // namespace hysteron::records
