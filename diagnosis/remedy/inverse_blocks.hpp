// The inverse of each block as text: how the signal before it follows from the signal wanted behind it.
//
// Exact in every sample, but for rounding: gains, sums, offsets, what the clock or a known signal adds, backlash, dead
// band, the Ramberg-Osgood loop, static nonlinearities (Newton steps to the last digits). Exact for a smooth reference,
// with an error that falls with the square of the sample time: lags and resonances, by differences of second order;
// relaxation; creep, whose part of the past is extrapolated over one sample; the general hysteresis, by one Newton step
// a sample on a model of it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron::diagnosis {

/// Why a diagram has no feedforward.
struct NoInverse : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The parts of the text that is being written.
class InverseText {
 public:
  /// The names of the diagram's inputs are taken; the reference is REF, or with a number where REF is one of them.
  InverseText(double sample_time, const Graph& graph);

  /// A name that nothing has yet: the wish, or the wish with a number behind it.
  std::string name(std::string_view wish);
  /// An instance of a block with its settings, as `C1 := 1.0, C2 := 0.5`.
  std::string instance(std::string_view wish, std::string_view block, const std::string& settings = {});
  void call(const std::string& instance, const std::string& arguments);
  /// A signal that stands for an expression; a name as it is.
  std::string signal(std::string_view wish, const std::string& expression, std::string_view unit = {});
  /// weight·TS·x'' + x', where x' is the difference over the last sample: ½ gives the rate now, 1 half a sample later.
  std::string rate(std::string_view wish, const std::string& of, double weight);
  /// TRUE from the third sample on, or from the second.
  std::string started(int samples);
  void input(const std::string& declaration);
  void note(std::string text);
  void look_ahead(double seconds) { preview_ += seconds; }

  [[nodiscard]] const std::string& reference() const { return reference_; }
  [[nodiscard]] double sample_time() const { return sample_time_; }
  [[nodiscard]] double preview() const { return preview_; }
  [[nodiscard]] const std::vector<std::string>& inputs() const { return inputs_; }
  [[nodiscard]] const std::vector<std::string>& locals() const { return locals_; }
  [[nodiscard]] const std::vector<std::string>& statements() const { return statements_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  double sample_time_;
  double preview_ = 0.0;
  std::vector<std::string> taken_{};
  std::string reference_{};
  std::vector<std::string> inputs_{};
  std::vector<std::string> locals_{};
  std::vector<std::string> statements_{};
  std::vector<std::string> notes_{};
  std::string second_{};
  std::string third_{};
};

/// A block of the chain, and what is wanted of it.
struct BlockStage {
  const Graph& graph;
  const Node& node;
  std::string name{};                                     ///< to begin the names of its parts with
  std::size_t pin = 0;                                    ///< the input that is to be found
  std::string wanted{};                                   ///< a name
  std::function<std::string(std::size_t pin)> operand{};  ///< the text of another input that is connected

  [[nodiscard]] const std::vector<double>& values(std::string_view parameter) const;
  [[nodiscard]] double value(std::string_view parameter) const { return values(parameter).front(); }
  /// The settings of a block of the same parameters.
  [[nodiscard]] std::string settings() const;
  /// The arguments of a copy with another input.
  [[nodiscard]] std::string arguments(const std::string& input) const;
};

/// Whether XOUT of a library's block is XIN and something that does not depend on XIN.
[[nodiscard]] bool adds_to_input(std::string_view block);

/// The expression of the input. Throws NoInverse.
[[nodiscard]] std::string inverse_of_block(InverseText& text, const BlockStage& stage);

}  // namespace hysteron::diagnosis
