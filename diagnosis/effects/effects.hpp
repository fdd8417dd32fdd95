// The effects that are tried: every block with an effect and a neutral setting, from the catalogue and from the user's
// own file, and what the search needs to know of their parameters.
//
// Nothing here names a block or a parameter. What a parameter is follows from its description: neutral or not, its
// role, and its unit relative to the signal ('x), which says what a sensible size is.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "blocks/families.hpp"
#include "codegen/graph/definition.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::diagnosis {

/// What a parameter measures, and so on which grid it is searched.
enum class Role : std::uint8_t {
  Level,      ///< in the unit of the signal
  Gap,        ///< likewise, a width: nothing at 0, never negative, and its place on the signal counts
  Quantum,    ///< a gap that comes again and again over the signal, as a period does
  Rate,       ///< in that unit a second
  Duration,   ///< seconds
  Instant,    ///< seconds since the start: a default of 0 that is not neutral, or of ∞ for an end that need not come
  Frequency,  ///< of an oscillation, Hz
  Period,     ///< in a position: of the signal or of an auxiliary input
  Share,      ///< dimensionless
  Softness,   ///< of edges: no start depends on it
  PerSecond,  ///< share a second
  Reference,  ///< a size that others are relative to: set from the signal, not fitted
  Other
};

/// Whether a parameter of this role is a gap in the signal, that comes once or again and again.
constexpr bool is_gap(Role role) {
  return role == Role::Gap || role == Role::Quantum;
}

struct EffectParameter {
  std::string name{};  ///< its own copy: of a user's block the field's name lies in a text that may be gone
  Field field{};
  std::string unit{};  ///< as declared
  Role role = Role::Other;
  bool strength = false;  ///< neutral at field.neutral; else a shape, without meaning while all strengths are neutral

  /// Of a friction: how far it gives before it slides, a length where its velocity has that of a length.
  [[nodiscard]] bool is_travel() const { return unit == "'v*s"; }
};

/// How the diagram is changed.
enum class Change : std::uint8_t {
  Insert,  ///< the block goes onto an edge
  Enrich,  ///< an instance gets a richer block
  Free     ///< a parameter that the diagram has is moved from its neutral setting
};

struct EffectKind {
  std::string id{};      ///< creep
  std::string family{};  ///< slow_memory; of an effect of the user's own that states none, its id
  std::string block{};   ///< HY_CREEP
  Change change = Change::Insert;
  std::string simpler{};  ///< the effect with fewer parameters that may be meant where this one was found
  std::string input = "XIN";
  std::string output = "XOUT";
  std::string enriches{};                     ///< Enrich: the block that it can stand for; Free: the block itself
  std::vector<EffectParameter> parameters{};  ///< those that are searched
  std::vector<Field> choices{};               ///< of what was before the record: tried both ways
  std::vector<std::string> auxiliaries{};     ///< further LREAL inputs, to be wired: V, POS, Z
  std::string untried{};                      ///< why it is tried only where it is asked for; empty: it is tried
  bool of_output = false;                     ///< its levels are those of the block's output, not of its input
  bool fed_back = false;                      ///< they are a velocity or position that what the effect changes drives
  bool by_velocity = false;                   ///< and it is a velocity
  bool of_record = false;                     ///< it acts at the ports of the whole diagram
  bool by_position = false;                   ///< periodic in a position: the auxiliary, or the signal itself

  /// Whether it is a dry friction, which holds at rest: it has a travel from there to sliding.
  [[nodiscard]] bool slides() const { return std::ranges::any_of(parameters, &EffectParameter::is_travel); }
};

/// What its family is; null where the effect is one by itself.
[[nodiscard]] const FamilyText* text_of_family(const EffectKind& kind);

/// Those of the catalogue and of the definitions of a file, each with at least one strength, sorted by identifier.
[[nodiscard]] std::vector<EffectKind> effect_kinds(const Definitions& definitions);

}  // namespace hysteron::diagnosis
