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
[[nodiscard]] Quantity quantity_of(std::string_view unit);

/// A friction is a force: on no position, velocity, temperature, and on no number such as a share of power. What
/// repeats over a position acts on a position or on a force.
[[nodiscard]] bool may_act_on(const EffectKind& kind, const Space::Place& place);

/// A curve of its signal alone, and whether a place carries a velocity, or a gain times one: a force that is a curve of
/// a velocity is a friction, and is tried as one.
[[nodiscard]] bool is_static(const EffectKind& kind);
[[nodiscard]] bool carries_velocity(const Space::Place& place, const std::vector<DriverSignal>& drivers);

/// A friction is driven by a velocity, what repeats by a position, a coupling by another column.
[[nodiscard]] bool may_drive(const EffectKind& kind, const DriverSignal& signal, const Space::Place& place);

}  // namespace hysteron::diagnosis
