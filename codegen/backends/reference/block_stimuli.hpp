// The standard stimuli of blocks: the settings and input signals with which each is shown in the reference.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "codegen/trace/block_type.hpp"

namespace hysteron {

/// A signal as a function of time.
struct Waveform {
  enum class Shape : std::uint8_t {
    Sine,        ///< offset + amplitude·sin(2πt/period)
    FadingSine,  ///< the same, its amplitude falling to 0 in a straight line over the response
    Triangle,    ///< offset + amplitude·triangle, beginning at the offset, upwards
    Square,      ///< offset + amplitude in the second half of each period, else offset
    Sweep,       ///< from offset to offset + amplitude in a straight line over the response
    Levels       ///< constant from each of `levels` on, which are pairs (time, value)
  };
  Shape shape = Shape::Sine;
  double amplitude = 1.0;
  double period = 1.0;  ///< in seconds
  double offset = 0.0;
  std::vector<std::pair<double, double>> levels{};

  /// The value at step `step` of `steps`.
  [[nodiscard]] double at(int step, int steps, double sample_time) const;
};

struct DrivenPin {
  std::string_view pin{};
  Waveform wave{};
};

struct Stimulus {
  std::string_view settings{};  ///< as written in a declaration: T1 := 0.1
  std::vector<DrivenPin> pins{};
  std::string_view abscissa{};            ///< pin that is the x axis; empty: time
  double sample_time = 0.01;              ///< in seconds
  int steps = 200;                        ///< number of samples
  std::vector<std::string_view> shown{};  ///< outputs; empty: all but ERROR and ERRORID
};

/// The stimulus of a block. Every input that must be connected is driven.
[[nodiscard]] Stimulus stimulus_of(const BlockType& block);

}  // namespace hysteron
