/* The model of an output-error fit as rivals call it: what `hysteron generate --target c` writes, compiled. With PLANT
   that of example 4, with C1, C2, C3 and Y0; else bench/diagnosis/machine.st with six parameters. */
#ifdef PLANT
#include "plant.c"
#define NAMED(name) plant_##name
#else
#include "machine.c"
#define NAMED(name) machine_##name
#endif

void simulate(const double* theta, const double* u, double* y, long samples) {
  NAMED(params) params;
  NAMED(state) state;
  NAMED(in) in;
  NAMED(out) out;
  NAMED(defaults)(&params, &in);
#ifdef PLANT
  params.hyst.c1 = theta[0];
  params.hyst.c2 = theta[1];
  params.hyst.c3 = theta[2];
  params.hyst.y0 = theta[3];
#else
  params.amplifier.t1 = theta[0];
  params.gear.width = theta[1];
  params.stage.k = theta[2];
  params.stage.t = theta[3];
  params.creep.gain = theta[4];
  params.creep.t_onset = theta[5];
#endif
  NAMED(reset)(&state, &params);
  for (long k = 0; k < samples; ++k) {
    in.u = u[k];
    NAMED(step)(&params, &state, &in, &out);
    y[k] = out.y;
  }
}
