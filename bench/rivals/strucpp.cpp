// The Structured Text of `hysteron generate --target st`, as STruC++ writes it in C++. BLOCK, INPUT and OUTPUT are its
// names.
#include "bench/rivals/contender.h"
#include "block.hpp"

static strucpp::BLOCK block;

extern "C" void contender_reset() {
  block = strucpp::BLOCK();
}

extern "C" void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    block.INPUT = reference[k];
    block();
    output[k] = static_cast<double>(block.OUTPUT);
  }
}
