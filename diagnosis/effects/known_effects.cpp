#include "diagnosis/effects/known_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "diagnosis/effects/effects.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::diagnosis {

void refuse_undiagnosable(const std::vector<std::string>& wanted, const Program& program) {
  refuse_fmu(program.graph, "a diagnosis tries effects within a plant, and an FMU shows nothing of its inside",
             "fit its parameters with `hysteron tune`; or write the plant as a diagram, and diagnose that.");
  std::vector<std::string> known{"glitches"};
  Diagnostics ignored;  // the file compiles
  for (const EffectKind& kind : effect_kinds(define(program.graph.source, ignored))) {
    if (kind.id != known.back()) {
      known.push_back(kind.id);
    }
  }
  std::ranges::sort(known);
  for (const std::string& effect : wanted) {
    if (std::ranges::find(known, effect) == known.end()) {
      const std::string_view near = nearest_name(effect, known);
      throw InputError(error::bad_usage, {}, fmt::format("There is no effect {}.", effect),
                       near.empty() ? fmt::format("the effects are {}.", fmt::join(known, ", "))
                                    : fmt::format("did you mean {}?", near));
    }
  }
}

std::string family_of(const std::string& effect, const Program& program) {
  Diagnostics ignored;  // the file compiles
  const std::vector<EffectKind> kinds = effect_kinds(define(program.graph.source, ignored));
  const auto found = std::ranges::find(kinds, effect, &EffectKind::id);
  return found == kinds.end() ? effect : found->family;
}

}  // namespace hysteron::diagnosis
