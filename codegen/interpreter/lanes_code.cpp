// The blocks over eight lanes, compiled for registers of 256 bits.
#define HY_RUN [[gnu::flatten]]
#include "codegen/interpreter/lanes.hpp"
#include "codegen/interpreter/run_table.hpp"

template const hysteron::RunTable<hysteron::Lanes>& hysteron::run_table<hysteron::Lanes>();
