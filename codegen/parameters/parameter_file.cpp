#include "codegen/parameters/parameter_file.hpp"

#include <algorithm>

#include "support/names.hpp"

namespace hysteron::parameters {

const ParameterValue* ParameterFile::find(std::string_view path) const {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const ParameterValue& value) { return equal_ignoring_case(value.path, path); });
  return found == values.end() ? nullptr : &*found;
}

void ParameterFile::set_initial(const std::string& path, double value) {
  const auto found =
      std::ranges::find_if(initial, [&](const ParameterValue& given) { return equal_ignoring_case(given.path, path); });
  if (found == initial.end()) {
    initial.push_back({.path = path, .value = value});
  } else {
    found->value = value;
  }
}

}  // namespace hysteron::parameters
