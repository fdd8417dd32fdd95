// Candidates and sets that a diagram refuses: it is not the user's mistake, and no other one has to go without.
#pragma once

#include "support/diagnostic.hpp"

namespace hysteron::diagnosis {

/// What `make` gives, or an empty one where the diagram refuses it: no starts, a cost of ∞.
template <class Make>
auto unless_refused(const Make& make) -> decltype(make()) {
  try {
    return make();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace hysteron::diagnosis
