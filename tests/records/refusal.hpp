// What a reader says of a text that it refuses.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "records/csv.hpp"
#include "support/diagnostic.hpp"
#include "support/render.hpp"

namespace hysteron::records {

inline Diagnostics refusals_of(std::string_view csv) {
  try {
    (void)parse_csv("log.csv", std::string(csv));
  } catch (const InputError& refused) {
    return refused.diagnostics();
  }
  throw std::runtime_error("the text was accepted: " + std::string(csv.substr(0, 200)));
}

/// The first diagnostic as a person sees it: place, cause, line, caret, mend.
inline std::string refusal_of(std::string_view csv) {
  Sources sources;
  sources.put("log.csv", csv);
  return as_text(refusals_of(csv).all().front(), sources);
}

}  // namespace hysteron::records
