// A run of a program by the interpreter in any of its scalars. Internal to simulation.cpp and float32_run.cpp.
#pragma once

#include <functional>
#include <vector>

#include "codegen/interpreter/machine.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::detail {

template <class S>
std::vector<Signal> interpreted_run(const Program& program, const Drive& drive, const std::vector<Wire>& watched,
                                    const std::function<void(double)>& progress) {
  Machine<S> machine(program, drive.sample_time);
  std::vector<Signal> values(watched.size(), Signal(drive.steps));
  for (std::size_t k = 0; k < drive.steps; ++k) {
    for (std::size_t i = 0; i < drive.inputs.size(); ++i) {
      machine.set_input(i, at_step(drive.inputs[i], k));
    }
    machine.step();
    for (std::size_t i = 0; i < watched.size(); ++i) {
      values[i][k] = machine.value(watched[i]);
    }
    if (progress && k % 64 == 0) {
      progress(static_cast<double>(k) / static_cast<double>(drive.steps));
    }
  }
  return values;
}

}  // namespace hysteron::detail
