// The pages of the errors of fits keep their word: the failing text fails with that number, the mended one is fitted.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "records/read.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "tests/support/error_page.hpp"
#include "tuning/dual.hpp"
#include "tuning/hysteresis_points.hpp"
#include "tuning/ipopt_problem.hpp"
#include "tuning/static_map.hpp"

namespace hysteron {
namespace {

/// The numbers of a table below its heading, by row; a first column of names is left out.
std::vector<std::vector<double>> table(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    std::string cell;
    while (std::getline(cells, cell, ',')) {
      if (std::isalpha(static_cast<unsigned char>(cell[0])) == 0) {
        rows.back().push_back(std::stod(cell));
      }
    }
  }
  return rows;
}

/// A record t, u, y through Procedure 1's preparation.
void fit_record(const std::string& text, double rate_threshold) {
  const auto record = records::parse_record("log.csv", text);
  const auto points =
      hysteresis_points(record.column("u").values, record.column("y").values, record.sample_time(),
                        {.formula = RateFormula::TwoPoint, .rate_threshold = rate_threshold}, "log.csv");
  fit_static_map(points.points());
}

void fit_points(const std::string& text, StaticMapMethod method) {
  std::vector<double> p;
  std::vector<double> slope;
  for (const auto& row : table(text)) {
    p.push_back(row.at(0));
    slope.push_back(row.at(1));
  }
  const StaticMapFit fit = fit_static_map({.p = p, .M = slope}, {.method = method});
  EXPECT_TRUE(std::isfinite(fit.rms));
}

/// K·(1 − exp(−t/T1)) to the response of K = 2, T1 = 0.3.
void fit_step_response(const std::string& text) {
  const auto rows = table(text);
  LeastSquaresProblem problem;
  problem.names = {"K", "T1"};
  problem.residual_count = 20;
  problem.start = Eigen::Vector2d(rows.at(0).at(0), rows.at(1).at(0));
  problem.lower = Eigen::Vector2d(rows.at(0).at(1), rows.at(1).at(1));
  problem.upper = Eigen::Vector2d(rows.at(0).at(2), rows.at(1).at(2));
  problem.evaluate = [](const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    for (Eigen::Index i = 0; i < residuals.size(); ++i) {
      const double t = 0.05 * static_cast<double>(i);
      const auto K = Dual<2>::variable(x[0], 0);
      const auto T1 = Dual<2>::variable(x[1], 1);
      const auto y = K * (Dual<2>(1.0) - exp(Dual<2>(-t) / T1));
      residuals[i] = y.value() - 2.0 * (1.0 - std::exp(-t / 0.3));
      if (jacobian != nullptr) {
        jacobian->row(i) << y.derivative(0), y.derivative(1);
      }
    }
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_NEAR(fit.x[0], 2.0, 1e-9);
  EXPECT_NEAR(fit.x[1], 0.3, 1e-9);
}

TEST(ErrorPages, OfFits) {
  const std::map<int, std::function<void(const std::string&)>> runs{
      {error::too_few_points, [](const auto& text) { fit_record(text, 0.0); }},
      {error::start_without_value, fit_step_response},
      {error::no_room_in_bounds, fit_step_response},
      {error::no_motion, [](const auto& text) { fit_record(text, 250.0); }},
      {error::unusable_point, [](const auto& text) { fit_points(text, StaticMapMethod::VariableProjection); }},
      {error::nothing_above_c1, [](const auto& text) { fit_points(text, StaticMapMethod::Procedure1); }}};
  for (const auto& [number, run] : runs) {
    const auto name = "HY" + std::to_string(number);
    SCOPED_TRACE(name);
    const auto page = test::read_error_page(name);
    EXPECT_EQ(page.number, name);
    for (const auto& known : error_titles()) {
      if (known.number == number) {
        EXPECT_EQ(page.title, known.title);
      }
    }
    try {
      run(page.fails.text);
      FAIL() << "the failing text passes";
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().all().front().number, number);
    }
    EXPECT_NO_THROW(run(page.mended.text));
  }
}

}  // namespace
}  // namespace hysteron
