// What tuned parameter files have in common, whatever they were tuned for.
#pragma once

#include <cstddef>
#include <string_view>

#include "codegen/graph/graph.hpp"
#include "codegen/parameters/parameter_file.hpp"

namespace hysteron {

/// What the headings of tuned files begin with, and are known by when a file is tuned again: to records, for a goal.
inline constexpr std::string_view tuned_to = "Fitted by hysteron tune to ";
inline constexpr std::string_view tuned_for = "Tuned by hysteron tune for ";

/// Gives an element of a parameter its value, in place of one that the file has.
void set_tuned(parameters::ParameterFile& file, const Parameter& parameter, std::size_t element, double value);

/// Takes the headings of earlier tunings out of the comments.
void erase_headings(parameters::ParameterFile& file);

}  // namespace hysteron
