// A program and the errors of a run file for it, for tests of the reader.
#pragma once

#include <string>
#include <string_view>

#include "runtime/config/run_config.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {

inline ProgramShape plant() {
  ProgramShape shape;
  shape.name = "PLANT";
  shape.period = 1'000'000;
  shape.inputs = {{.name = "X"}, {.name = "Z"}};
  shape.outputs = {{.name = "Y", .low = -10.0, .high = 10.0}};
  return shape;
}

inline ProgramShape plant_of_two() {
  ProgramShape shape = plant();
  shape.outputs.push_back({.name = "W"});
  return shape;
}

/// Number, line and column of every error.
inline std::string errors_of(std::string_view text, const ProgramShape& shape = plant()) {
  std::string list;
  try {
    (void)parse_run_config("RUN.toml", text, shape);
  } catch (const InputError& refused) {
    for (const Diagnostic& one : refused.diagnostics().all()) {
      if (one.severity != Severity::Error) {
        continue;
      }
      list += std::to_string(one.number) + "@" + std::to_string(one.place.line) + ":" +
              std::to_string(one.place.column) + " ";
    }
  }
  return list;
}

}  // namespace hysteron::runtime
