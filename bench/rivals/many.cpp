// What `hysteron generate --target cpp` writes of the chain that bench/compile.py compiles.
#include "bench/rivals/contender.h"
#include "many.hpp"

static many::Params params;
static many::State state;
static many::In in;

extern "C" void contender_reset() {
  many::reset(params, state);
}

extern "C" void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    in.x = reference[k];
    output[k] = many::step(params, state, in).y;
  }
}
