// The interpreter with dual scalars, compiled in machine_dual.cpp alone.
#pragma once

#include <cstddef>

#include "codegen/interpreter/machine.hpp"
#include "tuning/dual.hpp"

namespace hysteron {

/// The most derivatives that a machine carries at once.
inline constexpr std::size_t most_derivatives = 7;

extern template class Machine<Dual<3>>;
extern template class Machine<Dual<5>>;
extern template class Machine<Dual<static_cast<int>(most_derivatives)>>;

}  // namespace hysteron
