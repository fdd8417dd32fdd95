// Ceres on a static map: a cost function a point with automatic derivatives, as its tutorial has it, and one cost
// function over all points with the exact Jacobian. Default tolerances, one thread, covariance included.
#include <ceres/ceres.h>
#include <ceres/covariance.h>

#include <cmath>
#include <utility>
#include <vector>

#include "bench/rivals/static_map_points.hpp"

namespace {

struct Point {
  double p;
  double m;
  template <class T>
  bool operator()(const T* c, T* residual) const {
    residual[0] = c[0] + c[1] * pow(T(p), c[2]) - T(m);
    return true;
  }
};

class AllPoints : public ceres::CostFunction {
 public:
  explicit AllPoints(const TwoRows& points) : points_(points) {
    set_num_residuals(static_cast<int>(points.first.size()));
    mutable_parameter_block_sizes()->push_back(3);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const double* const c = parameters[0];
    for (std::size_t i = 0; i < points_.first.size(); ++i) {
      const double p = points_.first[i];
      const double power = std::pow(p, c[2]);
      residuals[i] = c[0] + c[1] * power - points_.second[i];
      if (jacobians != nullptr && jacobians[0] != nullptr) {
        double* const row = jacobians[0] + 3 * i;
        row[0] = 1.0;
        row[1] = power;
        row[2] = c[1] * power * std::log(p);
      }
    }
    return true;
  }

 private:
  const TwoRows& points_;
};

std::vector<double> fit(const TwoRows& points, bool point_by_point, ceres::LinearSolverType linear) {
  const auto start = straight_line(points);
  std::vector<double> c(start.begin(), start.end());
  ceres::Problem problem;
  if (point_by_point) {
    for (std::size_t i = 0; i < points.first.size(); ++i) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<Point, 1, 3>(new Point{points.first[i], points.second[i]}), nullptr,
          c.data());
    }
  } else {
    problem.AddResidualBlock(new AllPoints(points), nullptr, c.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = linear;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  ceres::Covariance::Options of_covariance;
  of_covariance.num_threads = 1;
  ceres::Covariance covariance(of_covariance);
  const std::vector<std::pair<const double*, const double*>> blocks{{c.data(), c.data()}};
  covariance.Compute(blocks, &problem);
  return c;
}

}  // namespace

int main(int, char** arguments) {
  for (const std::size_t size : static_map_sizes) {
    const TwoRows points = static_map_points(arguments[1], size);
    const std::string subject = std::to_string(size);
    repeat_fit("ceres_points_qr", subject, [&] { return fit(points, true, ceres::DENSE_QR); });
    repeat_fit("ceres_points_cholesky", subject, [&] { return fit(points, true, ceres::DENSE_NORMAL_CHOLESKY); });
    repeat_fit("ceres_one_qr", subject, [&] { return fit(points, false, ceres::DENSE_QR); });
    repeat_fit("ceres_one_cholesky", subject, [&] { return fit(points, false, ceres::DENSE_NORMAL_CHOLESKY); });
  }
}
