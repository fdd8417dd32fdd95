// What a task knows of a diagram: its ports, its parameters, what lives from step to step.
#pragma once

#include <cstdint>

#include "codegen/compile.hpp"
#include "runtime/task/step_program.hpp"

namespace hysteron::tool {

enum class Engine : std::uint8_t { interpreter, compiled };

[[nodiscard]] runtime::PointType point_type(Type type);

/// Elements of array parameters count one by one, as TABLE.X[2]. The state has no offsets yet, which an engine gives:
/// its numbers are the cells of the program's routine, in their order. Throws InputError HY404 where the diagram states
/// no sample time.
[[nodiscard]] runtime::ProgramShape shape_of(const Program& program, Engine engine, bool float32);

}  // namespace hysteron::tool
