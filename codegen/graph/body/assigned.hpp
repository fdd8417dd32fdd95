// Which variables the statements of a unit may write, and what they call more than once.
#pragma once

#include <set>
#include <string>

#include "codegen/graph/body/types.hpp"

namespace hysteron::bodies {

/// Names in upper case, of `A[1].B` the A.
struct Written {
  std::set<std::string> names{};         ///< all that is assigned, counted, taken from an output, or handed to a call
  std::set<std::string> called_again{};  ///< called at two places or more, or in a loop
  std::set<std::string> read{};
  std::set<std::string> assigned{};  ///< of `names` those that a call cannot but change, too
  std::set<std::string> called{};    ///< what may be a FUNCTION
};
Written written_by(const Source& source);

}  // namespace hysteron::bodies
