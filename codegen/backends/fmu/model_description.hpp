// The XML files of an FMU: modelDescription.xml of FMI 2.0 and 3.0, and buildDescription.xml of FMI 3.0.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "codegen/backends/fmu/fmu.hpp"
#include "codegen/backends/fmu/variables.hpp"

namespace hysteron {

/// What both XML files state of a model beside its variables.
struct FmuModel {
  std::string name{};        ///< of the diagram
  std::string identifier{};  ///< a name of C
  std::string token{};       ///< the same in the binary: FMI's instantiationToken, or guid
  double sample_time = 0.0;  ///< s
};

/// What FMI calls a type, in XML and in the names of its functions: Float64, Integer.
const char* fmi_type_name(Type type, const FmuOptions& options);

std::string model_description(const FmuModel& model, std::span<const FmuVariable> variables,
                              std::span<const std::string> sources, const FmuOptions& options);

std::string build_description(const FmuModel& model, std::span<const std::string> sources);

}  // namespace hysteron
