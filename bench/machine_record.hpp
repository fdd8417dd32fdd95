// A record of bench/diagnosis/machine.st as long as wanted: a reference with held random levels in, its output with
// noise of 10 nm out. What a fit of output error is given.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "bench/reference_signal.hpp"
#include "codegen/interpreter/machine.hpp"

namespace hysteron::bench {

inline constexpr double machine_period = 1e-3;

/// What the fits find: AMPLIFIER.T1, GEAR.WIDTH, STAGE.K, STAGE.T, CREEP.GAIN, CREEP.T_ONSET. They start elsewhere.
inline constexpr const char* machine_parameters =
    "[parameters.AMPLIFIER]\nT1 = 0.01\n[parameters.GEAR]\nWIDTH = 0.2\n[parameters.STAGE]\nK = 1.5\nT = 0.03\n"
    "[parameters.CREEP]\nGAIN = 0.1\nT_ONSET = 0.1\n"
    "[fit.AMPLIFIER]\nT1 = {}\n[fit.GEAR]\nWIDTH = {}\n[fit.STAGE]\nK = {}\nT = {}\n[fit.CREEP]\nGAIN = {}\nT_ONSET = "
    "{}\n";

struct MachineRecord {
  std::vector<double> u;
  std::vector<double> y;
};

inline Program machine_program() {
  Diagnostics warnings;
  return compile_file(HYSTERON_SOURCE_DIR "/bench/diagnosis/machine.st", {}, warnings);
}

/// The same numbers on every machine.
inline MachineRecord machine_record(std::size_t samples) {
  std::mt19937_64 engine(1);
  const auto uniform = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  MachineRecord record{.u = reference_signal(samples), .y = std::vector<double>(samples)};
  Machine<double> machine(machine_program());
  double level = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    if (k % 50 == 0) {
      level = 2.0 * uniform() - 1.0;
    }
    record.u[k] += level;
    machine.set_input(0, record.u[k]);
    machine.step();
    double noise = -6.0;
    for (int i = 0; i < 12; ++i) {
      noise += uniform();
    }
    record.y[k] = machine.output(0) + 0.01 * noise;
  }
  return record;
}

}  // namespace hysteron::bench
