// The four fits of the static map: the truth on exact data, agreement on noisy data, the failure of the printed
// procedure, units, edges and errors.
#include "tuning/static_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

using ::testing::HasSubstr;

constexpr StaticMap truth{0.05, 1.3, 1.7};

struct Points {
  std::vector<double> p{};
  std::vector<double> M{};
  std::vector<double> weight{};
  [[nodiscard]] StaticMapPoints view() const { return {.p = p, .M = M, .weight = weight, .source = "points.csv"}; }
};

Points sampled(const StaticMap& map, std::size_t count, double first, double last, double noise = 0.0,
               unsigned seed = 1) {
  Points points;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < count; ++i) {
    const double p = first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1);
    points.p.push_back(p);
    points.M.push_back(map(p) + (noise > 0.0 ? noise * normal(random) : 0.0));
  }
  return points;
}

void expect_map(const StaticMap& got, const StaticMap& wanted, double relative) {
  EXPECT_NEAR(got.C1, wanted.C1, relative * std::fabs(wanted.C1));
  EXPECT_NEAR(got.C2, wanted.C2, relative * std::fabs(wanted.C2));
  EXPECT_NEAR(got.C3, wanted.C3, relative * std::fabs(wanted.C3));
}

TEST(StaticMap, ProcedureOneAsPrintedLeavesTheTruthOnExactData) {
  // paper.md's finding: from C1 = 0.95 of the truth, C3 has fallen to 0.033 after 20 rounds
  const Points points = sampled(truth, 200, 0.001, 1.0);
  const StaticMapFit fit = fit_static_map(
      points.view(), {.method = StaticMapMethod::Procedure1, .start_C1 = 0.95 * truth.C1, .max_iterations = 20});
  EXPECT_EQ(fit.status, FitStatus::IterationLimit);
  ASSERT_EQ(fit.history.size(), 20U);
  EXPECT_NEAR(fit.map.C3, 0.0333, 0.0001);
  EXPECT_LT(fit.map.C1, -8.0);
  EXPECT_GT(fit.history.back().rms, fit.history.front().rms);
  const StaticMapFit longer = fit_static_map(
      points.view(), {.method = StaticMapMethod::Procedure1, .start_C1 = 0.95 * truth.C1, .max_iterations = 5000});
  EXPECT_EQ(longer.status, FitStatus::Diverging) << longer.message;
  EXPECT_THAT(longer.message, HasSubstr("Procedure 1 left the range of C3"));
}

TEST(StaticMap, ProcedureOneAsPrintedStaysOnlyWhereItStartsExactly) {
  const Points points = sampled(truth, 200, 0.001, 1.0);
  const StaticMapFit fit =
      fit_static_map(points.view(), {.method = StaticMapMethod::Procedure1, .start_C1 = truth.C1, .max_iterations = 3});
  expect_map(fit.map, truth, 1e-6);
}

TEST(StaticMap, ProcedureOneWeightedConvergesFromTheSameStart) {
  const Points points = sampled(truth, 200, 0.001, 1.0);
  const StaticMapFit fit =
      fit_static_map(points.view(), {.method = StaticMapMethod::Procedure1Weighted, .start_C1 = 0.95 * truth.C1});
  EXPECT_EQ(fit.status, FitStatus::Converged);
  EXPECT_LT(fit.iterations, 600);
  expect_map(fit.map, truth, 1e-9);
  std::size_t rounds_to_nine_digits = 0;
  while (std::fabs(fit.history[rounds_to_nine_digits].map.C3 - truth.C3) > 1e-9) {
    ++rounds_to_nine_digits;
  }
  EXPECT_LT(rounds_to_nine_digits, 400U);
}

TEST(StaticMap, VariableProjectionAndIpoptFindExactDataForEveryExponent) {
  for (const double exponent : {0.02, 0.3, 0.5, 1.0, 1.7, 2.0, 4.5, 12.0}) {
    for (const double C2 : {1.3, -0.04}) {
      const StaticMap map{0.05, C2, exponent};
      const Points points = sampled(map, 200, 0.0, 1.0);  // p = 0 among them
      const StaticMapFit projected = fit_static_map(points.view());
      EXPECT_EQ(projected.status, FitStatus::Converged) << exponent << " " << projected.message;
      expect_map(projected.map, map, exponent < 0.1 ? 1e-9 : 1e-11);
      EXPECT_LT(projected.rms, 1e-14);
      EXPECT_LT(projected.iterations, 20);
      const StaticMapFit interior = fit_static_map(points.view(), {.method = StaticMapMethod::Ipopt});
      EXPECT_TRUE(interior.converged()) << exponent << " " << interior.message;
      expect_map(interior.map, map, exponent < 0.1 ? 1e-8 : 1e-10);
    }
  }
}

TEST(StaticMap, AllButThePrintedProcedureAgreeOnNoisyData) {
  const Points points = sampled(truth, 500, 0.001, 1.0, 0.01);
  const StaticMapFit projected = fit_static_map(points.view());
  const StaticMapFit interior = fit_static_map(points.view(), {.method = StaticMapMethod::Ipopt});
  EXPECT_TRUE(projected.converged() && interior.converged());
  expect_map(interior.map, projected.map, 1e-9);
  EXPECT_NEAR(interior.rms, projected.rms, 1e-13);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(interior.covariance.standard_errors[i], projected.covariance.standard_errors[i],
                1e-7 * projected.covariance.standard_errors[i]);
  }
  // Procedure 1, weighted, is no least-squares fit and ends close by: within three standard errors
  const StaticMapFit weighted =
      fit_static_map(points.view(), {.method = StaticMapMethod::Procedure1Weighted, .start_C1 = 0.9 * truth.C1});
  EXPECT_EQ(weighted.status, FitStatus::Converged);
  EXPECT_NEAR(weighted.map.C3, projected.map.C3, 3.0 * projected.covariance.standard_errors[2]);
  EXPECT_GE(weighted.rms, projected.rms);
  const StaticMapFit printed =
      fit_static_map(points.view(), {.method = StaticMapMethod::Procedure1, .start_C1 = 0.9 * truth.C1});
  EXPECT_FALSE(printed.converged() && std::fabs(printed.map.C3 - truth.C3) < 0.2);
}

TEST(StaticMap, StandardErrorsPredictTheScatterOfRepeatedFits) {
  const int experiments = 300;
  double squares[3] = {};
  double predicted[3] = {};
  const double exact[3] = {truth.C1, truth.C2, truth.C3};
  for (int k = 0; k < experiments; ++k) {
    const StaticMapFit fit =
        fit_static_map(sampled(truth, 200, 0.001, 1.0, 0.01, 10U + static_cast<unsigned>(k)).view());
    const double got[3] = {fit.map.C1, fit.map.C2, fit.map.C3};
    for (int i = 0; i < 3; ++i) {
      squares[i] += (got[i] - exact[i]) * (got[i] - exact[i]) / experiments;
      predicted[i] += fit.covariance.standard_errors[i] / std::sqrt(fit.covariance.correlation_time) / experiments;
    }
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(predicted[i] / std::sqrt(squares[i]), 1.0, 0.12) << i;
  }
}

TEST(StaticMap, MetresBesideVoltsMakeNoDifference) {
  const Points volts = sampled(truth, 300, 0.001, 1.0, 0.01);
  const StaticMapFit reference = fit_static_map(volts.view());
  const double p_unit = 500.0;   // V
  const double m_unit = 2.5e-9;  // m/V
  Points scaled = volts;
  for (std::size_t i = 0; i < scaled.p.size(); ++i) {
    scaled.p[i] *= p_unit;
    scaled.M[i] *= m_unit;
  }
  const double C2_unit = m_unit * std::pow(p_unit, -reference.map.C3);
  for (const auto method : {StaticMapMethod::VariableProjection, StaticMapMethod::Ipopt}) {
    const StaticMapFit fit = fit_static_map(scaled.view(), {.method = method});
    expect_map(fit.map, {m_unit * reference.map.C1, C2_unit * reference.map.C2, reference.map.C3}, 1e-9);
    EXPECT_NEAR(fit.rms, m_unit * reference.rms, 1e-12 * m_unit);
    EXPECT_NEAR(fit.covariance.standard_errors[0], m_unit * reference.covariance.standard_errors[0],
                1e-7 * m_unit * reference.covariance.standard_errors[0]);
    EXPECT_NEAR(fit.covariance.standard_errors[2], reference.covariance.standard_errors[2], 1e-8);
    // C2's error in the new unit: δC2 = unit·(δC2₀ − C2₀·ln(p_unit)·δC3), by the covariance of the two
    const auto& c = reference.covariance.covariance;
    const double a = reference.map.C2 * std::log(p_unit);
    const double wanted = C2_unit * std::sqrt(c(1, 1) - 2.0 * a * c(1, 2) + a * a * c(2, 2));
    EXPECT_NEAR(fit.covariance.standard_errors[1], wanted, 1e-6 * wanted);
  }
}

TEST(StaticMap, AWeightOfTwoIsThePointTwiceAndOfZeroNoPoint) {
  Points weighted = sampled(truth, 60, 0.001, 1.0, 0.02);
  Points repeated;
  for (std::size_t i = 0; i < weighted.p.size(); ++i) {
    weighted.weight.push_back(static_cast<double>(i % 3));
    for (std::size_t k = 0; k < i % 3; ++k) {
      repeated.p.push_back(weighted.p[i]);
      repeated.M.push_back(weighted.M[i]);
    }
  }
  for (const auto method :
       {StaticMapMethod::VariableProjection, StaticMapMethod::Ipopt, StaticMapMethod::Procedure1Weighted}) {
    const StaticMapFit one = fit_static_map(weighted.view(), {.method = method});
    const StaticMapFit two = fit_static_map(repeated.view(), {.method = method});
    expect_map(one.map, two.map, 1e-8);
    EXPECT_NEAR(one.rms, two.rms, 1e-12);
  }
}

TEST(StaticMap, TenThousandPointsTakeAsFewPassesAsTwoHundred) {
  const StaticMapFit small = fit_static_map(sampled(truth, 200, 0.0, 1.0, 0.01).view());
  const StaticMapFit large = fit_static_map(sampled(truth, 10'000, 0.0, 1.0, 0.01).view());
  EXPECT_LE(large.iterations, 12);
  EXPECT_LE(small.iterations, 12);
  EXPECT_NEAR(large.map.C3, truth.C3, 4.0 * large.covariance.standard_errors[2]);
}

TEST(StaticMap, AConstantMHasNoHysteresis) {
  const StaticMapFit fit = fit_static_map(sampled({0.3, 0.0, 1.0}, 50, 0.0, 2.0).view());
  EXPECT_EQ(fit.status, FitStatus::NoInfluence);
  EXPECT_EQ(fit.map.C1, 0.3);
  EXPECT_EQ(fit.map.C2, 0.0);
  EXPECT_EQ(fit.covariance.standard_errors[2], std::numeric_limits<double>::infinity());
}

TEST(StaticMap, ALogarithmEndsOnTheBoundOfC3AndSaysSo) {
  Points points;
  for (int i = 1; i <= 200; ++i) {
    points.p.push_back(i / 200.0);
    points.M.push_back(1.0 + 0.2 * std::log(i / 200.0));
  }
  for (const auto method : {StaticMapMethod::VariableProjection, StaticMapMethod::Ipopt}) {
    const StaticMapFit fit = fit_static_map(points.view(), {.method = method, .least_C3 = 0.05});
    EXPECT_TRUE(fit.converged()) << fit.message;
    EXPECT_EQ(fit.map.C3, 0.05);
    EXPECT_TRUE(std::isnan(fit.covariance.standard_errors[2]));
    EXPECT_GT(fit.covariance.standard_errors[1], 0.0);
    ASSERT_FALSE(fit.covariance.warnings.empty());
  }
}

TEST(StaticMap, TheExampleOfThePaperConverts) {
  // y* = 1.225 µm, u* = 500 V, γ = 2, α = 3.2653: C1 = 2.45e-9 m/V, C2 = 1.6e-11 m/V², C3 = 1
  const StaticMap map = static_map_from_example(1.225e-6, 500.0, 8.0e-9 / 2.45e-9, 2.0);
  EXPECT_NEAR(map.C1, 2.45e-9, 1e-23);
  EXPECT_NEAR(map.C2, 1.6e-11, 1e-25);
  EXPECT_EQ(map.C3, 1.0);
}

int error_number(const StaticMapPoints& points, const StaticMapOptions& options = {}) {
  try {
    fit_static_map(points, options);
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().front().place.file, "points.csv");
    EXPECT_FALSE(error.diagnostics().all().front().mend.empty());
    return error.diagnostics().all().front().number;
  }
  return 0;
}

TEST(StaticMap, PointsThatCannotBeFittedAreErrors) {
  Points points = sampled(truth, 2, 0.1, 1.0);
  EXPECT_EQ(error_number(points.view()), error::too_few_points);
  points = {};
  EXPECT_EQ(error_number(points.view()), error::too_few_points);
  points = sampled(truth, 50, 0.3, 0.3);
  EXPECT_EQ(error_number(points.view()), error::too_few_points);
  points = sampled(truth, 50, 0.0, 1.0);
  points.M[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_number(points.view()), error::unusable_point);
  points = sampled(truth, 50, -0.1, 1.0);
  points.M.assign(50, 1.0);
  EXPECT_EQ(error_number(points.view()), error::unusable_point);
  points = sampled(truth, 50, 0.0, 1.0);
  points.weight.assign(50, 1.0);
  points.weight[3] = -1.0;
  EXPECT_EQ(error_number(points.view()), error::unusable_point);
  points = sampled(truth, 50, 0.0, 1.0);
  EXPECT_EQ(error_number(points.view(), {.method = StaticMapMethod::Procedure1, .start_C1 = 2.0}),
            error::nothing_above_c1);
}

}  // namespace
}  // namespace hysteron
