// Columns whose unit has a number before it, as drives write it: [0.1 A], [1e-3 V].
#pragma once

#include "records/table.hpp"

namespace hysteron::records {

/// Brings columns in a tenth, a hundredth, … of a unit to the unit, which is said. [10 V] could be a range, and a factor
/// without a unit, (x1000), could be done already: such a column is refused to those who ask for it.
void take_scaled_units(Table& table);

}  // namespace hysteron::records
