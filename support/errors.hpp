// The numbers of all diagnostics and their titles. Each has a page docs/errors/HYnnn.md with a failing text and its
// mend. 1xx syntax, 2xx names, types and wires, 3xx units, 4xx loops, rates and scheduling, 5xx records, 6xx
// parameter files, 7xx tuning, tests and the command line.
#pragma once

#include <array>
#include <string_view>

namespace hysteron {

struct ErrorTitle {
  int number;
  std::string_view title;
};

namespace error {
inline constexpr int unreadable_file = 100;
inline constexpr int unknown_block = 201;
inline constexpr int unknown_pin = 202;
inline constexpr int unknown_name = 203;
inline constexpr int unconnected_input = 204;
inline constexpr int double_drive = 205;
inline constexpr int undriven_output = 206;
inline constexpr int type_mismatch = 207;
inline constexpr int duplicate_name = 208;
inline constexpr int reserved_name = 209;
inline constexpr int bad_annotation = 210;
inline constexpr int uncalled_instance = 211;
inline constexpr int unknown_function = 212;
inline constexpr int recursive_block = 213;
inline constexpr int parameter_out_of_range = 214;
inline constexpr int ambiguous_top = 215;
inline constexpr int unit_mismatch = 301;
inline constexpr int unknown_unit = 302;
inline constexpr int algebraic_loop = 401;
inline constexpr int hidden_delay = 402;
inline constexpr int rate_mismatch = 403;
inline constexpr int missing_sample_time = 404;
}  // namespace error

inline constexpr std::array error_titles{
    ErrorTitle{error::unreadable_file, "File cannot be read"},
    ErrorTitle{error::unknown_block, "Unknown block"},
    ErrorTitle{error::unknown_pin, "Unknown pin"},
    ErrorTitle{error::unknown_name, "Unknown name"},
    ErrorTitle{error::unconnected_input, "Unconnected input without a default"},
    ErrorTitle{error::double_drive, "Driven twice"},
    ErrorTitle{error::undriven_output, "Output or variable that nothing drives"},
    ErrorTitle{error::type_mismatch, "Types do not match"},
    ErrorTitle{error::duplicate_name, "Name declared twice"},
    ErrorTitle{error::reserved_name, "Reserved name"},
    ErrorTitle{error::bad_annotation, "Bad annotation"},
    ErrorTitle{error::uncalled_instance, "Instance that is never called"},
    ErrorTitle{error::unknown_function, "Unknown function or wrong arguments"},
    ErrorTitle{error::recursive_block, "Block that contains itself"},
    ErrorTitle{error::parameter_out_of_range, "Parameter out of its range"},
    ErrorTitle{error::ambiguous_top, "No single top block"},
    ErrorTitle{error::unit_mismatch, "Units do not match"},
    ErrorTitle{error::unknown_unit, "Unknown unit"},
    ErrorTitle{error::algebraic_loop, "Algebraic loop"},
    ErrorTitle{error::hidden_delay, "Hidden delay"},
    ErrorTitle{error::rate_mismatch, "Wire between two rates"},
    ErrorTitle{error::missing_sample_time, "No sample time"},
};

}  // namespace hysteron
