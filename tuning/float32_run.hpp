// Runs in REAL, as a target without LREAL computes them. A file of its own, so that who runs in LREAL alone does not wait
// for the compilation of every block in REAL.
#pragma once

#include <functional>
#include <vector>

#include "tuning/simulation.hpp"

namespace hysteron {

/// interpret, in REAL where `float32` is set.
[[nodiscard]] std::vector<Signal> interpret(const Program& program, const Drive& drive,
                                            const std::vector<Wire>& watched, bool float32,
                                            const std::function<void(double)>& progress = {});

}  // namespace hysteron
