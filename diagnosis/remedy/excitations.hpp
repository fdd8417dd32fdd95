// Excitations: what one plays into a machine to find out more about it.
//
// Each separates effects that other records confuse: a staircase shows creep and drift, nested loops show memory,
// triangles of several rates show what depends on the rate.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace hysteron::diagnosis {

/// What an input may be asked to do.
struct InputLimits {
  std::string name{};
  std::string unit{};
  double low = 0.0;
  double high = 0.0;   ///< above low
  double rate = 0.0;   ///< largest |rate| a second, above 0
  double start = 0.0;  ///< the value at which the machine stands beforehand
  double sample_time = 0.0;
  double duration = 0.0;  ///< the longest experiment, s
};

/// A command, sample by sample, and the same in words.
struct Excitation {
  std::string title{};
  std::string shows{};  ///< what it tells apart
  std::vector<double> values{};
  std::vector<std::pair<std::string, std::string>> steps{};  ///< what, how long
};

/// The longest command, in samples.
inline constexpr std::size_t longest_command = 20000;

/// Every excitation that the limits leave room for, always in the same order. None leaves the range of the input or
/// moves faster than its rate.
[[nodiscard]] std::vector<Excitation> excitations(const InputLimits& limits);

}  // namespace hysteron::diagnosis
