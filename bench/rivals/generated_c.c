/* What `hysteron generate --target c` writes. It is one translation unit with its caller here, as each of the others
 * is. */
#include "bench/rivals/contender.h"
#include "feedforward.c"

static feedforward_params params;
static feedforward_state state;
static feedforward_in in;

void contender_reset(void) {
  feedforward_defaults(&params, &in);
  feedforward_reset(&state, &params);
}

void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    feedforward_out out;
    in.y_ref = reference[k];
    feedforward_step(&params, &state, &in, &out);
    output[k] = out.u;
  }
}
