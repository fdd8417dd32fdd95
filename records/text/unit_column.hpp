// The unit of a signal in a column of its own, with the same word in each row: U, U_unit.
#pragma once

#include <string_view>

#include "records/table.hpp"

namespace hysteron::records {

/// Whether a column is called so: U_unit, U unit, Unit, Einheit.
[[nodiscard]] bool names_units(std::string_view column);

/// Gives signals without a unit the one that such a column beside them states, and notes it. Where that column has two
/// units, the signal is at fault.
void take_units_beside(Table& table);

}  // namespace hysteron::records
