// The feedforward of a diagram: the input that makes its output follow a reference, as a diagram of its own.
//
// The graph is walked from the output back to the input. Where each node has one input that is not yet known, that
// input is written as an expression of the output that is wanted from it: a series chain, with whatever the chain's
// later signals, other inputs and the clock add to it. How each block is inverted, and how exactly, inverse_blocks.hpp
// says.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/compile.hpp"
#include "records/record.hpp"

namespace hysteron::diagnosis {

struct Feedforward {
  std::string text{};  ///< the diagram FEEDFORWARD, from the reference to the input's name; empty where there is none
  std::string reference{};           ///< REF, or with a number where the diagram has an input of that name
  std::string reason{};              ///< why there is none
  std::vector<std::string> notes{};  ///< what it leaves as it is, and how exact it is
  double preview = 0.0;  ///< seconds by which the reference has to come early, for the dead times of the diagram
};

/// The parameters of the program go into the text. `sample_time` is of use where the program states none.
[[nodiscard]] Feedforward feedforward_of(const Program& program, std::string_view input, std::string_view output,
                                         double sample_time);

/// RMS tracking errors, in the output's unit, through the improved plant.
struct Tracking {
  double nominal = 0.0;   ///< with the feedforward of the nominal diagram
  double improved = 0.0;  ///< with the feedforward of the improved one
};

/// The reference is the measured output of a record, smoothed; each feedforward gets the preview that it asks for. The
/// first tenth does not count: there the plant's start shows. Nothing where either diagram has no feedforward, or one
/// with other inputs than the record's.
[[nodiscard]] std::optional<Tracking> predicted_tracking(const Program& nominal, const Program& improved,
                                                         std::string_view input, std::string_view output,
                                                         const records::Record& record);

}  // namespace hysteron::diagnosis
