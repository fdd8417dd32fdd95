// What holds for every text whatever, right or wrong, when it is read as a parameter file.
#pragma once

#include <string>
#include <string_view>

#include "codegen/parameters/parameter_file.hpp"
#include "tests/fuzz/csv_property.hpp"

namespace hysteron::test {

inline ReadingOutcome read_as_parameters(std::string_view text) {
  try {
    const auto written = parameters::parameter_text(parameters::parse_parameter_file("text", text));
    const auto again = parameters::parameter_text(parameters::parse_parameter_file("again", written));
    return {.accepted = true, .flaw = again == written ? "" : "what was written reads back as something else"};
  } catch (const InputError& refused) {
    return {.accepted = false, .flaw = flaw_of_refusal(refused, text, "text", 6)};
  }
}

}  // namespace hysteron::test
