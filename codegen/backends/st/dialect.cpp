#include "codegen/backends/st/dialect.hpp"

#include <array>

#include "support/names.hpp"

namespace hysteron {
namespace {

using StShape = StDialect::Shape;

constexpr std::array st_dialects{
    StDialect{.name = "portable", .extension = ".st", .small_literals = true},
    StDialect{.name = "codesys", .extension = ".st", .shape = StShape::TwoPanes},
    StDialect{.name = "twincat", .extension = ".TcPOU", .shape = StShape::Object},
    StDialect{.name = "siemens-scl",
              .extension = ".scl",
              .shape = StShape::Source,
              .local_prefix = "#",
              .named_arguments = true,
              .power_operator = true,
              .temporary_section = true,
              .longest_name = 100},  // of 125
};

}  // namespace

std::optional<StDialect> st_dialect(std::string_view name) {
  for (const StDialect& dialect : st_dialects) {
    if (equal_ignoring_case(dialect.name, name)) {
      return dialect;
    }
  }
  return std::nullopt;
}

std::string_view st_dialect_names() {
  return "portable, codesys, twincat, siemens-scl";
}

}  // namespace hysteron
