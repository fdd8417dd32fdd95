// What the reader of parameter files says of a text that it refuses.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "codegen/parameters/parameter_file.hpp"
#include "support/diagnostic.hpp"
#include "support/render.hpp"

namespace hysteron::parameters {

inline Diagnostics refusals_of(std::string_view toml) {
  try {
    (void)parse_parameter_file("plant.toml", toml);
  } catch (const InputError& refused) {
    return refused.diagnostics();
  }
  throw std::runtime_error("the text was accepted: " + std::string(toml.substr(0, 200)));
}

/// The first diagnostic as a person sees it: place, cause, line, caret, mend.
inline std::string refusal_of(std::string_view toml) {
  Sources sources;
  sources.put("plant.toml", toml);
  return as_text(refusals_of(toml).all().front(), sources);
}

}  // namespace hysteron::parameters
