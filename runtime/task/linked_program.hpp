// A generated step behind plain functions, linked into the host or opened as a library, as a program of a task.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

/// As NAME_step.cpp has them. A step gives the inner signals of the shape behind its outputs.
struct StepFunctions {
  void (*reset)() = nullptr;
  void (*step)(const double* inputs, double* outputs) = nullptr;
  void (*set_parameter)(std::size_t index, double value) = nullptr;
  double (*parameter)(std::size_t index) = nullptr;
  void* (*state)() = nullptr;
  std::size_t (*state_size)() = nullptr;
  std::size_t (*state_offset)(std::size_t index) = nullptr;
};

/// There is one state behind the functions, and so only one such program of a kind in a process, or in a library that
/// was opened.
class LinkedProgram final : public StepProgram {
 public:
  /// `library`: what the functions lie in, where it is to be closed with the program.
  LinkedProgram(ProgramShape shape, const StepFunctions& functions, std::shared_ptr<void> library = {})
      : library_(std::move(library)),
        shape_(std::move(shape)),
        functions_(functions),
        results_(shape_.outputs.size() + shape_.inner.size()) {
    functions_.reset();
    for (std::size_t i = 0; i < shape_.state.size(); ++i) {
      shape_.state[i].offset = functions_.state_offset(i);
    }
  }
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override { functions_.reset(); }
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override {
    functions_.step(inputs.data(), results_.data());
    std::ranges::copy_n(results_.begin(), static_cast<std::ptrdiff_t>(outputs.size()), outputs.begin());
  }
  void inner_values(std::span<double> into) const noexcept override {
    std::ranges::copy_n(results_.end() - static_cast<std::ptrdiff_t>(into.size()),
                        static_cast<std::ptrdiff_t>(into.size()), into.begin());
  }
  void set_parameter(std::size_t parameter, double value) noexcept override {
    functions_.set_parameter(parameter, value);
  }
  [[nodiscard]] double parameter(std::size_t parameter) const noexcept override {
    return functions_.parameter(parameter);
  }
  [[nodiscard]] std::size_t state_size() const noexcept override { return functions_.state_size(); }
  void save(std::span<std::byte> bytes) const noexcept override {
    std::memcpy(bytes.data(), functions_.state(), bytes.size());
  }
  void restore(std::span<const std::byte> bytes) noexcept override {
    std::memcpy(functions_.state(), bytes.data(), bytes.size());
  }

 private:
  std::shared_ptr<void> library_;
  ProgramShape shape_;
  StepFunctions functions_;
  std::vector<double> results_;
};

}  // namespace hysteron::runtime
