// What `hysteron generate --target batch` writes: INSTANCES of the feedforward, each with an exponent of its own, over
// one reference, by registers of LANES numbers. Compiled with HYSTERON_BATCH_FAST or not.
#include "bench/rivals/contender.h"
#include "feedforward_batch.hpp"

namespace step = feedforward_batch;

constexpr int packs = (INSTANCES + step::width - 1) / step::width;
static step::Params params[packs];
static step::State states[packs];
static step::In in[packs];
static step::Out out[packs];

extern "C" long contender_instances() {
  return step::lanes_of_processor() >= LANES ? INSTANCES : 0;
}

extern "C" void contender_reset() {
  for (int i = 0; i < INSTANCES; ++i) {
    params[i / step::width].inv.c3.lane[i % step::width] = contender_exponent(i);
  }
  step::reset(packs, params, states);
}

extern "C" void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    for (step::In& one : in) {
      for (double& lane : one.y_ref.lane) {
        lane = reference[k];
      }
    }
    step::step(packs, params, states, in, out, LANES);
    output[k] = out[contender_shown / step::width].u.lane[contender_shown % step::width];
  }
}
