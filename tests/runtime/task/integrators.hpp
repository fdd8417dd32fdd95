// A program for tests whose versions differ: Y is the sum of integrators, each with a gain, by name.
#pragma once

#include <fmt/format.h>

#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/task/step_program.hpp"
#include "tests/runtime/namespaces.hpp"

namespace hysteron::runtime::test {

/// NAME.Y += NAME.K · X, with a name, a gain as given, and a unit of the state.
struct Integrator {
  std::string name{};
  double gain = 1.0;
  std::string unit = "um";
};

class Integrators final : public StepProgram {
 public:
  explicit Integrators(std::vector<Integrator> parts, double low = -1e9, double high = 1e9)
      : gains_(parts.size()), state_(parts.size() + 1, 0.0) {
    shape_.name = "INTEGRATORS";
    shape_.period = 1'000'000;
    shape_.inputs = {{.name = "X", .unit = "V", .preset = 1.0}};
    shape_.outputs = {{.name = "Y", .unit = "um", .low = low, .high = high}};
    shape_.layout = "integrators";
    for (std::size_t i = 0; i < parts.size(); ++i) {
      gains_[i] = parts[i].gain;
      shape_.parameters.push_back({.name = parts[i].name + ".K", .low = -100.0, .high = 100.0});
      shape_.inner.push_back({.name = parts[i].name + ".Y", .unit = parts[i].unit});
      // Not from the first byte on: what lies elsewhere in another version is found by its name.
      shape_.state.push_back({.name = parts[i].name + ".Y",
                              .block = "HY_INTEGRAL",
                              .unit = parts[i].unit,
                              .offset = (i + 1) * sizeof(double)});
      shape_.layout += " " + parts[i].name + "/" + parts[i].unit;
    }
  }
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override { state_.assign(state_.size(), resets_to); }
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override {
    outputs[0] = 0.0;
    for (std::size_t i = 0; i < gains_.size(); ++i) {
      state_[i + 1] += gains_[i] * inputs[0];
      outputs[0] += state_[i + 1];
    }
    if (in_step) {
      in_step();
    }
  }
  void inner_values(std::span<double> into) const noexcept override {
    for (std::size_t i = 0; i < into.size(); ++i) {
      into[i] = state_[i + 1];
    }
  }
  void set_parameter(std::size_t parameter, double value) noexcept override { gains_[parameter] = value; }
  [[nodiscard]] double parameter(std::size_t parameter) const noexcept override { return gains_[parameter]; }
  [[nodiscard]] std::size_t state_size() const noexcept override { return state_.size() * sizeof(double); }
  void save(std::span<std::byte> bytes) const noexcept override {
    std::memcpy(bytes.data(), state_.data(), bytes.size());
  }
  void restore(std::span<const std::byte> bytes) noexcept override {
    std::memcpy(state_.data(), bytes.data(), bytes.size());
  }

  ProgramShape& mutable_shape() { return shape_; }
  std::function<void()> in_step{};
  double resets_to = 0.0;

 private:
  ProgramShape shape_;
  std::vector<double> gains_;
  std::vector<double> state_;
};

inline std::unique_ptr<Integrators> integrators(std::vector<Integrator> parts) {
  return std::make_unique<Integrators>(std::move(parts));
}

}  // namespace hysteron::runtime::test
