// The interpreter with dual scalars of 3, 5 and 7 derivatives, each compiled in a source of its own, and the machines
// of a program of which each pass takes the one that is wide enough. With its value a dual is whole pairs of numbers;
// more parameters take several passes. Where a register holds eight numbers, a dual of 7 is one, and takes all passes.
#pragma once

#include <cstddef>
#include <optional>

#include "codegen/interpreter/machine_lanes.hpp"
#include "codegen/interpreter/registers.hpp"
#include "tuning/dual.hpp"

namespace hysteron {

/// The most derivatives that a machine carries at once.
inline constexpr std::size_t most_derivatives = 7;

extern template class Machine<Dual<3>>;
extern template class Machine<Dual<5>>;
extern template class Machine<Dual<static_cast<int>(most_derivatives)>>;
using WideDual = Dual<static_cast<int>(most_derivatives), 8>;  ///< for processors of which has_registers_of_eight()
extern template class Machine<WideDual>;

/// The interpreters of a program, which outlives them: the plain one, and those that carry derivatives, made where
/// these are asked for.
class Machines {
 public:
  Machines(const Program& program, double sample_time)
      : plain(program, sample_time), program_(program), sample_time_(sample_time) {}

  Machine<double> plain;

  /// What a run gives of the machine that carries so many derivatives, most_derivatives at the most.
  template <class Run>
  auto with_derivatives(std::size_t count, Run&& run) {
    const auto with = [&]<class S>(std::optional<Machine<S>>& machine) { return run(made(machine)); };
    return has_registers_of_eight() ? with(wide_) : count <= 3 ? with(three_) : count <= 5 ? with(five_) : with(seven_);
  }

  /// The one that runs eight sets of parameters side by side. Only where has_registers_of_four() says so, and of a
  /// program without an FMU.
  Machine<Lanes>& side_by_side() { return made(lanes_); }

 private:
  template <class S>
  Machine<S>& made(std::optional<Machine<S>>& machine) {
    return machine ? *machine : machine.emplace(program_, sample_time_);
  }

  const Program& program_;
  double sample_time_;
  std::optional<Machine<Dual<3>>> three_{};
  std::optional<Machine<Dual<5>>> five_{};
  std::optional<Machine<Dual<static_cast<int>(most_derivatives)>>> seven_{};
  std::optional<Machine<WideDual>> wide_{};
  std::optional<Machine<Lanes>> lanes_{};
};

/// How many of the columns that are left the next pass takes: passes are of about the same width.
[[nodiscard]] constexpr std::size_t width_of_pass(std::size_t left) {
  const std::size_t passes = (left + most_derivatives - 1) / most_derivatives;
  return passes == 0 ? 0 : (left + passes - 1) / passes;
}

}  // namespace hysteron
