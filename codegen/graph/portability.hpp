// What is right here and means something else in another IEC compiler (HY217): the table, and the check over a text.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "codegen/graph/definition.hpp"

namespace hysteron {

/// One construct that compilers in use read differently. docs/reference/portability.md shows the same rows.
struct OtherMeaning {
  std::string_view construct;  ///< an example of it
  std::string_view here;       ///< what it means in Hysteron
  std::string_view elsewhere;  ///< what it means in other compilers, each by its name
  std::string_view portable;   ///< what means the same everywhere
};

/// All of them, in the order of the page.
std::span<const OtherMeaning> other_meanings();

/// Warns of what a definition writes that has another meaning elsewhere. Expects a definition without errors. Where a
/// value at run time decides, it warns unless the text excludes that value.
void check_portability(const Definitions& definitions, std::uint32_t definition, Diagnostics& diagnostics);

}  // namespace hysteron
