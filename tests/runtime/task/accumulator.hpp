// A program for tests: Y sums A · X, TORN is A + B and so 0 while every set of parameters has B = -A.
#pragma once

#include <cstring>
#include <functional>

#include "runtime/task/step_program.hpp"
#include "tests/runtime/namespaces.hpp"

namespace hysteron::runtime::test {

class Accumulator final : public StepProgram {
 public:
  explicit Accumulator(std::int64_t period = 1'000'000) {
    shape_.name = "ACCUMULATOR";
    shape_.period = period;
    shape_.inputs = {{.name = "X", .unit = "V", .preset = 1.0}};
    shape_.outputs = {{.name = "Y", .unit = "um"}, {.name = "TORN"}};
    shape_.parameters = {{.name = "G.A", .low = -1e9, .high = 1e9}, {.name = "G.B", .low = -1e9, .high = 1e9}};
    shape_.layout = "accumulator";
  }
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override { sum_ = 0.0; }
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override {
    sum_ += a_ * inputs[0];
    outputs[0] = sum_;
    outputs[1] = a_ + b_;
    if (during_step) {
      during_step(outputs);
    }
  }
  void set_parameter(std::size_t parameter, double value) noexcept override { (parameter == 0 ? a_ : b_) = value; }
  [[nodiscard]] double parameter(std::size_t parameter) const noexcept override { return parameter == 0 ? a_ : b_; }
  [[nodiscard]] std::size_t state_size() const noexcept override { return sizeof(sum_); }
  void save(std::span<std::byte> bytes) const noexcept override { std::memcpy(bytes.data(), &sum_, sizeof(sum_)); }
  void restore(std::span<const std::byte> bytes) noexcept override { std::memcpy(&sum_, bytes.data(), sizeof(sum_)); }

  ProgramShape& mutable_shape() { return shape_; }
  std::function<void(std::span<double> outputs)> during_step{};

 private:
  ProgramShape shape_;
  double sum_ = 0.0;
  double a_ = 1.0;
  double b_ = -1.0;
};

/// The index of a point by its name.
inline std::size_t point(const PointDoor& door, std::string_view name) {
  const auto points = door.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].name == name) {
      return i;
    }
  }
  return points.size();
}

inline double value(PointDoor& door, std::string_view name) {
  Snapshot snapshot;
  door.read(snapshot);
  return snapshot.values.at(point(door, name));
}

}  // namespace hysteron::runtime::test
