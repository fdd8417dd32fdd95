/* The Structured Text of `hysteron generate --target st`, as MATIEC writes it in C. BLOCK, INPUT and OUTPUT are its names. */
#include "POUS.h"
#include "accessor.h"
#include "iec_std_lib.h"
TIME __CURRENT_TIME;
BOOL __DEBUG;
#include "POUS.c"
#include "bench/rivals/contender.h"

#define JOINED(a, b) a##b
#define NAMED(block, part) JOINED(block, part)

static BLOCK block;

void contender_reset(void) {
  NAMED(BLOCK, _init__)(&block, 0);
}

void contender_run(const double* reference, double* output, long samples) {
  for (long k = 0; k < samples; ++k) {
    block.INPUT.value = reference[k];
    NAMED(BLOCK, _body__)(&block);
    output[k] = block.OUTPUT.value;
  }
}
