#include "diagnosis/evidence/roles.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "blocks/families.hpp"
#include "codegen/graph/unit.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t metres = 0;
constexpr std::size_t seconds = 2;
constexpr std::size_t kelvins = 4;
constexpr std::size_t celsius = 5;

}  // namespace

Quantity quantity_of(std::string_view text) {
  std::string reason;
  const auto unit = text.empty() ? std::nullopt : units::parse_unit(text, reason);
  if (!unit) {
    return {};
  }
  Quantity result{.known = true};
  bool others = false;
  for (std::size_t i = 0; i < units::dimensions; ++i) {
    others = others || (i != metres && i != seconds && !unit->powers[i].zero());
  }
  const double length = unit->powers[metres].number();
  const double time = unit->powers[seconds].number();
  const bool angle = !unit->powers[units::radians].zero() || !unit->powers[units::cycles].zero();
  const bool travel = !others && (length == 1.0 || (length == 0.0 && angle));
  result.position = travel && time == 0.0;
  result.velocity = travel && time == -1.0;
  result.thermal = !unit->powers[kelvins].zero() || !unit->powers[celsius].zero();
  result.number = !others && length == 0.0 && time == 0.0 && !angle;
  return result;
}

bool may_act_on(const EffectKind& kind, const Space::Place& place) {
  if (kind.of_record && !place.is_port) {
    return false;
  }
  const FamilyText* const family = text_of_family(kind);
  const bool follows = family != nullptr && family->follows;
  if (place.is_differentiated || (place.is_given_motion && !place.is_port && follows)) {
    return false;
  }
  if (place.is_balance && family != nullptr && family->of_a_part) {
    return false;
  }
  const Quantity quantity = quantity_of(place.unit);
  if (kind.by_velocity) {
    return !place.is_integral && !quantity.position && !quantity.velocity && !quantity.thermal && !quantity.number;
  }
  if (kind.by_position) {
    return kind.auxiliaries.empty() ? quantity.position || !quantity.known
                                    : !quantity.velocity && !quantity.thermal && !quantity.number;
  }
  return true;
}

bool is_law(const EffectKind& kind) {
  const auto is_gain = [](const EffectParameter& one) { return one.strength && one.field.neutral == 1.0; };
  const auto is_other = [&](const EffectParameter& one) { return one.strength && !is_gain(one); };
  const auto is_limit = [](const EffectParameter& one) { return one.strength && !std::isfinite(one.field.neutral); };
  return kind.change == Change::Insert && find_block_type(kind.block) != nullptr &&
         kind.family != name_of(Family::Logging) && std::ranges::any_of(kind.parameters, is_other) &&
         (kind.auxiliaries.empty() || std::ranges::none_of(kind.parameters, is_limit)) &&
         (kind.by_velocity || kind.family != name_of(Family::DryFriction));
}

bool may_load(const DriverSignal& signal) {
  const Quantity quantity = quantity_of(signal.unit);
  return !signal.is_rate && !signal.is_follower && !quantity.position && !quantity.velocity && !quantity.thermal &&
         (quantity.known || signal.source == DriverSignal::Source::Input);
}

bool carries_velocity(const Space::Place& place, const std::vector<DriverSignal>& drivers) {
  constexpr double proportional = 0.9999;
  if (place.is_of_velocity || quantity_of(place.unit).velocity) {
    return true;
  }
  return std::ranges::any_of(drivers, [&](const DriverSignal& driver) {
    if (!quantity_of(driver.unit).velocity) {
      return false;
    }
    double both = 0.0;
    double carried = 0.0;
    double velocity = 0.0;
    for (std::size_t e = 0; e < place.carried.size(); ++e) {
      for (std::size_t k = 0; k < place.carried[e].size(); ++k) {
        both += place.carried[e][k] * driver.values[e][k];
        carried += place.carried[e][k] * place.carried[e][k];
        velocity += driver.values[e][k] * driver.values[e][k];
      }
    }
    return both * both > proportional * carried * velocity;
  });
}

bool may_drive(const EffectKind& kind, const DriverSignal& signal, const Space::Place& place) {
  const Quantity quantity = quantity_of(signal.unit);
  // Without units, a motion is what the machine does, not what drives it.
  const bool moves = signal.source == DriverSignal::Source::Output || signal.source == DriverSignal::Source::Wire;
  if (kind.by_velocity) {
    // In proportion to a slope that looks ahead, any linear dynamics is a friction.
    if (!kind.slides() && signal.is_rate) {
      return false;
    }
    return quantity.velocity || (!quantity.known && moves && !quantity_of(signal.of_unit).known);
  }
  if (kind.by_position) {
    return !signal.is_rate && signal.name != place.edge.name && (quantity.position || (!quantity.known && moves));
  }
  // What drives the diagram is there already, whatever way it takes: the linear part of that is no coupling.
  return !signal.is_rate && signal.source == DriverSignal::Source::Column && !signal.is_follower;
}

}  // namespace hysteron::diagnosis
