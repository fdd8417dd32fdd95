// What the modelDescription.xml of an FMU says of its co-simulation: versions, variables, abilities.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "blocks/description.hpp"
#include "codegen/cosimulation/channel.hpp"

namespace hysteron::cosimulation {

/// An input, parameter or output of the FMU, of a type that the language has.
struct ModelVariable {
  std::string name{};     ///< as the FMU has it: motor.w, u[1]; so is an element of an array of FMI 3.0 named
  std::string unit{};     ///< as the FMU has it: N.m
  std::string meaning{};  ///< its description
  Type type = Type::Real;
  Access access = Access::Float64;
  std::uint32_t reference = 0;
  bool goes_on = false;  ///< the next element of the array that the variable before belongs to
  double start = 0.0;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
};

/// An input, parameter or output that no block can have, and why.
struct LeftOut {
  std::string name{};
  std::string reason{};
};

struct Description {
  std::uint32_t version = 2;
  std::string model_name{};
  std::string meaning{};
  std::string model_identifier{};
  std::string token{};         ///< guid, or instantiationToken
  std::string tool{};          ///< that made it
  double internal_step = 0.0;  ///< fixedInternalStepSize in seconds; 0: not stated
  bool once_per_process = false;
  std::vector<ModelVariable> inputs{};
  std::vector<ModelVariable> parameters{};
  std::vector<ModelVariable> outputs{};
  std::vector<LeftOut> left_out{};
};

/// Reads the XML. Throws std::runtime_error with the reason where it is no co-simulation FMU of FMI 2.0 or 3.0.
[[nodiscard]] Description parse_description(std::string_view xml);

}  // namespace hysteron::cosimulation
