// The axes that a command line of `hysteron export` names: each a joint with what is its own.
#pragma once

#include <string>
#include <vector>

namespace hysteron::tool {

/// As it was written: values that may begin with the name of a joint, `elbow=50`.
struct AxisTexts {
  std::vector<std::string> joints{};  ///< NAME, or NAME=FILE
  std::vector<std::string> gears{};
  std::vector<std::string> link_inertias{};
  std::vector<std::string> records{};
  std::string parameters{};  ///< of joints that state no file
};

struct ExportedAxis {
  std::string joint = "axis";
  std::string parameters{};  ///< a file; empty: the diagram as it is
  double gear = 1.0;
  double link_inertia = 0.0;
  std::string record{};  ///< to compare over; empty: none
};

/// One axis at least. A value without a name counts for every joint, one with a name for that joint. Throws InputError
/// HY730 for a name that no joint has, for what is stated twice, and for a number that is none.
[[nodiscard]] std::vector<ExportedAxis> exported_axes(const AxisTexts& texts);

}  // namespace hysteron::tool
