// The blocks with Dual<7, 8>, compiled for registers of 512 bits: value and derivatives are one of them.
#include "codegen/interpreter/run_table.hpp"
#include "tuning/dual.hpp"

template const hysteron::RunTable<hysteron::Dual<7, 8>>& hysteron::run_table<hysteron::Dual<7, 8>>();
