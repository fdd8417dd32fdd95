// A record behind its handle.
#pragma once

#include <memory>
#include <vector>

#include "bindings/c/diagram.hpp"
#include "bindings/c/hysteron.h"
#include "records/record.hpp"

struct hysteron_record {
  hysteron::records::Record record;
};

namespace hysteron::bindings {

/// Copies of records, in the units of a diagram. Says what was converted, which inputs have no column and, with
/// `tell_unused`, which columns drive nothing. Throws InputError where one does not fit.
[[nodiscard]] std::vector<records::Record> in_units_of(const hysteron_diagram& diagram,
                                                       const hysteron_record* const* records, std::size_t count,
                                                       bool tell_unused, Diagnostics& diagnostics, Call& call);

}  // namespace hysteron::bindings
