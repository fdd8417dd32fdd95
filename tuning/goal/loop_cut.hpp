// A place in a control loop where a small signal is put in, to see what comes back.
#pragma once

#include <cstddef>

#include "codegen/compile.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// A program whose signal w goes on as v = w + d, d a further input: v/d is the sensitivity S = 1/(1 + L) of the loop
/// that passes there, L what comes back of v, with the sign turned.
struct LoopCut {
  std::size_t input = 0;  ///< d
  Wire behind{};          ///< v: all that read w read v now, but the outputs of the diagram
};

/// Cuts at a wire of type LREAL. The schedule is made anew, since nothing of the diagram runs in another order of the
/// data flow for it. Reports what keeps the place from being cut: HY531 for a wire that is no LREAL, that nothing in
/// the diagram computes, or in a diagram of several rates, where no frequency response exists.
LoopCut cut_loop(Program& program, const Wire& wire, const std::string& name, const Place& place,
                 Diagnostics& diagnostics);

}  // namespace hysteron
