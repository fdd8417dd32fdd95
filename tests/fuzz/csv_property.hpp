// What holds for every text whatever, right or wrong, when it is read as a record.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "records/csv.hpp"
#include "records/read.hpp"
#include "support/diagnostic.hpp"
#include "support/render.hpp"

namespace hysteron::test {

struct ReadingOutcome {
  bool accepted = false;
  std::string flaw{};  ///< what is wrong with the reader or the writer, seen on this text; empty if nothing
};

inline std::string flaw_of_refusal(const InputError& refused, std::string_view text, const std::string& file,
                                   int hundred) {
  if (!refused.diagnostics().has_errors()) {
    return "a refusal without an error";
  }
  for (const Diagnostic& diagnostic : refused.diagnostics().all()) {
    if (diagnostic.number / 100 != hundred) {
      return "a diagnostic with a number of another part";
    }
    if (diagnostic.place.file != file) {
      return "what was written is refused: " + diagnostic.cause;
    }
    if (diagnostic.cause.empty() || diagnostic.mend.empty()) {
      return "a diagnostic without cause or mend";
    }
  }
  Sources sources;
  sources.put(file, text);
  return as_text(refused.diagnostics(), sources).empty() ? "nothing to show" : "";
}

inline std::string flaw_of_record(const records::Record& record) {
  if (record.size() < 2 || !(record.sample_time() > 0.0) || !std::isfinite(record.sample_time())) {
    return "a record without rows or sample time";
  }
  for (const auto& column : record.columns()) {
    if (column.values.size() != record.size()) {
      return "a column of another length";
    }
  }
  const auto written = csv_text(record);
  return csv_text(records::parse_record("again", written)) == written ? ""
                                                                      : "what was written reads back as something else";
}

inline ReadingOutcome read_as_record(std::string_view text) {
  try {
    return {.accepted = true, .flaw = flaw_of_record(records::parse_record("text", std::string(text)))};
  } catch (const InputError& refused) {
    return {.accepted = false, .flaw = flaw_of_refusal(refused, text, "text", 5)};
  }
}

}  // namespace hysteron::test
