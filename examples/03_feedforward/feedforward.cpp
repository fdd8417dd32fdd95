#include "examples/03_feedforward/feedforward.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hysteron::examples {
namespace {

constexpr double amplitude = 1.6e-6;  // m
constexpr double first_time = -0.25;  // s

}  // namespace

records::Record reference(double sample_time) {
  const auto rows = static_cast<std::size_t>(std::lround(2.25 / sample_time)) + 1;
  std::vector<double> wanted;
  for (std::size_t k = 0; k < rows; ++k) {
    // (20); with s = t + 1/4, -cos(2πt) = -sin(2πs), which begins at 0 without rounding
    wanted.push_back(-amplitude * std::sin(2.0 * std::numbers::pi * sample_time * static_cast<double>(k)));
  }
  records::Record record = records::Record::even(first_time, sample_time, rows);
  record.add({.name = "Y_REF", .unit = "m", .values = std::move(wanted)});
  return record;
}

records::Record feed_forward(std::string_view diagram, double sample_time) {
  records::Record run = Diagram(diagram, {}, sample_time).run(reference(sample_time));
  RambergOsgoodActuator actuator(Material{}.reconciled());
  std::vector<double> y;
  for (const double u : column(run, "U")) {
    y.push_back(actuator(u));
  }
  run.add({.name = "Y", .unit = "m", .values = std::move(y)});
  return run;
}

records::Record control(double K) {
  const std::array settings{Setting{"K", K}};
  Diagram servo("03_feedforward/servo.st", settings);
  RambergOsgoodActuator actuator(Material{}.reconciled());
  records::Record run = reference(servo.sample_time());
  std::vector<double> outputs;
  std::vector<double> inputs;
  std::vector<double> errors;
  double y = 0.0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    servo.set("Y_REF", column(run, "Y_REF")[k]);
    servo.set("Y", y);  // measured now: what the input of the sample before has done
    servo.step();
    const double disturbance = run.time()[k] >= 1.0 ? 0.1e-6 : 0.0;
    y = actuator(servo.get("U")) + disturbance;
    outputs.push_back(y);
    inputs.push_back(servo.get("U"));
    errors.push_back(servo.get("E"));
  }
  run.add({.name = "Y", .unit = "m", .values = std::move(outputs)});
  run.add({.name = "U", .unit = "V", .values = std::move(inputs)});
  run.add({.name = "E", .unit = "m", .values = std::move(errors)});
  return run;
}

FollowingError error_of(const records::Record& run, double from) {
  const auto wanted = column(run, "Y_REF");
  const auto y = column(run, "Y");
  std::vector<double> error;
  for (std::size_t k = run.rows_between(from, run.time().back() + 1.0).first; k < run.size(); ++k) {
    error.push_back((y[k] - wanted[k]) / range(wanted));
  }
  FollowingError result{.rms = rms(error)};
  for (const double share : error) {
    result.worst = std::max(result.worst, std::fabs(share));
  }
  return result;
}

}  // namespace hysteron::examples
