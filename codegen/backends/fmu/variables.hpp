// The variables of an FMU: the inputs, outputs and parameters of a diagram by the names that an importer shows.
#pragma once

#include <string>
#include <vector>

#include "codegen/backends/fmu/fmu.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

struct FmuVariable {
  enum class Role : std::uint8_t { Input, Output, Parameter };
  std::string name{};  ///< X, LAG.T1, of an element of an array TABLE.Y[1]
  Role role = Role::Input;
  Type type = Type::Real;
  std::string unit{};
  std::string meaning{};
  std::vector<double> start{0.0};  ///< of an array, of each element
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool above_minimum = false;  ///< the minimum itself is out of range
  std::string member{};        ///< where the generated C keeps it, or its first element: in.x, params.lag.t1, in.y[0]
  bool array = false;          ///< of as many elements as start values
};

/// Inputs, outputs, parameters. The value reference of one is its place, counted from 1; 0 is the time. An array is one
/// variable in FMI 3.0, where the generated C has one, and a variable for each element in FMI 2.0, which knows none.
/// With `float32` in the options numbers are those that a float holds.
std::vector<FmuVariable> fmu_variables(const Program& program, const FmuOptions& options);

}  // namespace hysteron
