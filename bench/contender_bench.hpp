// The steps that bench/step.py and bench/batch.py have compiled, as benchmarks.
#pragma once

#include <string>

namespace hysteron::bench {

/// contender/DIAGRAM/NAME: a benchmark for each FOLDER/DIAGRAM/NAME.so, and one for the interpreter on each DIAGRAM, a
/// file of bench/. A repetition is so many rounds of 20,000 steps.
void add_contenders(const std::string& folder, int rounds);

}  // namespace hysteron::bench
