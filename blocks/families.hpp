// Families of effects: what a record can tell before it tells which member it is. A Coulomb friction and a Stribeck
// friction are both dry friction; a creep and a relaxation are both a slow memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace hysteron {

enum class Family : std::uint8_t {
  None,
  DryFriction,
  ViscousFriction,
  Play,
  Hysteresis,
  SlowMemory,
  SlowChange,
  LinearDynamics,
  StaticCurve,
  RateLimit,
  PeriodicOverPosition,
  PeriodicInTime,
  Logging,
  Coupling,
  Offset
};

struct FamilyText {
  Family family;
  std::string_view name;  ///< as in @family and in reports
  std::string_view meaning;
  bool of_a_part = false;  ///< done by one part to what it passes on, and never to a balance of several
  bool follows = false;    ///< a filter of its input's past does it
  bool of_a_port = false;  ///< done where numbers come in and go out, and never between two parts of the machine
};

inline constexpr std::array family_texts{
    FamilyText{Family::DryFriction, "dry_friction",
               "a force that turns with the direction of the motion, not its speed"},
    FamilyText{Family::ViscousFriction, "viscous_friction", "a force that grows with the speed"},
    FamilyText{Family::Play, "play", "a gap that the motion crosses before anything follows", true},
    FamilyText{Family::Hysteresis, "hysteresis", "a loop whose memory is the input's turning points, at any rate",
               true},
    FamilyText{.family = Family::SlowMemory,
               .name = "slow_memory",
               .meaning = "what follows its input over seconds or hours: creep, relaxation",
               .follows = true},
    FamilyText{Family::SlowChange, "slow_change",
               "what changes with the time since the start, whatever the machine does"},
    FamilyText{.family = Family::LinearDynamics,
               .name = "linear_dynamics",
               .meaning = "what a linear filter does: gain, delay, lag, resonance",
               .follows = true},
    FamilyText{Family::StaticCurve, "static_curve", "a curve over the present value: limit, dead zone, bend", true},
    FamilyText{Family::RateLimit, "rate_limit", "a bound on the rate of change", true},
    FamilyText{Family::PeriodicOverPosition, "periodic_over_position", "what repeats itself over a position"},
    FamilyText{Family::PeriodicInTime, "periodic_in_time",
               "what repeats itself with the time, whatever the machine does"},
    FamilyText{.family = Family::Logging,
               .name = "logging",
               .meaning = "what converters, clocks and loggers do to values and to their times",
               .of_a_port = true},
    FamilyText{Family::Coupling, "coupling", "what a signal from elsewhere adds or changes"},
    FamilyText{Family::Offset, "offset", "a constant that is added"}};

constexpr std::string_view name_of(Family family) {
  const auto* const found = std::ranges::find(family_texts, family, &FamilyText::family);
  return found == family_texts.end() ? std::string_view() : found->name;
}

}  // namespace hysteron
