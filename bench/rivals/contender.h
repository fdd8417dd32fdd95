// What a contender for the step is: a library with these functions. bench/step.py and bench/batch.py compile one for
// each, and hysteron_bench loads and times them (bench/contender_bench.cpp).
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

/// Begins anew.
void contender_reset(void);

/// One step a sample, on from where the last call ended. The output is that of one instance, with the exponent 0.7.
void contender_run(const double* reference, double* output, long samples);

/// How many instances take each step; 0 where this processor cannot. A library without this function has one.
long contender_instances(void);

#ifdef __cplusplus
}
#endif

enum { contender_shown = 50 };

/// The exponents of a batch: 0.7 at the instance that is shown.
static inline double contender_exponent(int instance) {
  return 0.7 + 0.002 * ((instance % 128) - contender_shown);
}
