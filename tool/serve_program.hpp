// A diagram as the program of a task: interpreted, or compiled on the fly. Both give the same bits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "runtime/task/step_program.hpp"
#include "tool/inner_signals.hpp"
#include "tool/program_shape.hpp"

namespace hysteron::tool {

/// Throws InputError HY725 or HY726 where it cannot be compiled. The inner signals are those of `program`; with them,
/// the state has the same layout and every output the same bits. `picture`: of the program, for the live page.
[[nodiscard]] std::unique_ptr<runtime::StepProgram> step_program(const Program& program, Engine engine, bool float32,
                                                                 const std::vector<InnerSignal>& inner = {},
                                                                 const std::string& picture = {});

/// The program with its inner signals as further outputs, by names that no diagram can have.
[[nodiscard]] Program with_inner_outputs(Program program, const std::vector<InnerSignal>& inner);
/// The inner signals as a shape has them.
[[nodiscard]] std::vector<runtime::ProgramSignal> inner_of_shape(const std::vector<InnerSignal>& inner);

/// Compiled where there is a compiler.
[[nodiscard]] Engine best_engine();
/// Of the option --engine; empty: the best.
[[nodiscard]] Engine engine_of(const std::string& name);

}  // namespace hysteron::tool
