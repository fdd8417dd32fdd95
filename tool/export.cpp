#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "robots/joint.hpp"
#include "robots/joint_law.hpp"
#include "robots/robot_file.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/root_mean_square.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/option_values.hpp"
#include "tool/record_options.hpp"
#include "tool/writable.hpp"
#include "tuning/recorded_run.hpp"
#include "tuning/signal_names.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view export_examples = R"(Examples:
  hysteron export axis.st --params tuned.toml --out bench.xml
  hysteron export axis.st --params tuned.toml --into robot.xml --joint shoulder --out fitted.xml
  hysteron export axis.st --params tuned.toml --into arm.urdf --format urdf --joint shoulder --out fitted.urdf
  hysteron export axis.st --gear 50 --link-inertia 0.02 --into robot.xml --joint elbow --out fitted.xml
  hysteron export axis.st --params tuned.toml --in log.csv --out bench.xml

The diagram is an axis: an integral whose unit is a velocity (rad/s, m/s), and what acts on it: gains, friction, springs,
limits and a lag of the drive. A signal with the unit N*m (N of what slides) says how much is moved; else --inertia does.
MuJoCo gets armature, damping, frictionloss, stiffness, springref and range of the joint, and an actuator with gain, bias,
lag and ranges; URDF gets damping, friction and limits. Numbers are in rad, m, N*m and N, and angles of a robot as its
compiler states. What has no place is listed with its size. Of a robot (--into) every other byte stays.
--in runs the diagram and the joint, by the law that MuJoCo documents, over a record, and says how far they differ.
Exit codes: 0 done; 2 the diagram is no axis, something has to be stated, or bad usage; nothing is written.
)";

struct ExportOptions {
  DiagramOptions diagram;
  RecordOptions record;
  robots::JointOptions joint;
  std::string format = "mujoco";
  std::string name = "axis";
  std::string into;
  std::string output;
  std::string input_record;
  double link_inertia = 0.0;
  double gear = 1.0;
};

/// Of q', SI.
struct Difference {
  double error = 0.0;  ///< RMS of joint less diagram
  double percent = 0.0;
};

Difference difference(const robots::Joint& joint, const Program& program, const Drive& drive) {
  const std::vector<Signal> run = interpret(program, drive, {find_signal(program.graph, joint.velocity, {})});
  std::vector<double> control(drive.steps, 0.0);
  if (joint.actuator) {
    const Port* const input = find_port(program.graph.inputs, joint.actuator->input);
    const Signal& values = drive.inputs[static_cast<std::size_t>(input - program.graph.inputs.data())];
    for (std::size_t k = 0; k < drive.steps; ++k) {
      control[k] = at_step(values, k);
    }
  }
  const std::vector<double> of_joint = robots::velocities(joint, control, drive.sample_time);
  RootMeanSquare error;
  RootMeanSquare size;
  for (std::size_t k = 0; k < drive.steps; ++k) {
    const double wanted = joint.velocity_to_si * at_step(run.front(), k);
    error.add(of_joint[k] - wanted);
    size.add(wanted);
  }
  return {.error = error.value(), .percent = size.value() > 0.0 ? 100.0 * error.value() / size.value() : 0.0};
}

/// The same inputs, each held over `parts` shorter steps.
Difference difference_of_finer_steps(const robots::Joint& joint, Program program, Drive drive, std::size_t parts) {
  for (Signal& input : drive.inputs) {
    if (input.size() > 1) {
      Signal held;
      held.reserve(parts * input.size());
      for (const double value : input) {
        held.insert(held.end(), parts, value);
      }
      input = std::move(held);
    }
  }
  drive.steps *= parts;
  drive.sample_time /= static_cast<double>(parts);
  program.graph.sample_time_ns = 0;  // that of the drive counts
  return difference(joint, program, drive);
}

/// The joint and the diagram over a record, side by side, and whether the step makes what they differ by.
std::string comparison(const ExportOptions& options, const robots::Joint& joint, const Program& program,
                       Diagnostics& warnings) {
  Program timed = program;
  const RecordOptions reading = with_settings_of(options.diagram.parameters, options.record);
  const auto records = read_and_told({options.input_record}, reading, program, false, warnings);
  settle_sample_time(records.front(), timed, warnings);
  const Drive drive = drive_from(records.front(), timed, {}, warnings);
  if (warnings.has_errors()) {
    throw InputError(warnings);
  }
  const Difference found = difference(joint, timed, drive);
  std::string text =
      fmt::format("over {}: the joint differs from the diagram by {:.3g} {}/s RMS, {:.2g} % of its velocity\n",
                  options.input_record, found.error, joint.position_unit(), found.percent);
  constexpr double notable_percent = 2.0;
  if (found.percent > notable_percent) {
    const double finer = difference_of_finer_steps(joint, timed, drive, 10).percent;
    const std::string step = fmt::format("{:.4g} ms", 1e3 * drive.sample_time);
    text += finer < 0.5 * found.percent
                ? fmt::format(
                      "  the step of {} makes most of it, since the two integrate in ways of their own: with a "
                      "tenth of it, {:.2g} %\n",
                      step, finer)
                : fmt::format("  the step of {} is not the cause: with a tenth of it, {:.2g} %\n", step, finer);
  }
  return text;
}

std::string listed(const std::vector<robots::Neglected>& list) {
  std::string text;
  for (const robots::Neglected& one : list) {
    text += fmt::format("  {}: {}; {}\n", one.what, one.size, one.why);
  }
  return text;
}

int export_joint(const ExportOptions& options, Console& console) {
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  inputs.push_back({.file = options.into, .named_by = "--into"});
  inputs.push_back({.file = options.input_record, .named_by = "--in"});
  refuse_to_overwrite({.file = options.output}, inputs);
  refuse_unwritable(options.output);
  Diagnostics warnings;
  DiagramOptions diagram = options.diagram;
  diagram.keep_names = true;
  const Program program = load_diagram(diagram, warnings);
  const robots::Joint motor = robots::joint_of(program, options.joint);
  const robots::Joint joint = robots::behind_gear(motor, options.gear);
  const robots::FileOptions file{.format = options.format == "urdf" ? robots::Format::Urdf : robots::Format::Mujoco,
                                 .joint = options.name,
                                 .model = program.graph.name,
                                 .link_inertia = options.link_inertia,
                                 .sample_time = program.graph.sample_time()};
  const robots::RobotFile robot = options.into.empty()
                                      ? robots::bench_of(joint, file)
                                      : robots::merged(joint, file, options.into, read_text_file(options.into));
  const std::string compared =
      options.input_record.empty() ? std::string() : comparison(options, motor, program, warnings);
  write_file_atomically(options.output, robot.text);
  std::string text =
      fmt::format("{}: joint {}, from {} of {}\n", options.output, options.name, joint.velocity, program.graph.name);
  for (const std::string& change : robot.changes) {
    text += "  " + change + "\n";
  }
  std::vector<robots::Neglected> left = joint.neglected;
  left.insert(left.end(), robot.unmapped.begin(), robot.unmapped.end());
  text += left.empty() ? "nothing is left out\n" : "left out:\n" + listed(left);
  if (!options.into.empty() && file.format == robots::Format::Mujoco && options.link_inertia == 0.0) {
    text += "armature is all that the diagram moves: where bodies of the robot were part of it, state --link-inertia\n";
  }
  console.print(text + compared);
  console.report(warnings);
  return exit_ok;
}

}  // namespace

Action add_export(CLI::App& app) {
  const auto options = std::make_shared<ExportOptions>();
  app.add_option("FILE", options->diagram.file, "The diagram of the axis.")->required()->option_text("AXIS.st");
  app.add_option("--params", options->diagram.parameters, "Parameters, such as `tune` has fitted.")
      ->option_text("TUNED.toml");
  app.add_option("--top", options->diagram.top, "The block to take, where the file has several that no other contains.")
      ->option_text("NAME");
  app.add_flag("--any-order", options->diagram.any_order, "The order of the statements means nothing.");
  app.add_option("--out", options->output, "The file that is written.")->required()->option_text("ROBOT.xml");
  app.add_option("--format", options->format, "mujoco (the default) or urdf.")
      ->check(CLI::IsMember({"mujoco", "urdf"}))
      ->option_text("FORMAT");
  app.add_option("--into", options->into, "A robot that the joint is merged into; without it, a bench of one joint.")
      ->option_text("ROBOT.xml");
  app.add_option("--joint", options->name, "The joint's name in the robot; axis by default.")->option_text("NAME");
  app.add_option("--velocity", options->joint.velocity, "The signal that is the joint's velocity, where several are.")
      ->option_text("SPEED.XOUT");
  app.add_option("--input", options->joint.input, "The input that is the actuator, where several drive.")
      ->option_text("U");
  app.add_option("--inertia", options->joint.inertia,
                 "What the diagram moves, kg*m^2 or kg, where its units do not tell it.")
      ->check(number_above_zero())
      ->option_text("J");
  app.add_option("--link-inertia", options->link_inertia, "What of it the bodies of the robot have already.")
      ->check(number_from_zero())
      ->option_text("J");
  app.add_option("--gear", options->gear, "Turns of the diagram's motor for one of the joint; 1 by default.")
      ->check(number_above_zero())
      ->option_text("N");
  app.add_option("--in", options->input_record, "A record to compare diagram and joint over.")->option_text("LOG.csv");
  add_record_options(app, options->record);
  app.footer(std::string(export_examples));
  return [options](Console& console) { return export_joint(*options, console); };
}

}  // namespace hysteron::tool
