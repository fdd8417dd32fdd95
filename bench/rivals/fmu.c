/* An FMU of ours through the functions of FMI 3.0, as an importer calls them: an input is set, a step is done, an
   output is read. FMU_PERIOD and FMU_TOKEN_OF_BENCH are given by bench/step.py. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bench/rivals/contender.h"

void* fmi3InstantiateCoSimulation(const char*, const char*, const char*, bool, bool, bool, bool, const uint32_t*,
                                  size_t, void*, void*, void*);
int fmi3EnterInitializationMode(void*, bool, double, double, bool, double);
int fmi3ExitInitializationMode(void*);
int fmi3SetFloat64(void*, const uint32_t*, size_t, const double*, size_t);
int fmi3GetFloat64(void*, const uint32_t*, size_t, double*, size_t);
int fmi3DoStep(void*, double, double, bool, bool*, bool*, bool*, double*);
void fmi3FreeInstance(void*);

static void* instance;
static long steps;

void contender_reset(void) {
  if (instance != NULL) {
    fmi3FreeInstance(instance);
  }
  instance = fmi3InstantiateCoSimulation("bench", FMU_TOKEN_OF_BENCH, "", false, false, false, false, NULL, 0, NULL,
                                         NULL, NULL);
  fmi3EnterInitializationMode(instance, false, 0.0, 0.0, false, 0.0);
  fmi3ExitInitializationMode(instance);
  steps = 0;
}

void contender_run(const double* reference, double* output, long samples) {
  const uint32_t input = FMU_INPUT;
  const uint32_t result = FMU_OUTPUT;
  for (long k = 0; k < samples; ++k) {
    bool event = false;
    bool terminate = false;
    bool early = false;
    double time = 0.0;
    fmi3SetFloat64(instance, &input, 1, &reference[k], 1);
    fmi3DoStep(instance, (double)steps * FMU_PERIOD, FMU_PERIOD, true, &event, &terminate, &early, &time);
    fmi3GetFloat64(instance, &result, 1, &output[k], 1);
    ++steps;
  }
}
