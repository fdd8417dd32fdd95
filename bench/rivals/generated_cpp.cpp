// What `hysteron generate --target cpp` writes.
#include "bench/rivals/contender.h"
#include "feedforward.hpp"

static feedforward::Params params;
static feedforward::State state;
static feedforward::In in;

extern "C" void contender_reset() {
  feedforward::reset(params, state);
}

extern "C" void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    in.y_ref = reference[k];
    output[k] = feedforward::step(params, state, in).u;
  }
}
