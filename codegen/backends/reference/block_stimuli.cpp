#include "codegen/backends/reference/block_stimuli.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hysteron {
namespace {

using Shape = Waveform::Shape;

Waveform sine(double amplitude, double period = 1.0, double offset = 0.0) {
  return {.shape = Shape::Sine, .amplitude = amplitude, .period = period, .offset = offset};
}
Waveform fading(double amplitude, double period = 1.0) {
  return {.shape = Shape::FadingSine, .amplitude = amplitude, .period = period};
}
Waveform triangle(double amplitude, double period = 1.0, double offset = 0.0) {
  return {.shape = Shape::Triangle, .amplitude = amplitude, .period = period, .offset = offset};
}
Waveform square(double amplitude, double period = 1.0, double offset = 0.0) {
  return {.shape = Shape::Square, .amplitude = amplitude, .period = period, .offset = offset};
}
Waveform sweep(double from, double to) {
  return {.shape = Shape::Sweep, .amplitude = to - from, .offset = from};
}
Waveform levels(std::vector<std::pair<double, double>> list) {
  return {.shape = Shape::Levels, .levels = std::move(list)};
}
/// FALSE, and TRUE from each first time to the second.
Waveform pulses(const std::vector<std::pair<double, double>>& on) {
  std::vector<std::pair<double, double>> list{{0.0, 0.0}};
  for (const auto& [begin, end] : on) {
    list.emplace_back(begin, 1.0);
    list.emplace_back(end, 0.0);
  }
  return levels(std::move(list));
}

struct Entry {
  std::string_view block;
  Stimulus stimulus;
};

constexpr std::string_view hysteresis = "C1 := 1.0, C2 := 1.5, C3 := 1.0";
constexpr std::string_view slope = "C1 := 1.0, C2 := 2.0, C3 := 0.5";
constexpr std::string_view slope_points =
    "P_TABLE := [0.0, 0.25, 0.5, 1.0], M_TABLE := [1.0, 1.8, 2.3, 2.6], COUNT := 4";

/// An input in steps that meets the threshold 1 exactly.
DrivenPin compared() {
  return {"IN1", levels({{0.0, 0.0}, {0.4, 0.5}, {0.8, 1.0}, {1.2, 1.5}, {1.6, 1.0}})};
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> list{
      // memory
      {"HY_BRANCH", {.pins = {{"XIN", fading(1.0, 0.8)}}, .shown = {"XB", "P", "Q"}}},
      {"HY_MOMENTUM", {.pins = {{"XIN", sine(1.0)}, {"R1", pulses({{0.5, 0.51}, {1.0, 1.01}, {1.5, 1.51}})}}}},
      {"HY_M",
       {.settings = slope,
        .pins = {{"XIN", levels({{0.0, 1.0}})}, {"P", sweep(0.0, 1.0)}},
        .abscissa = "P",
        .shown = {"XOUT"}}},
      {"HY_M_INVERSE",
       {.settings = slope, .pins = {{"XIN", levels({{0.0, 1.0}})}, {"P", sweep(0.0, 1.0)}}, .abscissa = "P"}},
      {"HY_M_TABLE",
       {.settings = slope_points,
        .pins = {{"XIN", levels({{0.0, 1.0}})}, {"P", sweep(0.0, 1.2)}},
        .abscissa = "P",
        .shown = {"XOUT"}}},
      {"HY_M_TABLE_INVERSE",
       {.settings = slope_points, .pins = {{"XIN", levels({{0.0, 1.0}})}, {"P", sweep(0.0, 1.2)}}, .abscissa = "P"}},
      {"HY_MEM",
       {.settings = "C1 := 1.0, C2 := 6.0", .pins = {{"XIN", sine(1.0)}}, .abscissa = "XIN", .shown = {"XOUT"}}},
      {"HY_MEM_INVERSE",
       {.settings = "C1 := 1.0, C2 := 6.0", .pins = {{"XIN", sine(1.0)}}, .abscissa = "XIN", .shown = {"XOUT"}}},
      {"HY_HYSTERESIS_RO",
       {.settings = hysteresis, .pins = {{"XIN", fading(1.0)}}, .abscissa = "XIN", .steps = 400, .shown = {"XOUT"}}},
      {"HY_HYSTERESIS_RO_INVERSE",
       {.settings = hysteresis, .pins = {{"XIN", fading(2.0)}}, .abscissa = "XIN", .steps = 400, .shown = {"XOUT"}}},
      {"HY_HYSTERESIS_GENERAL",
       {.settings = "C1 := 1.0, C2 := 1.5, C3 := 1.0, RETURN_POINT := 1.0",
        .pins = {{"XIN", fading(1.0)}},
        .abscissa = "XIN",
        .steps = 400,
        .shown = {"XOUT"}}},
      {"HY_M_GENERAL",
       {.settings = "C1 := 1.0, C2 := 1.0, C3 := 1.0, SHAPE := -0.9, SHAPE_DEPTH := 0.2",
        .pins = {{"XIN", levels({{0.0, 1.0}})}, {"P", sweep(0.0, 1.0)}},
        .abscissa = "P",
        .shown = {"XOUT"}}},
      // arithmetic and functions
      {"HY_CONSTANT", {.settings = "K := 2.0"}},
      {"HY_GAIN", {.settings = "K := 2.0", .pins = {{"XIN", sine(1.0)}}}},
      {"HY_QUOTIENT", {.pins = {{"IN1", sine(1.0)}, {"IN2", triangle(1.0, 2.0, 1.5)}}}},
      {"HY_POWER", {.settings = "EXPONENT := 1.5", .pins = {{"XIN", sweep(0.0, 2.0)}}, .abscissa = "XIN"}},
      {"HY_SQRT", {.pins = {{"XIN", sweep(0.0, 4.0)}}, .abscissa = "XIN"}},
      {"HY_LN", {.pins = {{"XIN", sweep(0.02, 4.0)}}, .abscissa = "XIN"}},
      {"HY_SIN", {.pins = {{"XIN", sweep(-6.3, 6.3)}}, .abscissa = "XIN"}},
      {"HY_COS", {.pins = {{"XIN", sweep(-6.3, 6.3)}}, .abscissa = "XIN"}},
      {"HY_TAN", {.pins = {{"XIN", sweep(-1.3, 1.3)}}, .abscissa = "XIN"}},
      {"HY_ATAN", {.pins = {{"XIN", sweep(-6.0, 6.0)}}, .abscissa = "XIN"}},
      // shaping
      {"HY_LIMIT", {.settings = "MN := -1.0, MX := 1.5", .pins = {{"XIN", triangle(2.0)}}}},
      {"HY_DEAD_BAND", {.settings = "WIDTH := 1.0", .pins = {{"XIN", sweep(-2.0, 2.0)}}, .abscissa = "XIN"}},
      {"HY_RATE_LIMIT", {.settings = "RISE := 4.0, FALL := 2.0", .pins = {{"XIN", square(1.0)}}}},
      {"HY_SWITCH", {.pins = {{"G", square(1.0, 0.8)}, {"IN0", sine(0.5, 0.4)}, {"IN1", triangle(0.3, 0.4, 0.6)}}}},
      {"HY_TABLE",
       {.settings = "X := [-1.0, 0.0, 0.5, 1.0], Y := [-0.5, 0.0, 1.0, 1.2], COUNT := 4",
        .pins = {{"XIN", sweep(-1.5, 1.5)}},
        .abscissa = "XIN"}},
      {"HY_QUANTIZER", {.settings = "QUANTUM := 0.5", .pins = {{"XIN", sweep(-1.5, 1.5)}}, .abscissa = "XIN"}},
      {"HY_BACKLASH", {.settings = "WIDTH := 0.5", .pins = {{"XIN", fading(1.0, 0.5)}}, .abscissa = "XIN"}},
      {"HY_HYSTERESIS", {.settings = "EPS := 0.4", .pins = {{"XIN1", sine(1.0)}, {"XIN2", levels({{0.0, 0.0}})}}}},
      {"HY_SAMPLE_AND_HOLD", {.pins = {{"XIN", sine(1.0)}, {"TRACK", square(1.0, 0.6)}}}},
      // control and references
      {"HY_PID",
       {.settings = "KP := 1.0, TR := 0.5, TD := 0.05, MX := 3.0",
        .pins = {{"SP", levels({{0.0, 0.0}, {0.2, 1.0}})}, {"PV", levels({{0.0, 0.0}, {1.2, 0.6}})}},
        .shown = {"XOUT", "E", "QHIGH"}}},
      {"HY_RAMP",
       {.pins = {{"RUN", pulses({{0.3, 1.7}})}, {"X1", levels({{0.0, 1.0}})}, {"TR", levels({{0.0, 0.8}})}}}},
      {"HY_STEP", {.settings = "T0 := 0.5"}},
      // comparison and logic
      {"HY_GT", {.pins = {compared(), {"IN2", levels({{0.0, 1.0}})}}}},
      {"HY_GE", {.pins = {compared(), {"IN2", levels({{0.0, 1.0}})}}}},
      {"HY_EQ", {.pins = {compared(), {"IN2", levels({{0.0, 1.0}})}}}},
      {"HY_LE", {.pins = {compared(), {"IN2", levels({{0.0, 1.0}})}}}},
      {"HY_LT", {.pins = {compared(), {"IN2", levels({{0.0, 1.0}})}}}},
      {"HY_NE", {.pins = {compared(), {"IN2", levels({{0.0, 1.0}})}}}},
      {"HY_R_TRIG", {.pins = {{"CLK", pulses({{0.4, 0.8}, {1.2, 1.7}})}}, .sample_time = 0.05, .steps = 40}},
      {"HY_F_TRIG", {.pins = {{"CLK", pulses({{0.4, 0.8}, {1.2, 1.7}})}}, .sample_time = 0.05, .steps = 40}},
      {"HY_SR", {.pins = {{"S1", pulses({{0.2, 0.4}, {1.2, 1.6}})}, {"R", pulses({{0.8, 1.0}, {1.4, 1.8}})}}}},
      {"HY_RS", {.pins = {{"S", pulses({{0.2, 0.4}, {1.2, 1.6}})}, {"R1", pulses({{0.8, 1.0}, {1.4, 1.5}})}}}},
      // time and counting
      {"HY_TON", {.pins = {{"IN", pulses({{0.2, 0.5}, {0.8, 1.6}})}, {"PT", levels({{0.0, 0.5}})}}}},
      {"HY_TOF", {.pins = {{"IN", pulses({{0.2, 0.4}, {0.7, 1.1}})}, {"PT", levels({{0.0, 0.5}})}}}},
      {"HY_TP", {.pins = {{"IN", pulses({{0.2, 0.4}, {0.9, 1.7}})}, {"PT", levels({{0.0, 0.5}})}}}},
      {"HY_BLINK", {.settings = "THIGH := 0.3, TLOW := 0.2", .pins = {{"RUN", pulses({{0.2, 1.6}})}}}},
      {"HY_CTU", {.pins = {{"CU", square(1.0, 0.2)}, {"R", pulses({{1.45, 1.55}})}, {"PV", levels({{0.0, 4.0}})}}}},
      {"HY_CTD",
       {.pins = {{"CD", square(1.0, 0.2)}, {"LD", pulses({{0.05, 0.1}, {1.45, 1.55}})}, {"PV", levels({{0.0, 4.0}})}}}},
      {"HY_CTUD",
       {.pins = {{"CU", pulses({{0.2, 0.3}, {0.4, 0.5}, {0.6, 0.7}, {0.8, 0.9}})},
                 {"CD", pulses({{1.1, 1.2}, {1.3, 1.4}, {1.5, 1.6}, {1.7, 1.8}})},
                 {"PV", levels({{0.0, 3.0}})}}}},
      // dynamics
      {"HY_DERIVATIVE", {.pins = {{"XIN", triangle(0.5)}}}},
      {"HY_DERIVATIVE4", {.pins = {{"XIN", triangle(0.5)}}}},
      {"HY_DERIVATIVE_FILTERED", {.settings = "T1 := 0.05", .pins = {{"XIN", triangle(0.5)}}}},
      {"HY_INTEGRAL", {.pins = {{"XIN", square(2.0, 1.0, -1.0)}}, .shown = {"XOUT"}}},
      {"HY_INTEGRAL_BOUNDED", {.settings = "MX := 0.6", .pins = {{"XIN", square(2.0, 1.0, -1.0)}}, .shown = {"XOUT"}}},
      {"HY_INTEGRAL_FORWARD_BOUNDED",
       {.settings = "MX := 0.6", .pins = {{"XIN", square(2.0, 1.0, -1.0)}}, .shown = {"XOUT"}}},
      {"HY_INTEGRAL_FORWARD", {.pins = {{"XIN", square(2.0, 1.0, -1.0)}}, .shown = {"XOUT"}}},
      {"HY_DELAY", {.pins = {{"XIN", square(1.0, 0.8)}}, .sample_time = 0.1, .steps = 20}},
      {"HY_DELAY_BOOL", {.pins = {{"XIN", square(1.0, 0.8)}}, .sample_time = 0.1, .steps = 20}},
      {"HY_DELAY_DINT",
       {.pins = {{"XIN", levels({{0.0, 1.0}, {0.5, 4.0}, {1.0, 2.0}, {1.5, 3.0}})}}, .sample_time = 0.1, .steps = 20}},
      {"HY_DELAY_WORD",
       {.pins = {{"XIN", levels({{0.0, 1.0}, {0.5, 4.0}, {1.0, 2.0}, {1.5, 3.0}})}}, .sample_time = 0.1, .steps = 20}},
      {"HY_DEAD_TIME", {.settings = "DEAD_TIME := 0.25", .pins = {{"XIN", triangle(1.0)}}}},
      {"HY_LAG", {.settings = "T1 := 0.15", .pins = {{"XIN", square(1.0)}}, .shown = {"XOUT"}}},
      {"HY_LEAD_LAG", {.settings = "T1 := 0.2, T2 := 0.1", .pins = {{"XIN", square(1.0)}}, .shown = {"XOUT"}}},
      {"HY_SECOND_ORDER", {.settings = "T := 0.03, ZETA := 0.2", .pins = {{"XIN", square(1.0)}}, .shown = {"XOUT"}}},
      // effects
      {"HY_OFFSET", {.settings = "BIAS := 0.5", .pins = {{"XIN", sine(1.0)}}}},
      {"HY_DRIFT", {.settings = "RATE := 0.5", .pins = {{"XIN", square(1.0, 0.5)}}}},
      {"HY_THERMAL_DRIFT", {.settings = "SIZE := 0.5, T1 := 0.5", .pins = {{"XIN", square(1.0, 0.5)}}}},
      {"HY_GAIN_DRIFT", {.settings = "RATE := 0.5, SETTLING := 3.0", .pins = {{"XIN", sine(1.0, 0.5)}}}},
      {"HY_CREEP", {.settings = "GAIN := 0.2, T_ONSET := 0.01", .pins = {{"XIN", square(1.0, 1.0)}}}},
      {"HY_RELAXATION", {.settings = "GAIN := 0.5, T1 := 0.15", .pins = {{"XIN", square(1.0)}}}},
      {"HY_COULOMB_FRICTION",
       {.settings = "LEVEL := 0.5, PRESLIDE := 0.02", .pins = {{"XIN", levels({{0.0, 1.0}})}, {"V", sine(1.0)}}}},
      {"HY_STRIBECK_FRICTION",
       {.settings = "LEVEL := 0.5, V_STRIBECK := 0.3, PRESLIDE := 0.02",
        .pins = {{"XIN", levels({{0.0, 1.0}})}, {"V", sine(1.0)}}}},
      {"HY_DAHL_FRICTION",
       {.settings = "LEVEL := 0.5, PRESLIDE := 0.05", .pins = {{"XIN", levels({{0.0, 1.0}})}, {"V", sine(1.0)}}}},
      {"HY_ASYMMETRIC_FRICTION",
       {.settings = "UP := 0.6, DOWN := 0.2, PRESLIDE := 0.02",
        .pins = {{"XIN", levels({{0.0, 1.0}})}, {"V", sine(1.0)}}}},
      {"HY_LOAD_FRICTION",
       {.settings = "LEVEL := 0.1, COEFFICIENT := 0.4, PRESLIDE := 0.02",
        .pins = {{"XIN", levels({{0.0, 1.5}})}, {"V", sine(1.0, 0.5)}, {"W", triangle(1.0, 4.0)}}}},
      {"HY_VALVE_STICTION",
       {.settings = "STICK := 0.6, JUMP := 0.3", .pins = {{"XIN", sine(1.0)}}, .abscissa = "XIN", .steps = 400}},
      {"HY_VISCOUS_FRICTION",
       {.settings = "COEFFICIENT := 0.5", .pins = {{"XIN", levels({{0.0, 1.0}})}, {"V", sine(1.0)}}}},
      {"HY_COGGING",
       {.settings = "SINE := 0.2, PITCH := 0.25",
        .pins = {{"XIN", levels({{0.0, 1.0}})}, {"POS", triangle(1.0, 2.0)}}}},
      {"HY_PERIODIC_ERROR",
       {.settings = "SINE := 0.1, PITCH := 0.5", .pins = {{"XIN", sweep(-1.0, 1.0)}}, .abscissa = "XIN"}},
      {"HY_CYCLIC_FORCE",
       {.settings = "SINE := 0.2, SINE2 := 0.15, PITCH := 0.5",
        .pins = {{"XIN", levels({{0.0, 1.0}})}, {"POS", triangle(1.0, 2.0)}}}},
      {"HY_CYCLIC_ERROR",
       {.settings = "SINE := 0.05, COSINE2 := 0.08, PITCH := 1.0",
        .pins = {{"XIN", sweep(-1.0, 1.0)}},
        .abscissa = "XIN"}},
      {"HY_SATURATING_CURVE", {.settings = "BEND := 1.0", .pins = {{"XIN", sweep(-2.0, 2.0)}}, .abscissa = "XIN"}},
      {"HY_ABSOLUTE_SENSOR", {.settings = "SHARE := 1.0", .pins = {{"XIN", sine(1.0)}}}},
      {"HY_SCHEDULED_GAIN", {.settings = "SHARE := 0.5", .pins = {{"XIN", sine(1.0, 0.5)}, {"Z", triangle(1.0, 4.0)}}}},
      {"HY_CUTOUT",
       {.settings = "MX := 0.7, BAND := 0.4", .pins = {{"XIN", levels({{0.0, 1.0}})}, {"Z", triangle(1.0)}}}},
      {"HY_HELD", {.settings = "PERIOD := 0.125", .pins = {{"XIN", sine(1.0)}}}},
      {"HY_EVEN_NONLINEARITY", {.settings = "SIZE := 0.3", .pins = {{"XIN", sweep(-1.0, 1.0)}}, .abscissa = "XIN"}},
      {"HY_ODD_NONLINEARITY", {.settings = "SIZE := 0.3", .pins = {{"XIN", sweep(-1.0, 1.0)}}, .abscissa = "XIN"}},
      {"HY_PERIODIC_DISTURBANCE", {.settings = "SINE := 0.1, FREQUENCY := 10.0", .pins = {{"XIN", sine(1.0, 2.0)}}}},
      {"HY_CROSS_COUPLING",
       {.settings = "GAIN := 0.2, T1 := 0.1", .pins = {{"XIN", sine(1.0, 2.0)}, {"Z", square(1.0, 0.5)}}}},
      {"HY_LOAD", {.settings = "SIZE := 0.5, T_ON := 0.6, T_OFF := 1.4", .pins = {{"XIN", sine(1.0)}}}},
      {"HY_CLOCK", {.settings = "SKEW := 0.1, LOST := 0.2, T_LOST := 1.0", .pins = {{"XIN", sine(1.0, 0.5)}}}},
  };
  return list;
}

/// What shows most blocks: real inputs are waves of different periods, truth values go through all their combinations.
Stimulus by_pins(const BlockType& block) {
  Stimulus stimulus;
  const std::array waves{sine(1.0), triangle(0.6, 1.4), sine(0.4, 0.3), triangle(0.3, 0.5)};
  std::size_t reals = 0;
  double period = 1.0;
  for (const Field& input : block.inputs) {
    if (!input.required) {
      continue;
    }
    switch (input.type) {
      case Type::Real:
        stimulus.pins.push_back({input.name, waves[reals++ % waves.size()]});
        break;
      case Type::Bool:
        stimulus.pins.push_back({input.name, square(1.0, period)});
        period *= 0.5;
        break;
      case Type::Int:
      case Type::Word:
        stimulus.pins.push_back({input.name, levels({{0.0, 1.0}})});
        break;
    }
  }
  const bool curve = block.states.empty() && stimulus.pins.size() == 1 && reals == 1;
  if (curve && !block.about.rate_transition) {
    stimulus.pins.front().wave = sweep(-2.0, 2.0);
    stimulus.abscissa = stimulus.pins.front().pin;
  }
  return stimulus;
}

}  // namespace

double Waveform::at(int step, int steps, double sample_time) const {
  const double t = step * sample_time;
  const double turn = t / period - std::floor(t / period);
  switch (shape) {
    case Shape::Sine:
      return offset + amplitude * std::sin(2.0 * std::numbers::pi * t / period);
    case Shape::FadingSine:
      return offset +
             amplitude * (1.0 - static_cast<double>(step) / steps) * std::sin(2.0 * std::numbers::pi * t / period);
    case Shape::Triangle:
      return offset + amplitude * (turn < 0.25 ? 4.0 * turn : (turn < 0.75 ? 2.0 - 4.0 * turn : 4.0 * turn - 4.0));
    case Shape::Square:
      return turn > 0.5 - 1e-9 ? offset + amplitude : offset;
    case Shape::Sweep:
      return offset + amplitude * step / (steps - 1);
    case Shape::Levels: {
      double value = 0.0;
      for (const auto& [time, level] : levels) {
        if (t > time - 1e-9) {
          value = level;
        }
      }
      return value;
    }
  }
  return 0.0;
}

Stimulus stimulus_of(const BlockType& block) {
  const auto& list = entries();
  const auto found = std::ranges::find_if(list, [&](const Entry& entry) { return entry.block == block.about.name; });
  return found != list.end() ? found->stimulus : by_pins(block);
}

}  // namespace hysteron
