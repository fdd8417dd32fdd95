// The catalogue: every block of the library, one line each. What is derived from blocks is derived over this list.
#pragma once

#include "blocks/absolute.hpp"
#include "blocks/absolute_sensor.hpp"
#include "blocks/arctangent.hpp"
#include "blocks/asymmetric_friction.hpp"
#include "blocks/backlash.hpp"
#include "blocks/blink.hpp"
#include "blocks/branch.hpp"
#include "blocks/clock.hpp"
#include "blocks/cogging.hpp"
#include "blocks/constant.hpp"
#include "blocks/cosine.hpp"
#include "blocks/coulomb_friction.hpp"
#include "blocks/creep.hpp"
#include "blocks/cross_coupling.hpp"
#include "blocks/cutout.hpp"
#include "blocks/cyclic_error.hpp"
#include "blocks/cyclic_force.hpp"
#include "blocks/dahl_friction.hpp"
#include "blocks/dead_band.hpp"
#include "blocks/dead_time.hpp"
#include "blocks/delay.hpp"
#include "blocks/delay_bool.hpp"
#include "blocks/delay_dint.hpp"
#include "blocks/delay_word.hpp"
#include "blocks/derivative.hpp"
#include "blocks/derivative4.hpp"
#include "blocks/derivative_filtered.hpp"
#include "blocks/down_counter.hpp"
#include "blocks/drift.hpp"
#include "blocks/equal.hpp"
#include "blocks/even_nonlinearity.hpp"
#include "blocks/exponential.hpp"
#include "blocks/falling_edge.hpp"
#include "blocks/gain.hpp"
#include "blocks/gain_drift.hpp"
#include "blocks/greater.hpp"
#include "blocks/greater_equal.hpp"
#include "blocks/held.hpp"
#include "blocks/hold.hpp"
#include "blocks/hyperbolic_tangent.hpp"
#include "blocks/hysteresis_general.hpp"
#include "blocks/hysteresis_ro.hpp"
#include "blocks/hysteresis_ro_inverse.hpp"
#include "blocks/hysteresis_switch.hpp"
#include "blocks/integral.hpp"
#include "blocks/integral_bounded.hpp"
#include "blocks/integral_forward.hpp"
#include "blocks/integral_forward_bounded.hpp"
#include "blocks/lag.hpp"
#include "blocks/lead_lag.hpp"
#include "blocks/less.hpp"
#include "blocks/less_equal.hpp"
#include "blocks/limit.hpp"
#include "blocks/load.hpp"
#include "blocks/load_friction.hpp"
#include "blocks/logarithm.hpp"
#include "blocks/logic_and.hpp"
#include "blocks/logic_not.hpp"
#include "blocks/logic_or.hpp"
#include "blocks/logic_xor.hpp"
#include "blocks/m.hpp"
#include "blocks/m_general.hpp"
#include "blocks/m_inverse.hpp"
#include "blocks/m_table.hpp"
#include "blocks/m_table_inverse.hpp"
#include "blocks/maximum.hpp"
#include "blocks/mem.hpp"
#include "blocks/mem_inverse.hpp"
#include "blocks/minimum.hpp"
#include "blocks/momentum.hpp"
#include "blocks/not_equal.hpp"
#include "blocks/odd_nonlinearity.hpp"
#include "blocks/off_delay.hpp"
#include "blocks/offset.hpp"
#include "blocks/on_delay.hpp"
#include "blocks/periodic_disturbance.hpp"
#include "blocks/periodic_error.hpp"
#include "blocks/pid.hpp"
#include "blocks/power_function.hpp"
#include "blocks/product.hpp"
#include "blocks/pulse_timer.hpp"
#include "blocks/quantizer.hpp"
#include "blocks/quotient.hpp"
#include "blocks/ramp.hpp"
#include "blocks/rate_limit.hpp"
#include "blocks/relaxation.hpp"
#include "blocks/reset_dominant_latch.hpp"
#include "blocks/rising_edge.hpp"
#include "blocks/sample.hpp"
#include "blocks/sample_and_hold.hpp"
#include "blocks/saturating_curve.hpp"
#include "blocks/scheduled_gain.hpp"
#include "blocks/second_order.hpp"
#include "blocks/set_dominant_latch.hpp"
#include "blocks/sign.hpp"
#include "blocks/sine.hpp"
#include "blocks/sine_wave.hpp"
#include "blocks/square_root.hpp"
#include "blocks/step_reference.hpp"
#include "blocks/stribeck_friction.hpp"
#include "blocks/subtract.hpp"
#include "blocks/sum.hpp"
#include "blocks/switch.hpp"
#include "blocks/table.hpp"
#include "blocks/tangent.hpp"
#include "blocks/thermal_drift.hpp"
#include "blocks/triangle_wave.hpp"
#include "blocks/up_counter.hpp"
#include "blocks/up_down_counter.hpp"
#include "blocks/valve_stiction.hpp"
#include "blocks/viscous_friction.hpp"

namespace hysteron {

template <class... Blocks>
struct BlockList {
  static constexpr std::size_t size = sizeof...(Blocks);

  /// Calls visit.template operator()<B>() for each block, in the order of the list.
  template <class Visit>
  static constexpr void for_each(Visit&& visit) {
    (visit.template operator()<Blocks>(), ...);
  }
};

using Catalogue = BlockList<
    // memory: hysteresis and MEM elements
    Branch, Momentum, SlopeM, SlopeMInverse, SlopeMTable, SlopeMTableInverse, Mem, MemInverse, HysteresisRo,
    HysteresisRoInverse, HysteresisGeneral, SlopeMGeneral,
    // arithmetic
    Constant, Gain, Sum, Subtract, Product, Quotient,
    // functions
    Absolute, Sign, Minimum, Maximum, PowerFunction, SquareRoot, Exponential, Logarithm, Sine, Cosine, Tangent,
    Arctangent, HyperbolicTangent,
    // shaping
    Limit, DeadBand, RateLimit, Switch, Table, Quantizer, Backlash, HysteresisSwitch, SampleAndHold,
    // control and references
    Pid, Ramp, StepReference, SineWave, TriangleWave,
    // comparison and logic
    Greater, GreaterEqual, Equal, LessEqual, Less, NotEqual, And, Or, Xor, Not, RisingEdge, FallingEdge,
    SetDominantLatch, ResetDominantLatch,
    // time and counting
    OnDelay, OffDelay, PulseTimer, Blink, UpCounter, DownCounter, UpDownCounter,
    // dynamics
    Derivative, Derivative4, DerivativeFiltered, Integral, IntegralForward, IntegralBounded, IntegralForwardBounded,
    Delay, DelayBool, DelayInt, DelayWord, DeadTime, Lag, LeadLag, SecondOrder,
    // effects: what a machine does and its model does not
    Offset, Drift, ThermalDrift, GainDrift, Creep, Relaxation, CoulombFriction, StribeckFriction, DahlFriction,
    AsymmetricFriction, LoadFriction, ViscousFriction, ValveStiction, Cogging, CyclicForce, PeriodicError, CyclicError,
    EvenNonlinearity, OddNonlinearity, SaturatingCurve, AbsoluteSensor, PeriodicDisturbance, CrossCoupling,
    ScheduledGain, Cutout, Load, Clock, Held,
    // borders between rates
    Sample, Hold>;

}  // namespace hysteron
