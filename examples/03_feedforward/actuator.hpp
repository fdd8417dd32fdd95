// The actuator of example 3: equations (2) and (3) of the paper, evaluated as they are printed. A second
// implementation, apart from the blocks, against which they are judged.
#pragma once

#include "examples/01_memory_element/memory_element.hpp"

namespace hysteron::examples {

class RambergOsgoodActuator {
 public:
  /// At rest, on the skeleton curve, at u = 0 and y = 0.
  explicit RambergOsgoodActuator(const Material& material) : material_(material) {}

  /// At a branching point with u = 0 and the displacement y, in m: the next branch begins there.
  static RambergOsgoodActuator at_branching_point(const Material& material, double y);

  /// The displacement in m after the input has moved to u, in V.
  double operator()(double u);

 private:
  Material material_;
  bool skeleton_ = true;
  double direction_ = 0.0;
  double u_ = 0.0;
  double y_ = 0.0;
  double branch_u_ = 0.0;
  double branch_y_ = 0.0;
};

}  // namespace hysteron::examples
