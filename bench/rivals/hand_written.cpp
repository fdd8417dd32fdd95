// The step as an engineer writes it.
#include "bench/hand_written.hpp"

#include "bench/rivals/contender.h"

#ifdef WITHOUT_POW
constexpr bool with_pow = false;
#else
constexpr bool with_pow = true;
#endif

static hand_written::Params params;
static hand_written::State state;
static bool reset = false;

extern "C" void contender_reset() {
  state = {};
}

extern "C" void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    output[k] = hand_written::step<with_pow>(params, state, reference[k], reset);
  }
}
