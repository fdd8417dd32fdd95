#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robots/joint.hpp"
#include "robots/joint_json.hpp"
#include "robots/joint_law.hpp"
#include "robots/robot_file.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/root_mean_square.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/exported_axes.hpp"
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
  hysteron export axis.st --joint shoulder=shoulder.toml --joint elbow=elbow.toml --gear elbow=50 --into robot.xml \
                  --out fitted.xml
  hysteron export axis.st --params tuned.toml --in log.csv --out bench.xml

The diagram is an axis: an integral whose unit is a velocity (rad/s, m/s), and what acts on it: gains, friction, springs,
limits and a lag of the drive. A signal with the unit N*m (N of what slides) says how much is moved; else --inertia does.
MuJoCo gets armature, damping, frictionloss, stiffness, springref and range of the joint, and an actuator with gain, bias,
lag and ranges; URDF gets damping, friction and limits. Numbers are in rad, m, N*m and N, and angles of a robot as its
compiler states. What has no place is listed with its size. Of a robot (--into) every other byte stays.
Several --joint put one diagram into a robot several times, each with the parameters that were fitted to its axis; --gear,
--link-inertia and --in then take JOINT=VALUE, or a value for all.
--in runs the diagram and the joint, by the law that MuJoCo documents, over a record, and says how far they differ.
Exit codes: 0 done; 2 the diagram is no axis, something has to be stated, or bad usage; nothing is written.
)";

struct ExportOptions {
  DiagramOptions diagram;
  RecordOptions record;
  robots::JointOptions joint;
  AxisTexts axes;
  std::string format = "mujoco";
  std::string into;
  std::string output;
  bool json = false;
};

/// The joint and the diagram over a record.
struct Comparison {
  double error = 0.0;             ///< of q', SI, RMS
  double percent = 0.0;           ///< of the velocity
  double sample_time = 0.0;       ///< s
  std::optional<double> finer{};  ///< percent with a tenth of the step, where they differ by much
};

/// A joint of the robot, as it was written.
struct ExportedJoint {
  ExportedAxis axis{};
  robots::Joint joint{};
  std::vector<std::string> changes{};
  std::vector<robots::Neglected> left_out{};
  std::optional<Comparison> compared{};
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
Comparison comparison(const ExportOptions& options, const ExportedAxis& axis, const robots::Joint& joint,
                      const Program& program, Diagnostics& warnings) {
  constexpr double notable_percent = 2.0;
  Program timed = program;
  const RecordOptions reading = with_settings_of(axis.parameters, options.record);
  const auto records = read_and_told({axis.record}, reading, program, false, warnings);
  settle_sample_time(records.front(), timed, warnings);
  const Drive drive = drive_from(records.front(), timed, {}, warnings);
  if (warnings.has_errors()) {
    throw InputError(warnings);
  }
  const Difference found = difference(joint, timed, drive);
  Comparison result{.error = found.error, .percent = found.percent, .sample_time = drive.sample_time};
  if (found.percent > notable_percent) {
    result.finer = difference_of_finer_steps(joint, timed, drive, 10).percent;
  }
  return result;
}

std::string comparison_text(const ExportedJoint& one) {
  const Comparison& found = *one.compared;
  std::string text =
      fmt::format("over {}: the joint differs from the diagram by {:.3g} {}/s RMS, {:.2g} % of its velocity\n",
                  one.axis.record, found.error, one.joint.position_unit(), found.percent);
  if (found.finer) {
    const std::string step = fmt::format("{:.4g} ms", 1e3 * found.sample_time);
    text += *found.finer < 0.5 * found.percent
                ? fmt::format(
                      "  the step of {} makes most of it, since the two integrate in ways of their own: with a "
                      "tenth of it, {:.2g} %\n",
                      step, *found.finer)
                : fmt::format("  the step of {} is not the cause: with a tenth of it, {:.2g} %\n", step, *found.finer);
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

std::string text_of(const ExportOptions& options, const ExportedJoint& one, const std::string& diagram) {
  std::string text =
      fmt::format("{}: joint {}, from {} of {}{}\n", options.output, one.axis.joint, one.joint.velocity, diagram,
                  options.axes.joints.size() > 1 && !one.axis.parameters.empty() ? " with " + one.axis.parameters : "");
  for (const std::string& change : one.changes) {
    text += "  " + change + "\n";
  }
  text += one.left_out.empty() ? "nothing is left out\n" : "left out:\n" + listed(one.left_out);
  if (!options.into.empty() && options.format == "mujoco" && one.axis.link_inertia == 0.0) {
    text += "armature is all that the diagram moves: where bodies of the robot were part of it, state --link-inertia\n";
  }
  return text + (one.compared ? comparison_text(one) : "");
}

nlohmann::ordered_json as_json(const ExportOptions& options, const std::vector<ExportedJoint>& joints,
                               const std::string& diagram) {
  using Json = nlohmann::ordered_json;
  const auto name_or_null = [](const std::string& name) { return name.empty() ? Json(nullptr) : Json(name); };
  Json list = Json::array();
  for (const ExportedJoint& one : joints) {
    Json json{{"name", one.axis.joint},
              {"parameters", name_or_null(one.axis.parameters)},
              {"gear", one.axis.gear},
              {"link_inertia", one.axis.link_inertia}};
    json.update(robots::joint_json(one.joint));
    json["changes"] = one.changes;
    json["left_out"] = robots::left_out_json(one.left_out);
    json["compared"] = nullptr;
    if (one.compared) {
      json["compared"] = {{"record", one.axis.record},
                          {"rms", one.compared->error},
                          {"percent", one.compared->percent},
                          {"step", one.compared->sample_time},
                          {"percent_of_finer_step", one.compared->finer ? Json(*one.compared->finer) : Json(nullptr)}};
    }
    list.push_back(std::move(json));
  }
  return {{"robot", options.output},
          {"into", name_or_null(options.into)},
          {"format", options.format},
          {"diagram", diagram},
          {"joints", list}};
}

void refuse_overwriting(const ExportOptions& options, const std::vector<ExportedAxis>& axes) {
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  inputs.push_back({.file = options.into, .named_by = "--into"});
  for (const ExportedAxis& axis : axes) {
    inputs.push_back({.file = axis.parameters, .named_by = "the parameters of " + axis.joint});
    inputs.push_back({.file = axis.record, .named_by = "--in"});
  }
  refuse_to_overwrite({.file = options.output}, inputs);
  refuse_unwritable(options.output);
}

int export_joints(const ExportOptions& options, Console& console) {
  const std::vector<ExportedAxis> axes = exported_axes(options.axes);
  if (axes.size() > 1 && options.into.empty()) {
    throw InputError(
        error::bad_usage, {}, fmt::format("{} joints, and no robot that they belong to.", axes.size()),
        "name the robot by --into: how its joints hang together stands there. Without it a bench has one joint.");
  }
  refuse_overwriting(options, axes);
  Diagnostics warnings;
  std::string robot = options.into.empty() ? std::string() : read_text_file(options.into);
  std::vector<ExportedJoint> joints;
  const Program diagram = load_diagram(options.diagram, warnings);
  for (const ExportedAxis& axis : axes) {
    Program program = diagram;
    set_parameters_of(axis.parameters, program);
    const robots::Joint motor = robots::joint_of(program, options.joint);
    ExportedJoint made{.axis = axis, .joint = robots::behind_gear(motor, axis.gear)};
    const robots::FileOptions file{.format = options.format == "urdf" ? robots::Format::Urdf : robots::Format::Mujoco,
                                   .joint = axis.joint,
                                   .model = program.graph.name,
                                   .link_inertia = axis.link_inertia,
                                   .sample_time = program.graph.sample_time()};
    robots::RobotFile written = options.into.empty() ? robots::bench_of(made.joint, file)
                                                     : robots::merged(made.joint, file, options.into, robot);
    robot = std::move(written.text);
    made.changes = std::move(written.changes);
    made.left_out = made.joint.neglected;
    made.left_out.insert(made.left_out.end(), written.unmapped.begin(), written.unmapped.end());
    if (!axis.record.empty()) {
      made.compared = comparison(options, axis, motor, program, warnings);
    }
    joints.push_back(std::move(made));
  }
  write_file_atomically(options.output, robot);
  if (options.json) {
    console.print(as_json(options, joints, diagram.graph.name).dump(2) + "\n");
  } else {
    for (const ExportedJoint& one : joints) {
      console.print(text_of(options, one, diagram.graph.name));
    }
  }
  console.report(warnings);
  return exit_ok;
}

}  // namespace

Action add_export(CLI::App& app) {
  const auto options = std::make_shared<ExportOptions>();
  options->diagram.keep_names = true;
  app.add_option("FILE", options->diagram.file, "The diagram of the axis.")->required()->option_text("AXIS.st");
  app.add_option("--params", options->axes.parameters, "Parameters, such as `tune` has fitted.")
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
  app.add_option("--joint", options->axes.joints,
                 "The joint's name in the robot, axis by default; of several, each with its own parameters.")
      ->option_text("NAME[=TUNED.toml]")
      ->allow_extra_args(false);
  app.add_option("--velocity", options->joint.velocity, "The signal that is the joint's velocity, where several are.")
      ->option_text("SPEED.XOUT");
  app.add_option("--input", options->joint.input, "The input that is the actuator, where several drive.")
      ->option_text("U");
  app.add_option("--inertia", options->joint.inertia,
                 "What the diagram moves, kg*m^2 or kg, where its units do not tell it.")
      ->check(number_above_zero())
      ->option_text("J");
  app.add_option("--link-inertia", options->axes.link_inertias, "What of it the bodies of the robot have already.")
      ->option_text("[JOINT=]J")
      ->allow_extra_args(false);
  app.add_option("--gear", options->axes.gears, "Turns of the diagram's motor for one of the joint; 1 by default.")
      ->option_text("[JOINT=]N")
      ->allow_extra_args(false);
  app.add_option("--in", options->axes.records, "A record to compare diagram and joint over.")
      ->option_text("[JOINT=]LOG.csv")
      ->allow_extra_args(false);
  add_record_options(app, options->record);
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(export_examples));
  return [options](Console& console) { return export_joints(*options, console); };
}

}  // namespace hysteron::tool
