#include "diagnosis/effects/known_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "codegen/graph/definition.hpp"
#include "diagnosis/effects/effects.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::diagnosis {

void refuse_undiagnosable(const std::vector<std::string>& wanted, const Program& program) {
  std::vector<std::string> known{"glitches"};
  for (const auto& [effect, family] : families_by_effect(program)) {
    known.push_back(effect);
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

std::map<std::string, std::string> families_by_effect(const Program& program) {
  Diagnostics ignored;  // the file compiles
  std::map<std::string, std::string> families;
  for (const EffectKind& kind : effect_kinds(define(program.graph.source, ignored))) {
    families.emplace(kind.id, kind.family);
  }
  return families;
}

}  // namespace hysteron::diagnosis
