// What makes sense where: which effects may act on a signal, and which signals may drive them, by units.
#pragma once

#include <string_view>

#include "diagnosis/effects/effects.hpp"
#include "diagnosis/evidence/driver_signals.hpp"
#include "diagnosis/evidence/space.hpp"

namespace hysteron::diagnosis {

/// What a signal may be, by its unit. An angle is a number by its dimension: only its name tells.
struct Quantity {
  bool known = false;
  bool position = false;  ///< a length or an angle
  bool velocity = false;  ///< one of them a second
  bool thermal = false;
  bool number = false;  ///< without dimension, and no angle
};
[[nodiscard]] Quantity quantity_of(std::string_view text);

/// A friction is a force: on no position, velocity, temperature, and on no number such as a share of power. What
/// repeats over a position acts on a position or on a force. A balance is no signal that a part passes on: what has
/// play, bends or is limited is one of its summands. Where a motion is given and a force asked for, as robots are
/// identified, the speed and the acceleration are worked out of the record: no part passes a motion on before its rate
/// is taken, and what a filter closes behind that makes up for the filters by which it was worked out.
[[nodiscard]] bool may_act_on(const EffectKind& kind, const Space::Place& place);

/// Whether an effect adds something to its edge that a regression can find: no gain, which is a matter of calibration;
/// nothing that a logger does, which is looked for in the record itself; no limit on another signal; no friction
/// without a speed, which shows in the shape of an oscillation.
[[nodiscard]] bool is_law(const EffectKind& kind);

/// A load that a friction may grow with: a force, a pressure, an effort; no motion.
[[nodiscard]] bool may_load(const DriverSignal& signal);

/// Whether a place carries a velocity, or a gain times one. Between a speed and its integral nothing can act, and a
/// force that is a function of a speed is a friction: it is tried as one, on the force.
[[nodiscard]] bool carries_velocity(const Space::Place& place, const std::vector<DriverSignal>& drivers);

/// A friction is driven by a velocity, what repeats by a position, a coupling by another column.
[[nodiscard]] bool may_drive(const EffectKind& kind, const DriverSignal& signal, const Space::Place& place);

}  // namespace hysteron::diagnosis
