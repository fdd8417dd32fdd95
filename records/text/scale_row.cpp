#include "records/text/scale_row.hpp"

#include <fmt/format.h>

#include "records/text/cell_value.hpp"
#include "support/names.hpp"

namespace hysteron::records {

namespace {

std::string_view without_colon(std::string_view key) {
  return key.ends_with(':') ? key.substr(0, key.size() - 1) : key;
}

bool is_key_of_factor(std::string_view key) {
  return is_one_of(without_colon(key), {"scale", "scaling", "scale factor", "scalefactor", "unitscalefactor", "factor",
                                        "multiplier", "gain", "slope", "faktor", "skalierung"});
}

}  // namespace

bool is_key_of_scale(std::string_view key) {
  return is_key_of_factor(key) || is_one_of(without_colon(key), {"offset", "intercept"});
}

std::optional<std::string> note_of_scale(std::string_view key, std::string_view cell, std::string_view column) {
  const CellValue value = cell_value(cell);
  if (!is_key_of_scale(key) || value.kind != CellKind::Number || value.number == (is_key_of_factor(key) ? 1.0 : 0.0)) {
    return std::nullopt;
  }
  return fmt::format("the head states {} {} of column {}, whose numbers are taken as they stand", without_colon(key),
                     cell, column);
}

}  // namespace hysteron::records
