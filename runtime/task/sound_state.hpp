// The numbers of a program's state as they last were finite, for when one is not: an integrator that has once met an
// infinite value would keep it for ever, and its output would stay at its safe value.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

class SoundState {
 public:
  /// As the program is now. It is reset meanwhile, to see which of its numbers are infinite by themselves.
  explicit SoundState(StepProgram& program);

  /// The state is this from now on, as after a reset or where the program takes over. Of the program's size.
  void begin_with(std::span<const std::byte> state) noexcept;
  void begin_with(const StepProgram& program) noexcept { program.save(kept_); }
  /// After a step, once its outputs are written: the larger the state, the more rarely it is looked at. Where an output
  /// is no number, the numbers of the state that are not finite become what they last were, and those alone: other
  /// parts of the diagram go on. Whether that was done.
  bool follow(StepProgram& program, bool outputs_are_numbers) noexcept;

  /// Of a larger state, numbers become what they were at its begin.
  static constexpr std::size_t largest_kept = 65'536;

 private:
  struct Numbers {
    std::size_t offset = 0;  ///< in bytes
    std::size_t length = 0;
    bool is_double = true;
  };
  template <class Real>
  [[nodiscard]] bool mend(const Numbers& row) noexcept;

  std::vector<Numbers> rows_{};
  std::vector<std::byte> after_reset_;
  std::vector<std::byte> kept_;
  std::vector<std::byte> now_;
  std::size_t every_;  ///< steps from one that is looked at to the next
  std::size_t wait_ = 0;
  bool saw_none_ = false;  ///< an output that was no number, at the last look
};

}  // namespace hysteron::runtime
