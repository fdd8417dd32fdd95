// What a value is called that is no port and no state: by the operation whose result it is.
#pragma once

#include <string_view>

#include "codegen/trace/operation.hpp"

namespace hysteron {

/// "sum", "quotient", "is_less".
std::string_view word_for_result(Op op);

}  // namespace hysteron
