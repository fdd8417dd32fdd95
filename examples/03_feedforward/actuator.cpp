#include "examples/03_feedforward/actuator.hpp"

#include <cmath>

namespace hysteron::examples {

RambergOsgoodActuator RambergOsgoodActuator::at_branching_point(const Material& material, double y) {
  RambergOsgoodActuator actuator(material);
  actuator.skeleton_ = false;
  actuator.y_ = y;
  actuator.branch_y_ = y;
  return actuator;
}

double RambergOsgoodActuator::operator()(double u) {
  if (u == u_) {
    return y_;
  }
  const double direction = u > u_ ? 1.0 : -1.0;
  if (direction * direction_ < 0.0) {  // a branching point: the direction of the input has reversed
    branch_u_ = u_;
    branch_y_ = y_;
    skeleton_ = false;
  }
  direction_ = direction;
  u_ = u;
  const auto& [y_star, u_star, alpha, gamma] = material_;
  if (skeleton_) {
    y_ = y_star * (u / u_star) * (1.0 + alpha * std::pow(std::fabs(u / u_star), gamma - 1.0));  // (2)
  } else {
    const double distance = (u - branch_u_) / (2.0 * u_star);
    y_ = branch_y_ + 2.0 * y_star * distance * (1.0 + alpha * std::pow(std::fabs(distance), gamma - 1.0));  // (3)
  }
  return y_;
}

}  // namespace hysteron::examples
