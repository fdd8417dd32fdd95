// The program that a task runs: a diagram, interpreted, compiled on the fly, or generated into the host. All three give
// the same bits.
//
// Values are doubles by index, whatever their type; TRUE is any number but 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/point.hpp"

namespace hysteron::runtime {

struct ProgramSignal {
  std::string name{};  ///< Y_REF; a parameter: HYST.C1, or TABLE.X[2] for an element of an array
  std::string unit{};  ///< empty where none is stated
  std::string meaning{};
  PointType type = PointType::real64;
  double preset = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;  ///< must be above low, not at it
};

/// A parameter, or a number of the diagram that does not change.
struct RelatedNumber {
  std::optional<std::size_t> parameter{};
  double constant = 0.0;
};

/// Numbers that must rise from one to the next: a lower and an upper bound, the points of a table. What no range of a
/// single parameter can say.
struct ProgramRelation {
  std::vector<RelatedNumber> numbers{};
  bool strictly = false;                 ///< each above the one before; else at least at it
  std::optional<RelatedNumber> count{};  ///< so many of them count; else all
};

/// A number of a program's state as it lies in the bytes that it saves; several where `length` is above 1.
struct StateField {
  std::string name{};   ///< HYST.P; the last output of a slower part: SLOW.XOUT
  std::string block{};  ///< HY_LAG; empty: of an operation, or the task's own count of steps
  std::string unit{};
  PointType type = PointType::real64;
  std::size_t length = 1;
  std::size_t offset = 0;  ///< in bytes
};

struct ProgramShape {
  std::string name{};
  std::int64_t period = 0;  ///< of the steps, in nanoseconds
  std::vector<ProgramSignal> inputs{};
  std::vector<ProgramSignal> outputs{};
  std::vector<ProgramSignal> parameters{};
  std::vector<ProgramRelation> relations{};  ///< among the parameters
  std::vector<ProgramSignal> inner{};        ///< signals within the diagram that can be looked at; often none
  std::vector<StateField> state{};           ///< all that lives from step to step
  std::string picture{};                     ///< SVG of the diagram for the live page; empty where there is none
  /// Two programs whose layouts are the same text understand each other's state: same diagram, whatever its parameters.
  std::string layout{};
};

class StepProgram {
 public:
  StepProgram() = default;
  StepProgram(const StepProgram&) = delete;
  StepProgram& operator=(const StepProgram&) = delete;
  virtual ~StepProgram() = default;

  [[nodiscard]] virtual const ProgramShape& shape() const noexcept = 0;
  /// Every state as after a start; parameters are kept.
  virtual void reset() noexcept = 0;
  /// Allocates nothing, calls nothing of the system.
  virtual void step(std::span<const double> inputs, std::span<double> outputs) noexcept = 0;
  /// The inner signals of the newest step, as shape().inner. Allocates nothing, calls nothing of the system.
  virtual void inner_values(std::span<double> /*into*/) const noexcept {}
  /// Between two steps; the state is kept.
  virtual void set_parameter(std::size_t parameter, double value) noexcept = 0;
  [[nodiscard]] virtual double parameter(std::size_t parameter) const noexcept = 0;
  [[nodiscard]] virtual std::size_t state_size() const noexcept = 0;
  /// `bytes` are of state_size.
  virtual void save(std::span<std::byte> bytes) const noexcept = 0;
  virtual void restore(std::span<const std::byte> bytes) noexcept = 0;
};

/// The values of the first parameters, as many as there is room for. Allocates nothing.
inline void copy_parameters(const StepProgram& program, std::span<double> into) noexcept {
  for (std::size_t i = 0; i < into.size(); ++i) {
    into[i] = program.parameter(i);
  }
}

/// The values of all parameters.
[[nodiscard]] inline std::vector<double> parameters_of(const StepProgram& program) {
  std::vector<double> values(program.shape().parameters.size());
  copy_parameters(program, values);
  return values;
}

/// Sets the first parameters, as many as are given. Allocates nothing.
inline void set_parameters(StepProgram& program, std::span<const double> values) noexcept {
  for (std::size_t i = 0; i < values.size(); ++i) {
    program.set_parameter(i, values[i]);
  }
}

/// The state as the program saves it.
[[nodiscard]] inline std::vector<std::byte> state_of(const StepProgram& program) {
  std::vector<std::byte> state(program.state_size());
  program.save(state);
  return state;
}

}  // namespace hysteron::runtime
