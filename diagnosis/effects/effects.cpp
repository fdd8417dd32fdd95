#include "diagnosis/effects/effects.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>

namespace hysteron::diagnosis {
namespace {

/// The role that a description states, of what is no strength. Role::Other where it states none.
Role stated_role(FieldRole role) {
  switch (role) {
    case FieldRole::ReferenceSize:
    case FieldRole::Centre:
      return Role::Reference;
    case FieldRole::Period:
      return Role::Period;
    case FieldRole::Softness:
      return Role::Softness;
    case FieldRole::Instant:
      return Role::Instant;
    default:
      return Role::Other;
  }
}

Role role_of(const Field& field, std::string_view unit, bool strength) {
  if (const Role stated = stated_role(field.role); !strength && stated != Role::Other) {
    return stated;
  }
  if (unit == "s") {
    return Role::Duration;
  }
  if (unit == "Hz") {
    return Role::Frequency;
  }
  if (unit == "1/s") {
    return Role::PerSecond;
  }
  if (unit == "1") {
    return Role::Share;
  }
  if (unit == "'x" || unit == "'y") {
    return Role::Level;
  }
  if (unit == "'x/s") {
    return Role::Rate;
  }
  return Role::Other;
}

/// Parameters that the search may move: real, single, finite or neutral at infinity.
std::vector<EffectParameter> searched(std::span<const Field> fields) {
  std::vector<EffectParameter> result;
  for (const Field& field : fields) {
    if (field.type != Type::Real || field.length > 1 || field.role == FieldRole::StartValue) {
      continue;
    }
    const bool strength = field.has_neutral();
    const Role role = role_of(field, field.unit, strength);
    if (!strength && !std::isfinite(field.preset) && role != Role::Instant) {
      continue;
    }
    result.push_back({.name = std::string(field.name),
                      .field = field,
                      .unit = std::string(field.unit),
                      .role = role,
                      .strength = strength});
  }
  return result;
}

/// Levels in the unit of the block's output, where that is another one than that of its input.
void refer_to_output(const BlockType& block, EffectKind& kind) {
  const auto output = std::ranges::find(block.outputs, kind.output, &Field::name);
  for (EffectParameter& one : kind.parameters) {
    if (one.role == Role::Other && one.strength && output != block.outputs.end() && output->unit == one.unit) {
      one.role = Role::Level;
      kind.of_output = true;
    }
  }
}

bool has_strength(const EffectKind& kind) {
  return std::ranges::any_of(kind.parameters, [](const EffectParameter& one) { return one.strength; });
}

/// A gain beside other strengths belongs to HY_GAIN: a resonance of gain 1 is a resonance, one of gain 2 two effects.
void drop_gains(std::vector<EffectParameter>& parameters) {
  const auto is_gain = [](const EffectParameter& one) { return one.strength && one.field.neutral == 1.0; };
  const auto is_other = [&](const EffectParameter& one) { return one.strength && !is_gain(one); };
  if (std::ranges::any_of(parameters, is_other)) {
    std::erase_if(parameters, is_gain);
  }
}

void add_library(const BlockType& block, std::vector<EffectKind>& kinds) {
  if (!block.about.effect.empty()) {
    EffectKind kind{.id = std::string(block.about.effect), .block = std::string(block.about.name)};
    kind.family = name_of(block.about.family);
    kind.simpler = block.about.simpler;
    kind.untried = block.about.untried;
    kind.of_record = block.about.of_record;
    bool has_input = false;
    for (const Field& input : block.inputs) {
      has_input = has_input || input.name == kind.input;
      if (input.type == Type::Real && input.name != kind.input && input.role != FieldRole::StartValue &&
          input.unit != "'x") {
        kind.auxiliaries.emplace_back(input.name);
        kind.by_velocity = kind.by_velocity || input.unit == "'v";
        kind.fed_back = kind.fed_back || kind.by_velocity || input.unit == "'p";
      }
    }
    kind.parameters = searched(block.params);
    std::ranges::copy_if(block.params, std::back_inserter(kind.choices), &Field::open);
    drop_gains(kind.parameters);
    if (has_input && has_strength(kind)) {
      kinds.push_back(std::move(kind));
    }
  }
  for (const Field& field : block.params) {
    if (field.effect.empty()) {
      continue;
    }
    EffectKind kind{.id = std::string(field.effect),
                    .family = std::string(name_of(field.family)),
                    .block = std::string(block.about.name),
                    .change = block.about.enriches.empty() ? Change::Free : Change::Enrich,
                    .enriches = std::string(block.about.enriches.empty() ? block.about.name : block.about.enriches)};
    const auto all = searched(block.params);
    for (const EffectParameter& one : all) {
      if (one.field.name == field.name || one.field.shapes == field.name) {
        kind.parameters.push_back(one);
      }
    }
    refer_to_output(block, kind);
    if (has_strength(kind)) {
      kinds.push_back(std::move(kind));
    }
  }
}

/// A FUNCTION_BLOCK of the user with (* @effect … *), one LREAL input, one LREAL output and parameters with @neutral.
void add_own(const Definition& definition, std::vector<EffectKind>& kinds) {
  if (definition.effect.empty() || !definition.usable) {
    return;
  }
  EffectKind kind{.id = definition.effect,
                  .family = definition.family.empty() ? definition.effect : definition.family,
                  .block = std::string(definition.block->name.text)};
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  std::vector<Field> parameters;
  for (const Declared& declared : definition.variables) {
    const bool real = declared.field.type == Type::Real;
    if (declared.kind == Declared::Kind::Input && real) {
      inputs.emplace_back(declared.field.name);
    } else if (declared.kind == Declared::Kind::Output && real) {
      outputs.emplace_back(declared.field.name);
    } else if (declared.kind == Declared::Kind::Parameter) {
      parameters.push_back(declared.field);
    }
  }
  if (inputs.empty() || outputs.empty()) {
    return;
  }
  kind.input = inputs.front();
  kind.output = outputs.front();
  kind.auxiliaries.assign(inputs.begin() + 1, inputs.end());
  kind.parameters = searched(parameters);
  if (has_strength(kind)) {
    kinds.push_back(std::move(kind));
  }
}

}  // namespace

const FamilyText* text_of_family(const EffectKind& kind) {
  const auto* const found = std::ranges::find(family_texts, kind.family, &FamilyText::name);
  return found == family_texts.end() ? nullptr : found;
}

std::vector<EffectKind> effect_kinds(const Definitions& definitions) {
  std::vector<EffectKind> kinds;
  for (const BlockType& block : block_types()) {
    add_library(block, kinds);
  }
  for (const Definition& definition : definitions.list) {
    add_own(definition, kinds);
  }
  for (EffectKind& kind : kinds) {
    kind.by_position = std::ranges::count(kind.parameters, Role::Period, &EffectParameter::role) > 0;
    for (EffectParameter& one : kind.parameters) {
      // With a velocity or a position beside it, it is the size of a force.
      if (one.strength && one.role == Role::Level && one.field.neutral == 0.0 && one.field.minimum == 0.0 &&
          kind.auxiliaries.empty()) {
        one.role = one.field.role == FieldRole::Quantum ? Role::Quantum : Role::Gap;
      }
    }
  }
  std::ranges::stable_sort(kinds, {}, &EffectKind::id);
  return kinds;
}

}  // namespace hysteron::diagnosis
