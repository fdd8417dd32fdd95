#include "robots/joint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "robots/axis_graph.hpp"
#include "robots/terms.hpp"
#include "support/numbers.hpp"
#include "tuning/signal_names.hpp"

namespace hysteron::robots {

bool Range::is_bounded() const {
  return std::isfinite(low) || std::isfinite(high);
}
Range Range::both(const Range& other) const {
  return {.low = std::max(low, other.low), .high = std::min(high, other.high)};
}
Range Range::times(double factor) const {
  return factor < 0.0 ? Range{.low = factor * high, .high = factor * low}
                      : Range{.low = factor * low, .high = factor * high};
}

namespace {

/// Of what is left out, before J is known.
struct Left {
  const Node* node = nullptr;
  std::string why{};
  double acceleration = not_a_number;  ///< its size as an acceleration, SI; a force once it is times J
  std::string size{};                  ///< where it is no force, or what stands behind the force
};

class JointReader : private AxisGraph {
 public:
  JointReader(const Program& program, const JointOptions& options) : AxisGraph(program), options_(options) {}

  Joint read() {
    find_velocity();
    const Node& integral = graph_.nodes[velocity_];
    const bool is_lag = name_of(integral) == "HY_LAG";
    const double time = is_lag ? parameter(integral, "T1") : 1.0;
    if (!(time > 0.0)) {
      refuse(fmt::format("{} is a lag without a time constant: nothing in it has inertia.", integral.path),
             "give it a T1 above 0.", graph_.place(integral.span));
    }
    visited_.insert(velocity_);
    Terms terms = terms_of(input_wire(integral, "XIN"), 1.0 / time, false).times(1.0 / time);
    terms.velocity -= is_lag ? 1.0 / time : 0.0;
    return joint_of_terms(terms);
  }

 private:
  // ---- the velocity -----------------------------------------------------------------------------------------------

  bool take_velocity(std::uint32_t node) {
    const std::string unit = unit_of({.from = Wire::From::Node, .port = 0, .index = node});
    const auto turning = factor(unit, "rad/s");
    const auto sliding = factor(unit, "m/s");
    if (!turning && !sliding) {
      return false;
    }
    turns_ = turning.has_value();
    velocity_ = node;
    to_si_ = turning ? *turning : *sliding;
    return true;
  }

  [[nodiscard]] static bool is_integral(const Node& node) { return name_of(node).starts_with("HY_INTEGRAL"); }

  void find_velocity() {
    if (!options_.velocity.empty()) {
      const Wire wire = find_signal(graph_, options_.velocity, {});
      const bool is_state = wire.from == Wire::From::Node &&
                            (is_integral(graph_.nodes[wire.index]) || name_of(graph_.nodes[wire.index]) == "HY_LAG");
      if (!is_state) {
        refuse(fmt::format("{} is no output of an integral or a lag, so that no acceleration belongs to it.",
                           options_.velocity),
               "name the block that holds the velocity, as --velocity SPEED.XOUT.");
      }
      if (!take_velocity(wire.index)) {
        refuse(fmt::format("The unit of {} is no velocity: {}.", options_.velocity,
                           unit_of(wire).empty() ? "none is known" : unit_of(wire)),
               "state it where the diagram shows the signal, as OMEGA : LREAL; (* @unit rad/s *).");
      }
      return;
    }
    for (const bool lags : {false, true}) {
      std::vector<std::string> found;
      for (std::uint32_t i = 0; i < graph_.nodes.size(); ++i) {
        const Node& node = graph_.nodes[i];
        if ((lags ? name_of(node) == "HY_LAG" : is_integral(node)) && take_velocity(i)) {
          found.push_back(node.path + ".XOUT");
        }
      }
      if (found.size() == 1) {
        return;
      }
      if (found.size() > 1) {
        refuse(fmt::format("Several signals could be the velocity of the joint: {}.", fmt::join(found, ", ")),
               fmt::format("say which, as --velocity {}.", found.front()));
      }
    }
    refuse(fmt::format("{} has no integral or lag whose unit is a velocity.", graph_.name),
           "state the unit where the diagram shows the velocity, as OMEGA : LREAL; (* @unit rad/s *), or m/s.");
  }

  // ---- terms ------------------------------------------------------------------------------------------------------

  /// Takes a signal apart. `to_acceleration` is what one of it makes of the acceleration, in the velocity's unit over
  /// s.
  Terms terms_of(const Wire& wire, double to_acceleration, bool force_seen) {
    if (const auto constant = constant_of(wire)) {
      return {.constant = *constant};
    }
    if (const auto force = factor(unit_of(wire), units_of_joint(turns_).force);
        force && !force_seen && to_acceleration != 0.0) {
      take_inertia(*force / std::fabs(to_si_ * to_acceleration), wire);
      force_seen = true;
    }
    if (wire.from == Wire::From::Input) {
      const Port& port = graph_.inputs[wire.index];
      return {.drives = {{.input = wire.index, .control = {.low = port.minimum, .high = port.maximum}}}};
    }
    if (wire.from != Wire::From::Node) {
      return {};
    }
    if (wire.index == velocity_) {
      return {.velocity = 1.0};
    }
    if (!on_path_.insert(wire.index).second) {
      const Node& node = graph_.nodes[wire.index];
      refuse(fmt::format("A loop through {} has a memory that no joint has.", node.path),
             "export the axis alone, without a controller round it.", graph_.place(node.span));
    }
    Terms result = terms_of_node(graph_.nodes[wire.index], wire.index, to_acceleration, force_seen);
    on_path_.erase(wire.index);
    return result;
  }

  Terms terms_of_node(const Node& node, std::uint32_t index, double c, bool force) {
    visited_.insert(index);
    if (node.block == nullptr) {
      return terms_of_operation(node, c, force);
    }
    const std::string_view name = name_of(node);
    const auto xin = [&](double factor = 1.0) {
      return terms_of(input_wire(node, "XIN"), c * factor, force).times(factor);
    };
    if (name == "HY_GAIN") {
      return xin(parameter(node, "K"));
    }
    if (name == "HY_SUM" || name == "HY_SUBTRACT") {
      Terms sum;
      for (std::size_t i = 0; i < node.block->inputs.size(); ++i) {
        const double sign = name == "HY_SUBTRACT" && i == 1 ? -1.0 : 1.0;
        sum.add(terms_of(graph_.wire(node, i), sign * c, force).times(sign));
      }
      return sum;
    }
    if (name == "HY_OFFSET") {
      Terms result = xin();
      result.constant += parameter(node, "BIAS");
      return result;
    }
    if (is_integral(node)) {
      return terms_of_integral(node);
    }
    if (node.block->about.family == Family::DryFriction || name == "HY_VISCOUS_FRICTION") {
      return terms_of_friction(node, c, xin());
    }
    if (name == "HY_LIMIT") {
      return limited(node, xin());
    }
    if (name == "HY_LAG") {
      Terms result = xin();
      const double time = parameter(node, "T1");
      if (result.is_one_drive() && result.drives.front().lag == 0.0) {
        result.drives.front().lag = time;
      } else if (time > 0.0) {
        leave(node, "it lags more than the one input, or behind another lag", not_a_number,
              fmt::format("{} s late", short_text(time)));
      }
      return result;
    }
    if (name == "HY_DELAY" || name == "HY_DEAD_TIME") {
      const double late = name == "HY_DELAY" ? graph_.sample_time() : parameter(node, "DEAD_TIME");
      leave(node, "a joint's force acts at once", not_a_number, fmt::format("{} s late", short_text(late)));
      return xin();
    }
    if (name == "HY_COGGING") {
      leave(node, "a joint has no force that repeats itself over the position",
            c * std::hypot(parameter(node, "SINE"), parameter(node, "COSINE")), "");
      return xin();
    }
    if (name == "HY_BACKLASH" || name == "HY_DEAD_BAND") {
      leave(node, "a joint has no play; MuJoCo has it as a second joint with a small range", not_a_number,
            fmt::format("{}{} wide", short_text(parameter(node, "WIDTH")), unit_behind(unit_of(xin_wire(node)))));
      return xin();
    }
    if (!node.block->about.effect.empty() && input_wire(node, "XIN").from != Wire::From::Nothing) {
      leave(node, "a joint has no such effect", not_a_number, "with its own numbers: " + numbers_of(node));
      return xin();
    }
    refuse(fmt::format("{} is a {}, which is no part of a joint.", node.path, name),
           "export the axis alone: drive, inertia, friction, spring, gear.", graph_.place(node.span));
  }

  [[nodiscard]] Wire xin_wire(const Node& node) const { return input_wire(node, "XIN"); }

  Terms terms_of_operation(const Node& node, double c, bool force) {
    const Wire first = graph_.wire(node, 0);
    const Wire second = node.wire_count > 1 ? graph_.wire(node, 1) : Wire{};
    const auto first_factor = constant_of(first);
    const auto second_factor = constant_of(second);
    const auto scaled = [&](const Wire& wire, double factor) {
      return terms_of(wire, c * factor, force).times(factor);
    };
    if (node.op == Op::Add || node.op == Op::Subtract) {
      Terms sum = scaled(first, 1.0);
      sum.add(scaled(second, node.op == Op::Add ? 1.0 : -1.0));
      return sum;
    }
    if (node.op == Op::Negate) {
      return scaled(first, -1.0);
    }
    if (node.op == Op::Multiply && (first_factor || second_factor)) {
      return first_factor ? scaled(second, *first_factor) : scaled(first, *second_factor);
    }
    if (node.op == Op::Divide && second_factor) {
      return scaled(first, 1.0 / *second_factor);
    }
    refuse(fmt::format("An operation at {} is not linear, which a joint is.", node.owner()),
           "export the axis alone: sums, and products with constants.", graph_.place(node.span));
  }

  /// A position is the integral of the velocity times a constant.
  Terms terms_of_integral(const Node& node) {
    const Terms rate = terms_of(xin_wire(node), 0.0, true);
    if (!rate.is_velocity_alone()) {
      refuse(fmt::format("{} integrates something else than the velocity: a joint has no such state.", node.path),
             "export the axis alone, without a controller or an observer.", graph_.place(node.span));
    }
    take_position(node, rate.velocity);
    return {.position = rate.velocity};
  }

  void take_position(const Node& node, double rate) {
    if (name_of(node).ends_with("_BOUNDED")) {
      position_ =
          position_.both(Range{.low = parameter(node, "MN"), .high = parameter(node, "MX")}.times(to_si_ / rate));
    }
  }

  Terms terms_of_friction(const Node& node, double c, Terms terms) {
    const Terms velocity = terms_of(input_wire(node, "V"), 0.0, true);
    if (!velocity.is_velocity_alone() || velocity.velocity < 0.0) {
      leave(node, "its velocity V is not that of the joint", not_a_number, "its numbers: " + numbers_of(node));
      return terms;
    }
    const double scale = velocity.velocity;
    const std::string_view name = name_of(node);
    if (name == "HY_VISCOUS_FRICTION") {
      terms.velocity -= parameter(node, "COEFFICIENT") * scale;
      if (const double quadratic = parameter(node, "QUADRATIC"); quadratic != 0.0) {
        leave(node, "a joint's damping is linear", c * quadratic * scale * scale / (to_si_ * to_si_),
              fmt::format("at 1 {}/s, and grows with the square", units_of_joint(turns_).position));
      }
      return terms;
    }
    double level = parameter(node, "LEVEL");
    if (name == "HY_ASYMMETRIC_FRICTION") {
      const double up = parameter(node, "UP");
      const double down = parameter(node, "DOWN");
      level = 0.5 * (up + down);
      terms.constant -= 0.5 * (up - down);
    } else if (name == "HY_STRIBECK_FRICTION") {
      leave(node, "a joint's dry friction does not fall with the velocity", c * level * parameter(node, "STICTION"),
            "more at rest");
    } else if (name == "HY_LOAD_FRICTION") {
      leave(node, "a joint's dry friction does not grow with the load", not_a_number,
            fmt::format("{} of the load", short_text(parameter(node, "COEFFICIENT"))));
    }
    terms.friction += level;
    if (const double preslide = parameter(node, "PRESLIDE"); preslide > 0.0 && level > 0.0) {
      leave(node, "a joint's dry friction has no elastic travel before it slides", not_a_number,
            fmt::format("{} {} of travel", short_text(preslide * to_si_ / scale), units_of_joint(turns_).position));
    }
    return terms;
  }

  /// Before a lag a limit is one of the input, behind it one of the force.
  Terms limited(const Node& node, Terms terms) {
    const Range range{.low = parameter(node, "MN"), .high = parameter(node, "MX")};
    if (!range.is_bounded()) {
      return terms;
    }
    if (!terms.is_one_drive() || terms.drives.front().gain == 0.0) {
      leave(node, "it limits more than the one input", not_a_number,
            fmt::format("{} to {}{}", short_text(range.low), short_text(range.high),
                        unit_behind(unit_of(xin_wire(node)))));
      return terms;
    }
    DrivePart& drive = terms.drives.front();
    if (drive.lag == 0.0) {
      drive.control = drive.control.both(range.times(1.0 / drive.gain));
    } else {
      drive.force = drive.force.both(range);
    }
    return terms;
  }

  // ---- what is found on the way ----------------------------------------------------------------------------------

  void take_inertia(double inertia, const Wire& wire) {
    if (options_.inertia) {
      told_.push_back(inertia);
      return;
    }
    if (inertia_ && std::fabs(inertia - *inertia_) > 1e-6 * *inertia_) {
      refuse(fmt::format("Two signals with the unit of a force tell different inertias: {} and {}.",
                         short_text(*inertia_), short_text(inertia)),
             "state the unit of one of them alone, or the inertia by --inertia.",
             wire.from == Wire::From::Node ? graph_.place(graph_.nodes[wire.index].span) : Place{});
    }
    inertia_ = inertia;
  }

  void leave(const Node& node, std::string why, double to_acceleration, std::string size) {
    left_.push_back({.node = &node,
                     .why = std::move(why),
                     .acceleration = std::fabs(to_acceleration) * to_si_,
                     .size = std::move(size)});
  }

  // ---- the joint --------------------------------------------------------------------------------------------------

  Joint joint_of_terms(const Terms& terms) {
    const std::optional<double> inertia = options_.inertia ? options_.inertia : inertia_;
    const JointUnits units = units_of_joint(turns_);
    if (!inertia) {
      refuse(fmt::format("No signal on the way to {} has the unit {}: what is moved is not known.",
                         graph_.nodes[velocity_].path, units.force),
             fmt::format("state it in the diagram, as TORQUE : LREAL; (* @unit {} *), or the inertia by --inertia.",
                         units.force));
    }
    // Stated to three digits is stated well; where the units tell two, --inertia says which one counts.
    const auto stated = [&](double told) { return std::fabs(told - *inertia) <= 0.005 * told; };
    if (!told_.empty() && std::ranges::none_of(told_, stated)) {
      refuse(fmt::format("--inertia {} contradicts the units of the diagram, which tell {} {}.", short_text(*inertia),
                         short_text(told_.front()), units.inertia),
             fmt::format("leave --inertia out, or correct the unit {} or the gain behind it.", units.force));
    }
    const auto times_inertia = [&](double term) { return *inertia * term + 0.0; };  // no term has no sign: 0, not -0
    Joint joint{.turns = turns_,
                .velocity = graph_.nodes[velocity_].path + ".XOUT",
                .velocity_to_si = to_si_,
                .inertia = *inertia,
                .damping = times_inertia(-terms.velocity),
                .friction = times_inertia(to_si_ * terms.friction),
                .stiffness = times_inertia(-terms.position),
                .offset = times_inertia(to_si_ * terms.constant)};
    take_actuator(terms, joint);
    take_states(joint);
    for (const Left& one : left_) {
      std::string size = one.size;
      if (std::isfinite(one.acceleration)) {
        size = fmt::format("{} {}{}{}", short_text(one.acceleration * *inertia), units.force, size.empty() ? "" : " ",
                           size);
      }
      joint.neglected.push_back({.what = fmt::format("{}, a {}", one.node->path, name_of(*one.node)),
                                 .why = one.why,
                                 .size = std::move(size)});
    }
    add_unvisited(joint);
    return joint;
  }

  void take_actuator(const Terms& terms, Joint& joint) {
    std::vector<std::string> names;
    for (const DrivePart& drive : terms.drives) {
      const std::string& name = graph_.inputs[drive.input].name;
      if (std::ranges::find(names, name) == names.end()) {
        names.push_back(name);
      }
    }
    if (names.size() > 1 && options_.input.empty()) {
      refuse(fmt::format("Several inputs drive the joint: {}.", fmt::join(names, ", ")),
             fmt::format("say which is the actuator, as --input {}; the others are told as forces from outside.",
                         names.front()));
    }
    const Port* const wanted = options_.input.empty() ? nullptr : find_port(graph_.inputs, options_.input);
    if (!options_.input.empty() && (wanted == nullptr || std::ranges::find(names, wanted->name) == names.end())) {
      refuse(fmt::format("{} is no input that drives the joint.", options_.input),
             fmt::format("inputs that do: {}.", names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
    }
    for (const DrivePart& drive : terms.drives) {
      const Port& port = graph_.inputs[drive.input];
      const double gain = joint.inertia * to_si_ * drive.gain;
      if (wanted != nullptr && &port != wanted) {
        joint.neglected.push_back({.what = fmt::format("{}, an input", port.name),
                                   .why = "a joint has one actuator; apply it as a force from outside",
                                   .size = fmt::format("{} {} for each {}", short_text(gain), joint.force_unit(),
                                                       port.unit.empty() ? "1" : port.unit)});
        continue;
      }
      Actuator part{.input = port.name,
                    .unit = port.unit,
                    .gain = gain,
                    .lag = drive.lag,
                    .control = drive.control,
                    .force = drive.force.times(joint.inertia * to_si_)};
      if (!joint.actuator) {
        joint.actuator = std::move(part);
      } else if (joint.actuator->lag == part.lag && !joint.actuator->force.is_bounded() && !part.force.is_bounded()) {
        joint.actuator->gain += part.gain;
        joint.actuator->control = joint.actuator->control.both(part.control);
      } else {
        refuse(fmt::format("{} drives the joint by two ways, with lags or limits of their own.", port.name),
               "an actuator has one: join them in the diagram.");
      }
    }
  }

  /// Limits of the states: they count wherever the integrals stand.
  void take_states(Joint& joint) {
    const Node& speed = graph_.nodes[velocity_];
    if (name_of(speed).ends_with("_BOUNDED")) {
      joint.speed = to_si_ * std::max(std::fabs(parameter(speed, "MN")), std::fabs(parameter(speed, "MX")));
    }
    for (const Port& port : graph_.outputs) {
      if (port.wire.from == Wire::From::Node && port.wire.index == velocity_) {
        joint.speed = std::min(joint.speed, to_si_ * std::max(std::fabs(port.minimum), std::fabs(port.maximum)));
      }
    }
    for (std::uint32_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      if (!is_integral(node) || i == velocity_ || visited_.contains(i)) {
        continue;
      }
      if (const Wire in = xin_wire(node); in.from == Wire::From::Node && in.index == velocity_) {
        visited_.insert(i);
        take_position(node, 1.0);
      }
    }
    joint.position = position_;
  }

  void add_unvisited(Joint& joint) const {
    for (std::uint32_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      if (node.block != nullptr && !visited_.contains(i)) {
        joint.neglected.push_back({.what = fmt::format("{}, a {}", node.path, name_of(node)),
                                   .why = "it does not act on the motion: of a sensor or of what is shown",
                                   .size = "its numbers: " + numbers_of(node)});
      }
    }
  }

  const JointOptions& options_;
  std::uint32_t velocity_ = 0;
  bool turns_ = true;
  double to_si_ = 1.0;  ///< of the velocity
  std::optional<double> inertia_{};
  std::vector<double> told_{};  ///< by units, where the inertia is stated
  Range position_{};
  std::set<std::uint32_t> on_path_{};
  std::set<std::uint32_t> visited_{};
  std::vector<Left> left_{};
};

}  // namespace

Joint joint_of(const Program& program, const JointOptions& options) {
  return JointReader(program, options).read();
}

Joint behind_gear(Joint joint, double ratio) {
  joint.inertia *= ratio * ratio;
  joint.damping *= ratio * ratio;
  joint.stiffness *= ratio * ratio;
  joint.friction *= ratio;
  joint.offset *= ratio;
  joint.position = joint.position.times(1.0 / ratio);
  joint.speed /= ratio;
  if (joint.actuator) {
    joint.actuator->gain *= ratio;
    joint.actuator->force = joint.actuator->force.times(ratio);
  }
  return joint;
}

}  // namespace hysteron::robots
