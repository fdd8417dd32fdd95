// Whether a feedforward can take an effect back, and why.
#pragma once

#include <span>
#include <string_view>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis {

struct InverseOfEffect {
  std::string_view effect{};
  Inverse inverse = Inverse::None;
  std::string_view reason{};
};

/// All effects of the library, sorted by identifier.
[[nodiscard]] std::span<const InverseOfEffect> inverses();

/// Of one effect; of one that the library does not have, None.
[[nodiscard]] InverseOfEffect inverse_of(std::string_view effect);

}  // namespace hysteron::diagnosis
