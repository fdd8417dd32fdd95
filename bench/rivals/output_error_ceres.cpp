// Ceres on output error: one cost function over all samples, whose derivatives are differences of a compiled model.
//
// usage: output_error_ceres ROWS SUBJECT FIRST LAST START LEAST REPETITIONS, as output_error_scipy.py
#include <ceres/ceres.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "bench/rivals/repeated.hpp"

extern "C" void simulate(const double* theta, const double* u, double* y, long samples);

namespace {

struct Rows {
  TwoRows both;
  std::size_t first;
  std::size_t last;
};

struct Residuals {
  const Rows& rows;
  mutable std::vector<double> model;

  bool operator()(double const* const* theta, double* residuals) const {
    const std::vector<double>& y = rows.both.second;
    simulate(theta[0], rows.both.first.data(), model.data(), static_cast<long>(model.size()));
    for (std::size_t k = rows.first; k < rows.last; ++k) {
      residuals[k - rows.first] = model[k] - y[k];
    }
    return true;
  }
};

template <ceres::NumericDiffMethodType method>
std::vector<double> fit(const Rows& rows, std::vector<double> theta, const std::vector<double>& least,
                        double tolerance) {
  ceres::Problem problem;
  const ceres::NumericDiffOptions differences;
  auto* cost = new ceres::DynamicNumericDiffCostFunction<Residuals, method>(
      new Residuals{rows, std::vector<double>(rows.both.first.size())}, ceres::TAKE_OWNERSHIP, differences);
  cost->AddParameterBlock(static_cast<int>(theta.size()));
  cost->SetNumResiduals(static_cast<int>(rows.last - rows.first));
  problem.AddResidualBlock(cost, nullptr, theta.data());
  for (std::size_t j = 0; j < theta.size(); ++j) {
    problem.SetParameterLowerBound(theta.data(), static_cast<int>(j), least[j]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.function_tolerance = tolerance;
  options.max_num_iterations = 200;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return theta;
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    values.push_back(std::strtod(part.c_str(), nullptr));
  }
  return values;
}

}  // namespace

int main(int, char** arguments) {
  const std::string path = arguments[1];
  const Rows rows{read_rows(path, std::filesystem::file_size(path) / (2 * sizeof(double))),
                  std::strtoul(arguments[3], nullptr, 10), std::strtoul(arguments[4], nullptr, 10)};
  const auto start = numbers(arguments[5]);
  const auto least = numbers(arguments[6]);
  const int repetitions = std::atoi(arguments[7]);
  const std::string subject = arguments[2];
  repeat_fit(
      "ceres_forward", subject, [&] { return fit<ceres::FORWARD>(rows, start, least, 1e-6); }, repetitions);
  repeat_fit(
      "ceres_central", subject, [&] { return fit<ceres::CENTRAL>(rows, start, least, 1e-6); }, repetitions);
  repeat_fit(
      "ceres_central_tight", subject, [&] { return fit<ceres::CENTRAL>(rows, start, least, 1e-10); }, repetitions);
}
