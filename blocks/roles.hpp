// The roles of fields: what a number is for, where its type and unit do not tell. A role is said in the description of
// the field, or by @role in a diagram; no name decides anything.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace hysteron {

enum class FieldRole : std::uint8_t {
  Number,  ///< like any other; its unit says what it measures
  // of parameters, in the library and in a diagram
  StartValue,
  ReferenceSize,
  Centre,
  Period,
  Softness,
  Instant,
  Quantum,
  DeadTime,
  // of the library's own fields
  LowerBound,
  UpperBound,
  PointCount,
  Rate,
  PastInput,
  PastInputs
};

struct RoleText {
  FieldRole role;
  std::string_view name;
  std::string_view meaning;
  bool stated;  ///< by @role, of a parameter of a diagram
};

inline constexpr std::array role_texts{
    RoleText{FieldRole::Number, "number", "a number like any other", false},
    RoleText{FieldRole::StartValue, "start", "what a record begins with, or when: no number of the machine", true},
    RoleText{FieldRole::ReferenceSize, "reference_size", "a size that others are relative to", true},
    RoleText{FieldRole::Centre, "centre", "the place that distances are counted from", true},
    RoleText{FieldRole::Period, "period", "what repeats itself over a position does so with it", true},
    RoleText{FieldRole::Softness, "softness", "how far an edge is rounded", true},
    RoleText{FieldRole::Instant, "instant", "a time since the start at which something happens", true},
    RoleText{FieldRole::Quantum, "quantum", "the step between values that can occur", true},
    RoleText{FieldRole::DeadTime, "dead_time", "a time by which a signal is late", true},
    RoleText{FieldRole::LowerBound, "lower_bound", "not above the upper one", false},
    RoleText{FieldRole::UpperBound, "upper_bound", "not below the lower one", false},
    RoleText{FieldRole::PointCount, "point_count", "of a table, whose first array rises", false},
    RoleText{FieldRole::Rate, "rate", "rate of change of the output, of a lag's or of a mass on a spring's", false},
    RoleText{FieldRole::PastInput, "past_input", "the input one sample ago", false},
    RoleText{FieldRole::PastInputs, "past_inputs", "as much of the past as the block holds", false}};

constexpr const RoleText& text_of(FieldRole role) {
  return *std::ranges::find(role_texts, role, &RoleText::role);
}

}  // namespace hysteron
