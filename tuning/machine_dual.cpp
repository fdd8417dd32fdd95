// The interpreter with dual scalars of 3, 5 and 7 derivatives: with its value each is whole pairs of numbers. More
// parameters take several passes.
#include "codegen/interpreter/machine_impl.hpp"
#include "tuning/dual.hpp"

template class hysteron::Machine<hysteron::Dual<3>>;
template class hysteron::Machine<hysteron::Dual<5>>;
template class hysteron::Machine<hysteron::Dual<7>>;
