// What a block of the text declares, as the interface of its POU.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "codegen/backends/plcopen/known_values.hpp"
#include "codegen/backends/plcopen/network.hpp"
#include "codegen/backends/shared/identifiers.hpp"

namespace hysteron::plcopen {

/// What variables are called in the POU, by their names in upper case.
using Names = std::map<std::string, std::string>;

/// Those of the variables of a block: some compiler may keep a name for itself.
[[nodiscard]] Names names_in(const Definition& definition, Identifiers& identifiers);

/// Parameters have their tuned values. Remarks are the annotations, as the text has them.
[[nodiscard]] std::vector<StSection> interface_of(const Definitions& definitions, std::uint32_t index,
                                                  const KnownValues& values, const Names& names,
                                                  const NetworkOptions& options);

}  // namespace hysteron::plcopen
