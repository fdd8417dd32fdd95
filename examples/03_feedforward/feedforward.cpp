#include "examples/03_feedforward/feedforward.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hysteron::examples {
namespace {

constexpr double amplitude = 1.6e-6;  // m

}  // namespace

records::Record reference(Start start, double sample_time) {
  const double first = start == Start::Rest ? -0.25 : 0.0;
  const auto rows = static_cast<std::size_t>(std::lround((2.0 - first) / sample_time)) + 1;
  std::vector<double> wanted;
  for (std::size_t k = 0; k < rows; ++k) {
    const double angle = 2.0 * std::numbers::pi * sample_time * static_cast<double>(k);
    // (20); a quarter of a period earlier it is a sine, which begins at 0 without rounding
    wanted.push_back(-amplitude * (start == Start::Rest ? std::sin(angle) : std::cos(angle)));
  }
  records::Record record = records::Record::even(first, sample_time, rows);
  record.add({.name = "Y_REF", .unit = "m", .values = std::move(wanted)});
  return record;
}

const std::array<Form, 4>& forms() {
  static const std::array<Form, 4> all{{{"linear spring", "linear_spring", {{"Y0", 0.0}}},
                                        {"ODE form, forward Euler", "ode_form", {{"AT_REST", 1.0}}},
                                        {"ODE form, Heun", "heun_form", {{"AT_REST", 1.0}, {"BEFORE.X0", 0.0}}},
                                        {"closed form", "closed_form", {{"INV.START", 0.0}, {"INV.Y0", 0.0}}}}};
  return all;
}

records::Record feed_forward(const Form& form, Start start, double sample_time) {
  const bool at_rest = start == Start::Rest;
  const std::string file = std::string("03_feedforward/") + form.diagram + ".st";
  Diagram diagram(file, at_rest ? form.at_rest : std::vector<Setting>{}, sample_time);
  records::Record run = diagram.run(reference(start, sample_time));
  const Material material = Material{}.reconciled();
  RambergOsgoodActuator actuator =
      at_rest ? RambergOsgoodActuator(material) : RambergOsgoodActuator::at_branching_point(material, -amplitude);
  std::vector<double> y;
  for (const double u : column(run, "U")) {
    y.push_back(actuator(u));
  }
  run.add({.name = "Y", .unit = "m", .values = std::move(y)});
  return run;
}

records::Record control(double gain) {
  const std::array settings{Setting{"K", gain}};
  Diagram servo("03_feedforward/servo.st", settings);
  RambergOsgoodActuator actuator(Material{}.reconciled());
  records::Record run = reference(Start::Rest, servo.sample_time());
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
