// The signals of which a missing signal may be a function: as they were measured, wherever they were.
//
// A friction depends on the speed at which the machine really moved, not on the one at which a model without friction
// moves: where an output was measured, its column stands for it; a speed is the slope of a measured position. Only what
// no column tells is taken from the run of the diagram.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/effects/signals.hpp"

namespace hysteron::diagnosis {

struct DriverSignal {
  enum class Source : std::uint8_t {
    Input,   ///< a column that drives the diagram
    Output,  ///< a measured output
    Column,  ///< a column that the diagram does not use
    Wire     ///< the output of a dynamic block, as the diagram runs
  };
  std::string name{};  ///< POS; POS' for its rate
  Source source = Source::Input;
  bool is_rate = false;      ///< of what the name says
  bool is_follower = false;  ///< it moves with the signals of the diagram: nothing of its own shows in it
  std::string unit{};        ///< empty where it is not known
  std::string of_unit{};     ///< of a rate: of what it is the rate
  RecordSignals values{};
  RecordSignals deviations{};  ///< standard ones, of what was found from measured values, as a slope; else empty
  Extent extent{};
  /// What moves without regard to the diagram: an input, or the rate of one.
  [[nodiscard]] bool is_imposed() const { return source == Source::Input || source == Source::Column; }
};

/// The RMS of white noise in a signal, by third differences, which leave nothing of a smooth motion.
[[nodiscard]] double noise_of(const RecordSignals& values);

/// The slope of a signal in each sample: of a straight line through the samples to either side, as few as bring the
/// noise of the slope below a tenth of the slope itself. In the signal's unit a second.
struct Rates {
  RecordSignals values{};
  double deviation = 0.0;  ///< that the noise gives a slope
};
[[nodiscard]] Rates rates_of(const RecordSignals& values, double sample_time);

/// Inputs, measured outputs and unused columns, each with its rate.
[[nodiscard]] std::vector<DriverSignal> measured_signals(const Task& task, const Program& program,
                                                         const std::vector<std::string>& unused);

/// Outputs of dynamic blocks that no column tells.
struct InnerSignals {
  std::vector<Wire> wires{};
  std::vector<std::string> names{};
  std::vector<std::string> units{};
};
[[nodiscard]] InnerSignals inner_signals(const Task& task, const Program& program);

/// Appends them, with their values and, where these are known, the standard deviations.
void add_inner(std::vector<DriverSignal>& drivers, const InnerSignals& inner, std::vector<RecordSignals> values,
               double sample_time, std::vector<RecordSignals> deviations = {});

}  // namespace hysteron::diagnosis
