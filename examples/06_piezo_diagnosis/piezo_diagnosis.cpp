#include "examples/06_piezo_diagnosis/piezo_diagnosis.hpp"

#include <span>

#include "examples/example.hpp"

namespace hysteron::examples {

const std::vector<std::string>& effects_of_a_stack() {
  static const std::vector<std::string> effects{"asymmetry",
                                                "backlash",
                                                "bias_dependence",
                                                "creep",
                                                "curve_shape",
                                                "dead_zone",
                                                "delay",
                                                "drift",
                                                "lag",
                                                "even_nonlinearity",
                                                "odd_nonlinearity",
                                                "rate_limit",
                                                "rate_dependence",
                                                "relaxation",
                                                "resonance",
                                                "saturation",
                                                "thermal_drift",
                                                "return_point_memory"};
  return effects;
}

StackCycles cycles_of(const records::Record& identification) {
  StackCycles cycles{.fitted = identification.slice(identification.rows_between(1.75, 21.0)),
                     .whole = identification.slice(identification.rows_between(1.75, 1000.0))};
  cycles.range = range(cycles.whole.column("y").values);
  return cycles;
}

StackGap gap_of(const Round& round, const StackCycles& cycles) {
  StackGap gap{.residual = residuals_of(round, cycles.whole).front()};
  const std::span<const double> residual(gap.residual);
  gap.fitted = rms(residual.first(cycles.fitted.size())) / cycles.range;
  gap.held_out = rms(residual.subspan(cycles.fitted.size())) / cycles.range;
  return gap;
}

}  // namespace hysteron::examples
