// The interpreter: runs a program with any scalar, by the blocks' own functions.
//
// With double or float it predicts the bits of generated code; with a dual scalar it gives exact derivatives of
// every signal with respect to parameters. Instances for double and float are compiled here; another scalar
// includes machine_impl.hpp in one source file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/interpreter/block_code.hpp"
#include "codegen/interpreter/directions.hpp"

namespace hysteron {

/// How a value of any type is given to a machine and read from it: as the scalar itself, but of float as a double, for
/// a float does not hold every DINT.
template <class S>
using NumberOf = std::conditional_t<std::is_same_v<S, float>, double, S>;

template <class S>
class FmuNode;

template <class S>
class Machine {
 public:
  using Number = NumberOf<S>;

  /// Lays out a program and resets it. The sample time is the program's own, or the one given in seconds where the
  /// program has none. Throws InputError (HY404) without either.
  explicit Machine(const Program& program, double sample_time = 0.0);
  ~Machine();
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;
  Machine(Machine&&) noexcept;
  Machine& operator=(Machine&&) noexcept;

  /// Sets an element of a parameter, by its place in the graph. Takes effect at once; reset() starts from it.
  void set_parameter(std::size_t parameter, const Number& value, std::size_t element = 0);
  [[nodiscard]] Number parameter(std::size_t parameter, std::size_t element = 0) const;

  /// Of a scalar with derivatives: how many of them are in use from the next reset on. An FMU runs once more for each.
  void use_directions(std::size_t count) { next_directions_.used = count; }

  /// Every state as its block says, or as the program does; steps counted from 0.
  void reset();

  void set_input(std::size_t input, const Number& value);  ///< of any type: not 0 is TRUE
  /// The same number without derivatives, or in all lanes.
  void set_input(std::size_t input, double value) requires(!std::is_same_v<NumberOf<S>, double>);
  /// One step: allocates nothing, calls nothing of the system, throws nothing. An FMU among the blocks does all of it:
  /// it works in a process of its own, and throws InputError (HY219, HY750 to HY753) where it cannot go on.
  void step();
  [[nodiscard]] Number output(std::size_t output) const;  ///< of any type, as a number

  /// The value that a wire carries after a step, as a number.
  [[nodiscard]] Number value(const Wire& wire) const;
  /// A state of type LREAL, to be read or set between steps; null where there is none of that name.
  [[nodiscard]] S* real_state(std::string_view path);

  /// The whole state as saved_size() bytes: to be kept, and put back into this machine later. Allocates nothing. What
  /// an FMU remembers is not among it.
  [[nodiscard]] std::size_t saved_size() const noexcept { return live_size_ + sizeof(steps_); }
  /// Where in these bytes a state of a block begins, an output of a node, and the count of the steps (64 bits, from 0
  /// to the period after which all rates repeat together).
  [[nodiscard]] std::size_t place_of_state(std::uint32_t node, std::uint32_t state) const;
  [[nodiscard]] std::size_t place_of_output(std::uint32_t node, std::uint16_t port) const;
  [[nodiscard]] std::size_t place_of_steps() const noexcept { return live_size_; }
  void save(std::span<std::byte> bytes) const noexcept;
  void restore(std::span<const std::byte> bytes) noexcept;

  [[nodiscard]] const Program& program() const { return *program_; }
  [[nodiscard]] double sample_time() const { return sample_time_; }

 private:
  struct Placed {
    std::size_t state = 0;
    std::size_t out = 0;
    std::size_t prepared = 0;
    std::size_t first_pin = 0;
  };
  struct Timed {
    Instruction<S> instruction;
    Rate rate;
  };

  void lay_out();
  [[nodiscard]] const BlockCode<S>& code_of(std::uint32_t node) const;
  void place_instructions();
  [[nodiscard]] const void* source_of(const Wire& wire) const;
  [[nodiscard]] std::size_t output_offset(const Wire& wire) const;
  [[nodiscard]] S* real_state(std::uint32_t node, std::uint32_t state);
  [[nodiscard]] const S* ts_of(const Node& node);
  [[nodiscard]] bool parameters_stand_still(const Node& node) const;
  void prepare();
  Instruction<S> instruction_of(std::uint32_t index);

  struct Free {
    void operator()(std::byte* memory) const { ::operator delete[](memory, std::align_val_t{64}); }
  };

  std::shared_ptr<const Program> program_;
  double sample_time_ = 0.0;
  /// States and outputs of all nodes, inputs, literals, parameters, and what is prepared of these.
  std::unique_ptr<std::byte[], Free> memory_;
  std::size_t live_size_ = 0;   ///< the front of memory_: what changes from step to step
  std::vector<Placed> placed_;  ///< by node
  std::vector<std::size_t> inputs_;
  std::vector<std::size_t> literals_;
  std::vector<std::size_t> parameters_;
  std::vector<const void*> outputs_;  ///< where each output of the diagram stands
  std::vector<const void*> pins_;
  std::vector<std::pair<std::uint32_t, std::unique_ptr<S>>> sample_times_;  ///< by `every`
  std::vector<Instruction<S>> resets_;
  std::vector<Instruction<S>> preparations_;
  bool prepared_ = false;  ///< what is prepared is of the parameters as they are now
  std::vector<Instruction<S>> instructions_;
  std::vector<Timed> timed_;                        ///< instead of instructions_, where there are several rates
  std::vector<std::unique_ptr<FmuNode<S>>> fmus_;   ///< by node; null for all others
  std::map<const BlockType*, BlockCode<S>> sized_;  ///< of blocks whose pins are vectors
  std::unique_ptr<Directions> directions_ = std::make_unique<Directions>();  ///< since the last reset
  Directions next_directions_{};
  std::uint64_t longest_period_ = 1;
  std::uint64_t steps_ = 0;  ///< of the longest period
};

extern template class Machine<double>;
extern template class Machine<float>;

}  // namespace hysteron
