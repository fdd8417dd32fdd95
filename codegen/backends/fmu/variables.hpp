// The variables of an FMU: the inputs, outputs and parameters of a diagram by the names that an importer shows.
#pragma once

#include <string>
#include <vector>

#include "codegen/compile.hpp"

namespace hysteron {

struct FmuVariable {
  enum class Role : std::uint8_t { Input, Output, Parameter };
  std::string name{};  ///< X, LAG.T1, TABLE.YS[1]
  Role role = Role::Input;
  Type type = Type::Real;
  std::string unit{};
  std::string meaning{};
  double start = 0.0;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool above_minimum = false;  ///< the minimum itself is out of range
  std::string member{};        ///< where the generated C keeps it: in.x, params.lag.t1
};

/// Inputs, outputs, parameters. The value reference of one is its place, counted from 1; 0 is the time. An array has a
/// variable for each element. `float32`: numbers are those that a float holds.
std::vector<FmuVariable> fmu_variables(const Program& program, bool float32);

}  // namespace hysteron
