// What a reader says of a text that it refuses.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "records/read.hpp"
#include "support/diagnostic.hpp"
#include "support/render.hpp"

namespace hysteron::records {

inline Diagnostics refusals_of(std::string_view csv) {
  try {
    const Record record = parse_record("log.csv", std::string(csv));
    for (const Record::Unreadable& one : record.unreadable()) {
      (void)record.column(one.name);  // a fault of a column is told to those who ask for it
    }
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
