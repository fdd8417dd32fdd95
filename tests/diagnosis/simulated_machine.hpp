// Machines for the tests of the diagnosis: a diagram with an effect in its text, run by the interpreter over inputs,
// and white noise on what it gives.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/apply.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/effects/edges.hpp"
#include "records/record.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::test {

inline constexpr double two_pi = 2.0 * std::numbers::pi;

/// The same numbers under every standard library.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }
  /// Normal, of standard deviation 1 (Box and Muller 1958).
  double operator()() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(two_pi * uniform());
  }
  std::vector<double> white(std::size_t count, double deviation) {
    std::vector<double> values(count);
    std::ranges::generate(values, [&] { return deviation * (*this)(); });
    return values;
  }

 private:
  std::mt19937_64 engine_;
};

/// A text as the diagnosis sees it.
struct ReadText {
  std::shared_ptr<const language::SourceFile> source{};
  Definitions definitions{};
  std::uint32_t top = 0;
  std::vector<diagnosis::Edge> edges{};
};

inline ReadText read_text(const std::string& text, std::string_view top) {
  ReadText result;
  Diagnostics diagnostics;
  result.source = std::make_shared<const language::SourceFile>(language::parse("plant.st", text, diagnostics));
  result.definitions = define(result.source, diagnostics);
  result.top = diagnosis::top_definition(result.definitions, top);
  result.edges = diagnosis::edges_of(result.definitions, result.top);
  return result;
}

inline Program program_of(const std::string& text, std::string_view parameters = {}) {
  Program program = compile_text(text, {.any_order = true});
  parameters::apply(parameters::parse_parameter_file("truth.toml", parameters), program.graph);
  return program;
}

/// What is put into a diagram: a declaration and a call of the instance E.
struct Effect {
  std::string block{};  ///< HY_CREEP := (GAIN := 0.1), empty for none
  std::string edge{};   ///< the signal that it changes
  std::string wires{};  ///< ", V := LATE.XOUT": of an axis, the speed one step ago
};

/// A piezo stack: an amplifier with a lag, then hysteresis. Edges U, AMP.XOUT, HYST.XOUT.
inline std::string stack(const Effect& effect = {}, std::string_view hysteresis = "HY_HYSTERESIS_RO") {
  const auto read = [&](std::string_view signal) {
    return effect.edge == signal ? std::string("E.XOUT") : std::string(signal);
  };
  const bool has_effect = !effect.block.empty();
  return fmt::format(
      "FUNCTION_BLOCK STACK  (* @ts 5ms *)\n"
      "  VAR_INPUT U : LREAL;  (* @unit V *) END_VAR\n"
      "  VAR_OUTPUT Y : LREAL;  (* @unit um *) END_VAR\n"
      "  VAR\n    AMP : HY_LAG := (T1 := 0.02);\n    HYST : {} := (C1 := 5.0, C2 := 4.0, C3 := 0.8);\n{}  END_VAR\n"
      "  AMP(XIN := {});\n  HYST(XIN := {});\n{}  Y := {};\nEND_FUNCTION_BLOCK\n",
      hysteresis, has_effect ? fmt::format("    E : {};\n", effect.block) : "", read("U"), read("AMP.XOUT"),
      has_effect ? fmt::format("  E(XIN := {}{});\n", effect.edge, effect.wires) : "", read("HYST.XOUT"));
}

inline constexpr std::string_view stack_parameters =
    "[parameters.AMP]\nT1 = 0.02\n[parameters.HYST]\nC1 = 5.0\nC2 = 4.0\nC3 = 0.8\n";

/// An axis: force over mass, integrated to the speed. Edges FORCE, MASS.XOUT, SPEED.XOUT.
inline std::string axis(const Effect& effect = {}) {
  const auto read = [&](std::string_view signal) {
    return effect.edge == signal ? std::string("E.XOUT") : std::string(signal);
  };
  const bool has_effect = !effect.block.empty();
  const bool is_late = effect.wires.find("LATE") != std::string::npos;
  return fmt::format(
      "FUNCTION_BLOCK AXIS  (* @ts 5ms *)\n"
      "  VAR_INPUT FORCE : LREAL;  (* @unit N *) END_VAR\n"
      "  VAR_OUTPUT V : LREAL;  (* @unit m/s *) END_VAR\n"
      "  VAR\n    MASS : HY_GAIN := (K := 0.5);\n    SPEED : HY_INTEGRAL;\n{}  END_VAR\n"
      "  MASS(XIN := {});\n  SPEED(XIN := {});\n{}  V := {};\nEND_FUNCTION_BLOCK\n",
      (has_effect ? fmt::format("    E : {};\n", effect.block) : "") + (is_late ? "    LATE : HY_DELAY;\n" : ""),
      read("FORCE"), read("MASS.XOUT"),
      (has_effect ? fmt::format("  E(XIN := {}{});\n", effect.edge, effect.wires) : "") +
          (is_late ? "  LATE(XIN := SPEED.XOUT);\n" : ""),
      read("SPEED.XOUT"));
}

inline constexpr std::string_view axis_parameters = "[parameters.MASS]\nK = 0.5\n";

/// Loops of growing size, dwells at several levels, triangles of several rates, nested loops: 0 to 4 V, 10 s.
inline std::vector<double> rich_voltage(std::size_t count = 2000, double sample_time = 0.005) {
  const std::vector<std::pair<double, double>> corners{
      {0.0, 0.0}, {0.3, 0.0}, {0.8, 2.0}, {1.1, 0.5}, {1.7, 4.0}, {2.7, 4.0}, {3.0, 1.0}, {3.2, 3.0}, {3.4, 1.5},
      {3.6, 2.5}, {3.9, 1.2}, {4.1, 3.6}, {4.5, 0.0}, {5.5, 0.0}, {5.6, 3.0}, {5.7, 0.6}, {5.8, 2.4}, {5.9, 0.9},
      {6.3, 3.8}, {6.8, 2.0}, {7.8, 2.0}, {7.9, 1.0}, {8.9, 4.0}, {9.2, 2.2}, {9.4, 3.0}, {10., 0.4}};
  std::vector<double> values;
  std::size_t at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * sample_time;
    while (at + 2 < corners.size() && t > corners[at + 1].first) {
      ++at;
    }
    const auto [t0, u0] = corners[at];
    const auto [t1, u1] = corners[at + 1];
    values.push_back(u0 + (u1 - u0) * std::clamp((t - t0) / (t1 - t0), 0.0, 1.0));
  }
  return values;
}

/// Forces that push an axis to and fro, with rests: sines of growing frequency and steps.
inline std::vector<double> rich_force(std::size_t count = 2000, double sample_time = 0.005) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * sample_time;
    const double swell = 0.4 + 0.6 * std::abs(std::sin(0.31 * t));
    const double sines = 3.0 * std::sin(two_pi * 0.7 * t) + 1.5 * std::sin(two_pi * 2.3 * t + 1.0);
    values.push_back(std::fmod(t, 4.0) > 3.4 ? 0.0 : swell * sines);
  }
  return values;
}

inline records::Record record_of(std::string name, std::vector<double> values, double sample_time = 0.005) {
  records::Record record = records::Record::even(0.0, sample_time, values.size());
  record.add({.name = std::move(name), .values = std::move(values)});
  return record;
}

/// The record with the outputs of a program, and white noise on them.
inline records::Record measured(const Program& machine, records::Record record, double deviation,
                                std::uint64_t seed = 1) {
  Noise noise(seed);
  auto outputs = simulate(machine, record);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (double& value : outputs[i]) {
      value += deviation * noise();
    }
    record.add({.name = machine.graph.outputs[i].name, .values = std::move(outputs[i])});
  }
  return record;
}

/// The record with one column's values changed.
template <class Change>
records::Record changed(const records::Record& record, std::string_view column, const Change& change) {
  records::Record result = records::Record::even(record.time().front(), record.sample_time(), record.size());
  for (records::Column one : record.columns()) {
    if (language::same_name(one.name, column)) {
      change(one.values);
    }
    result.add(std::move(one));
  }
  return result;
}

inline diagnosis::DiagnosisInput input_of(const std::string& text, std::string_view parameters,
                                          std::vector<records::Record> records) {
  return {.program = compile_text(text),
          .text = text,
          .file = parameters::parse_parameter_file("p.toml", parameters),
          .records = std::move(records)};
}

/// Of an axis whose sensor feels a temperature, a column that the diagram does not use.
inline records::Record warm_sensor() {
  std::string machine = axis({"HY_CROSS_COUPLING := (GAIN := 0.01)", "SPEED.XOUT", ", Z := TEMP"});
  machine.replace(machine.find("FORCE : LREAL;"), 14, "TEMP : LREAL; FORCE : LREAL;");
  records::Record record = record_of("FORCE", rich_force());
  std::vector<double> temperature;
  for (int k = 0; k < 2000; ++k) {
    temperature.push_back(std::sin(0.005 * k * 1.9) + 0.5 * std::sin(0.005 * k * 4.3));
  }
  record.add({.name = "temp", .values = temperature});
  return measured(program_of(machine), record, 0.001);
}

}  // namespace hysteron::test
