// feedforward.dsp, as Faust writes it in C++: it takes the samples of a call at once.
#include <cmath>

/// What Faust's code derives from; without its interfaces there is nothing in them.
struct Meta {
  void declare(const char*, const char*) {}
};
struct UI {
  void openVerticalBox(const char*) {}
  void closeBox() {}
  void declare(double*, const char*, const char*) {}
  void addNumEntry(const char*, double*, double, double, double, double) {}
  void addCheckButton(const char*, double*) {}
};
struct dsp {};
#define FAUSTFLOAT double
#include "bench/rivals/contender.h"
#include "faust_code.hpp"

static mydsp block;

extern "C" void contender_reset() {
  block.init(20000);
}

extern "C" void contender_run(const double* reference, double* output, long samples) {
  double* in[] = {const_cast<double*>(reference)};
  double* out[] = {output};
  block.compute(static_cast<int>(samples), in, out);
}
