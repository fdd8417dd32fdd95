// INSTANCES of the feedforward as an engineer writes them for a compiler that makes vectors of loops: a structure of
// arrays, no branch, no compensated sum. For `-Ofast -march=native`, with which GCC calls libmvec's pow.
#include <cmath>

#include "bench/rivals/contender.h"

static double c1[INSTANCES], c2[INSTANCES], c3[INSTANCES];
static double momentum[INSTANCES], control[INSTANCES], heading[INSTANCES], previous[INSTANCES];
static double references[INSTANCES];
static bool started;

extern "C" long contender_instances() {
  return INSTANCES;
}

extern "C" void contender_reset() {
  for (int i = 0; i < INSTANCES; ++i) {
    c1[i] = 0.05;
    c2[i] = 0.0013;
    c3[i] = contender_exponent(i);
    momentum[i] = control[i] = heading[i] = previous[i] = 0.0;
  }
  started = false;
}

static void step() {
  constexpr double ts = 50e-6;
  const double moving = started ? 1.0 : 0.0;
  started = true;
#pragma GCC ivdep
  for (int i = 0; i < INSTANCES; ++i) {
    const double ahead = moving * (references[i] - previous[i]);
    const double kept = heading[i] * ahead < 0.0 ? 0.0 : 1.0;
    heading[i] = ahead > 0.0 ? 1.0 : ahead < 0.0 ? -1.0 : heading[i];
    previous[i] = references[i];
    const double p = kept * momentum[i];
    const double slope = c1[i] + c2[i] * std::pow(p, c3[i]);     // (17)
    const double rate = slope > 0.0 ? ahead / ts / slope : 0.0;  // (15)
    momentum[i] = p + std::fabs(rate) * ts;                      // (16)
    control[i] += rate * ts;
  }
}

extern "C" void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    for (double& one : references) {
      one = reference[k];
    }
    step();
    output[k] = control[contender_shown];
  }
}
