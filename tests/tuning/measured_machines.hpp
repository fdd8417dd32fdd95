// Records of simulated machines for the tests of the output-error fit, and a check of its Jacobians.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/parameters/apply.hpp"
#include "tuning/output_error.hpp"
#include "tuning/rollout.hpp"

namespace hysteron::measured_machines {

inline constexpr double two_pi = 2.0 * std::numbers::pi;

inline Program program_of(std::string_view text, std::string_view settings = {}) {
  Program program = compile_text(std::string(text));
  parameters::apply(parameters::parse_parameter_file("truth.toml", settings), program.graph);
  return program;
}

inline records::Record inputs(std::string name, double sample_time, std::size_t rows, double (*signal)(double)) {
  records::Record record = records::Record::even(0.0, sample_time, rows);
  std::vector<double> values;
  for (std::size_t k = 0; k < rows; ++k) {
    values.push_back(signal(static_cast<double>(k) * sample_time));
  }
  record.add({.name = std::move(name), .values = std::move(values)});
  return record;
}

class Noise {
 public:
  explicit Noise(unsigned seed) : engine_(seed) {}
  double operator()() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(two_pi * uniform());
  }
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }

 private:
  std::mt19937_64 engine_;
};

/// The record with the outputs of a program, and noise on them.
inline records::Record measured(const Program& truth, records::Record record, std::vector<double> deviations = {},
                                unsigned seed = 1) {
  Noise noise(seed);
  auto outputs = simulate(truth, record);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (double& value : outputs[i]) {
      value += deviations.empty() ? 0.0 : deviations[i] * noise();
    }
    record.add({.name = truth.graph.outputs[i].name, .values = std::move(outputs[i])});
  }
  return record;
}

inline OutputErrorProblem problem_of(std::string_view diagram, std::string_view settings,
                                     std::vector<records::Record> records) {
  return output_error_problem(compile_text(std::string(diagram)), parameters::parse_parameter_file("p.toml", settings),
                              records);
}

/// The Jacobian at a point, whose residuals are those of the plain rollout to the bit and whose columns are the slopes
/// of central differences.
inline Eigen::MatrixXd checked_jacobian(detail::Rollout& rollout, const Eigen::VectorXd& x) {
  Eigen::VectorXd plain(rollout.residual_count());
  Eigen::VectorXd dual(rollout.residual_count());
  Eigen::MatrixXd jacobian(rollout.residual_count(), x.size());
  EXPECT_TRUE(rollout.residuals(x, plain, nullptr));
  EXPECT_TRUE(rollout.residuals(x, dual, &jacobian));
  EXPECT_TRUE((plain.array() == dual.array()).all());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const double step = 1e-6 * std::fabs(x[j]);
    Eigen::VectorXd beside = x;
    beside[j] += step;
    Eigen::VectorXd above = plain;
    EXPECT_TRUE(rollout.residuals(beside, above, nullptr));
    beside[j] -= 2.0 * step;
    Eigen::VectorXd below = plain;
    EXPECT_TRUE(rollout.residuals(beside, below, nullptr));
    const Eigen::VectorXd slope = (above - below) / (2.0 * step);
    EXPECT_LT((slope - jacobian.col(j)).norm(), 1e-5 * jacobian.col(j).norm()) << j;
  }
  return jacobian;
}

}  // namespace hysteron::measured_machines
