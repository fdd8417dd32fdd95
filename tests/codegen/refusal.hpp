// What the compiler says of a text that it refuses.
#pragma once

#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::testing {

/// Empty where it accepts the text.
inline std::vector<Diagnostic> refusals(const std::string& text) {
  try {
    (void)compile_text(text);
    return {};
  } catch (const InputError& refused) {
    return refused.diagnostics().all();
  }
}

}  // namespace hysteron::testing
