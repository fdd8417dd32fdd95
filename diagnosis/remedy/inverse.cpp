#include "diagnosis/remedy/inverse.hpp"

#include <algorithm>
#include <array>

namespace hysteron::diagnosis {
namespace {

constexpr auto exact = Inverse::Exact;
constexpr auto avoidable = Inverse::Avoidable;
constexpr auto none = Inverse::None;

constexpr std::array table{
    InverseOfEffect{"asymmetric_friction", exact, "added, and given by the velocity of the reference; not at rest"},
    InverseOfEffect{"asymmetry", exact, "the loop rises in both directions, so each output has one input"},
    InverseOfEffect{"backlash", exact, "the input jumps across the gap at each reversal"},
    InverseOfEffect{"bias_dependence", exact, "the loop rises wherever its slope is above 0"},
    InverseOfEffect{"blind_to_direction", none, "it lies in the sensor: measure the direction too"},
    InverseOfEffect{"branch_chatter", avoidable, "a reference without small reversals does not show it"},
    InverseOfEffect{"clock", none, "it lies in the record, not in the machine: mend the time stamps"},
    InverseOfEffect{"cogging", exact, "added over a position that the reference gives"},
    InverseOfEffect{"coulomb_friction", exact, "added, and given by the velocity of the reference; not at rest"},
    InverseOfEffect{"creep", exact, "linear, and acts at once: the creep of the past is taken off"},
    InverseOfEffect{"cross_coupling", exact, "added, where the other signal is measured"},
    InverseOfEffect{"curve_shape", exact, "the loop rises wherever its slope is above 0"},
    InverseOfEffect{"cutout", avoidable, "a plan that keeps the other signal within the limits does not meet them"},
    InverseOfEffect{"cyclic_error", exact, "added over a position that the reference gives; a sensor's is none yet"},
    InverseOfEffect{"dead_zone", exact, "the input jumps across the zone"},
    InverseOfEffect{"delay", avoidable, "only a preview of the reference undoes it"},
    InverseOfEffect{"drift", exact, "a known function of time, counted from the start"},
    InverseOfEffect{"even_nonlinearity", exact, "static, within the range over which it rises"},
    InverseOfEffect{"gain_drift", exact, "a known function of time, counted from the start"},
    InverseOfEffect{"gain_error", exact, "the input is divided by the gain"},
    InverseOfEffect{"glitches", none, "nobody knows when the next one comes"},
    InverseOfEffect{"held_values", none, "what happens between two runs of the slower task is not passed on"},
    InverseOfEffect{"lag", exact, "by the rate of the reference, which must be smooth"},
    InverseOfEffect{"load", exact, "added, where it is measured or its times are known"},
    InverseOfEffect{"load_friction", exact, "added, where the load is measured; not at rest"},
    InverseOfEffect{"odd_nonlinearity", exact, "static, within the range over which it rises"},
    InverseOfEffect{"offset", exact, "it is subtracted"},
    InverseOfEffect{"parameter_mismatch", exact, "the parameters are set right"},
    InverseOfEffect{"periodic_disturbance", exact, "a known function of time, while its phase is known"},
    InverseOfEffect{"presliding_friction", exact, "added, and given by the velocity of the reference; not at rest"},
    InverseOfEffect{"quantization", none, "what lies between two steps cannot be reached"},
    InverseOfEffect{"rate_dependence", exact, "the loop rises at every rate"},
    InverseOfEffect{"rate_limit", avoidable, "a reference planned below the limit does not meet it"},
    InverseOfEffect{"relaxation", exact, "linear, and acts at once: a lag of the reference is taken off"},
    InverseOfEffect{"resonance", exact, "by the rate and acceleration of the reference, which must be smooth"},
    InverseOfEffect{"return_point_memory", exact, "the loop rises in both directions, so each output has one input"},
    InverseOfEffect{"saturating_curve", none, "within its range it is static and rises; no block undoes it yet"},
    InverseOfEffect{"saturation", avoidable, "a reference planned within the limits does not meet it"},
    InverseOfEffect{"scheduled_gain", none,
                    "where the other signal is measured the input is divided by the gain; not built yet"},
    InverseOfEffect{"stribeck_friction", exact, "added, and given by the velocity of the reference; not at rest"},
    InverseOfEffect{"thermal_drift", exact, "a known function of time, counted from a cold start"},
    InverseOfEffect{"valve_stiction", none, "the stem slips as it likes: a valve positioner or another packing"},
    InverseOfEffect{"viscous_friction", exact, "added, and given by the velocity of the reference"},
};

static_assert(std::ranges::is_sorted(table, {}, &InverseOfEffect::effect));

}  // namespace

std::span<const InverseOfEffect> inverses() {
  return table;
}

InverseOfEffect inverse_of(std::string_view effect) {
  const auto* const found = std::ranges::find(table, effect, &InverseOfEffect::effect);
  return found != table.end() ? *found
                              : InverseOfEffect{effect, none, "an effect of your own: its inverse is not known"};
}

}  // namespace hysteron::diagnosis
