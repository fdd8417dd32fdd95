// The least-squares solver: units, bounds, outliers, cancelling, and inputs that cannot be fitted. Accuracy on
// published problems is in nist_test.cpp.
#include "tuning/ipopt_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd vector(std::initializer_list<double> values) {
  VectorXd result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

/// Noise without a random generator: the fractional parts of multiples of the golden ratio, −0.5 … 0.5.
double jitter(Eigen::Index i) {
  const double x = 0.6180339887498949 * static_cast<double>(i + 1);
  return x - std::floor(x) - 0.5;
}

/// y = a·(1 − exp(−x/b)) + c with 1 % noise, 60 points; lengths in `metre`, times in `second`.
LeastSquaresProblem relaxation(double metre, double second) {
  LeastSquaresProblem problem;
  problem.residual_count = 60;
  problem.names = {"a", "b", "c"};
  problem.start = vector({0.5 * metre, 3.0 * second, 0.4 * metre});
  problem.evaluate = [metre, second](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const double t = 0.1 * second * static_cast<double>(i);
      const double decay = std::exp(-t / x[1]);
      const double measured = metre * (2.0 * (1.0 - std::exp(-t / (1.5 * second))) + 0.1 + 0.02 * jitter(i));
      r[i] = x[0] * (1.0 - decay) + x[2] - measured;
      if (jacobian != nullptr) {
        jacobian->row(i) << 1.0 - decay, -x[0] * decay * t / (x[1] * x[1]), 1.0;
      }
    }
    return true;
  };
  return problem;
}

/// r = A·x − b with orthogonal columns, so that every bounded solution is known by hand: each coordinate clamped.
LeastSquaresProblem bowl() {
  LeastSquaresProblem problem;
  problem.residual_count = 4;
  problem.names = {"p", "q", "s"};
  problem.start = vector({0.5, 0.5, 0.5});
  problem.evaluate = [](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    r = vector({3.0 * (x[0] - 2.0), 2.0 * (x[1] + 1.0), x[2] - 0.7, 0.25});
    if (jacobian != nullptr) {
      *jacobian << 3, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0;
    }
    return true;
  };
  return problem;
}

TEST(LeastSquares, TheSameDigitsAndStepsInEveryUnit) {
  const LeastSquaresResult reference = solve(relaxation(1.0, 1.0));
  ASSERT_EQ(reference.status, FitStatus::Converged) << reference.message;
  EXPECT_NEAR(reference.x[0], 2.0, 0.02);
  for (const auto& [metre, second] : {std::pair{1e6, 1.0}, {1e-11, 1.0}, {1e3, 1e9}, {1e-9, 1e-6}}) {
    const LeastSquaresResult fit = solve(relaxation(metre, second));
    EXPECT_EQ(fit.status, FitStatus::Converged);
    EXPECT_EQ(fit.iterations, reference.iterations);
    EXPECT_NEAR(fit.x[0] / metre, reference.x[0], 1e-10 * reference.x[0]);
    EXPECT_NEAR(fit.x[1] / second, reference.x[1], 1e-10 * reference.x[1]);
    EXPECT_NEAR(fit.x[2] / metre, reference.x[2], 1e-10);
    EXPECT_NEAR(fit.rms / metre, reference.rms, 1e-10 * reference.rms);
  }
}

TEST(LeastSquares, FindsNoiseFreeParametersToTheLastDigits) {
  LeastSquaresProblem problem = relaxation(1.0, 1.0);
  problem.evaluate = [inner = problem.evaluate](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    VectorXd at_truth(r.size());
    inner(vector({2.0, 1.5, 0.1}), at_truth, nullptr);
    inner(x, r, jacobian);
    r -= at_truth;
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_TRUE(fit.converged()) << fit.message;
  EXPECT_NEAR(fit.x[0], 2.0, 1e-13);
  EXPECT_NEAR(fit.x[1], 1.5, 1e-13);
  EXPECT_NEAR(fit.x[2], 0.1, 1e-13);
}

TEST(LeastSquares, ParametersEndExactlyOnTheirBounds) {
  LeastSquaresProblem problem = bowl();
  problem.lower = vector({-infinity, 0.0, 0.0});
  problem.upper = vector({1.0, infinity, 1.0});
  const LeastSquaresResult fit = solve(problem);
  EXPECT_EQ(fit.status, FitStatus::Converged) << fit.message;
  EXPECT_EQ(fit.x[0], 1.0);
  EXPECT_EQ(fit.x[1], 0.0);
  EXPECT_NEAR(fit.x[2], 0.7, 1e-14);
  EXPECT_EQ(fit.at_bound[0], AtBound::Upper);
  EXPECT_EQ(fit.at_bound[1], AtBound::Lower);
  EXPECT_EQ(fit.at_bound[2], AtBound::Free);
}

/// The gradient does not vanish at a kink: what ends the fit is that the cost stands still.
TEST(LeastSquares, AFitThatStandsStillAtAKinkEnds) {
  LeastSquaresProblem problem;
  problem.residual_count = 3;
  problem.names = {"kinked", "smooth"};
  problem.start = vector({1.0, 0.0});
  problem.evaluate = [](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    const double side = x[0] > 0.3 ? 1.0 : -1.0;
    r = vector({1.0 + 5.0 * std::abs(x[0] - 0.3), 1.0 + std::abs(x[0] - 0.3), x[1] - 2.0});
    if (jacobian != nullptr) {
      *jacobian << 5.0 * side, 0, side, 0, 0, 1;
    }
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_EQ(fit.status, FitStatus::Stalled) << fit.message;
  EXPECT_LT(fit.iterations, 80);  // the limit is some hundreds
  EXPECT_NEAR(fit.x[0], 0.3, 1e-3);
  EXPECT_NEAR(fit.x[1], 2.0, 1e-3);
}

TEST(LeastSquares, AnOptimumCloseToABoundIsNotTakenForOneOnIt) {
  LeastSquaresProblem problem = bowl();
  problem.lower = vector({2.0 - 1e-7, -5.0, 0.7});  // p just above its bound, s exactly on it with gradient 0
  problem.upper = vector({5.0, 5.0, 5.0});
  problem.start = vector({3.0, 0.5, 1.0});
  const LeastSquaresResult fit = solve(problem);
  EXPECT_TRUE(fit.converged()) << fit.message;
  EXPECT_NEAR(fit.x[0], 2.0, 1e-12);
  EXPECT_EQ(fit.at_bound[0], AtBound::Free);
  EXPECT_NEAR(fit.x[1], -1.0, 1e-12);
  EXPECT_NEAR(fit.x[2], 0.7, 1e-9);
}

/// A narrow, shallow valley at 1, where the fit begins, and a wide one at 6 that is less deep: a barrier away from the
/// bound at 0.5 pushes the fit out of the first and down into the second.
LeastSquaresProblem two_valleys(double depth) {
  LeastSquaresProblem problem;
  problem.residual_count = 1;
  problem.names = {"x"};
  problem.start = vector({1.0});
  problem.lower = vector({0.5});
  problem.evaluate = [depth](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    const double near = (x[0] - 1.0) / 0.3;
    const double far = (x[0] - 6.0) / 2.0;
    const double narrow = depth * std::exp(-near * near);
    const double wide = 0.5 * depth * std::exp(-far * far);
    r[0] = 1.0 - narrow - wide;
    if (jacobian != nullptr) {
      (*jacobian)(0, 0) = 2.0 * narrow * near / 0.3 + 2.0 * wide * far / 2.0;
    }
    return true;
  };
  return problem;
}

TEST(LeastSquares, NoFitEndsWorseThanItBegan) {
  for (const double depth : {0.5, 0.2, 0.1, 0.05, 0.02, 0.005}) {
    const LeastSquaresProblem problem = two_valleys(depth);
    VectorXd residuals(1);
    ASSERT_TRUE(problem.evaluate(problem.start, residuals, nullptr));
    const LeastSquaresResult fit = solve(problem);
    EXPECT_LE(fit.cost, 0.5 * residuals.squaredNorm() * (1.0 + 1e-9)) << depth;
    EXPECT_NEAR(fit.x[0], 1.0, 0.01) << depth;
    const LeastSquaresResult robust = solve(problem, {.loss = Loss::Huber, .huber_threshold = 0.1});
    EXPECT_NEAR(robust.x[0], 1.0, 0.01) << depth;
  }
}

/// Steps without a slope: the derivative sees a straight line that leads away, as a rough law of friction does.
TEST(LeastSquares, WhereTheModelJumpsTheBestPointSeenIsKept) {
  LeastSquaresProblem problem;
  problem.residual_count = 2;
  problem.names = {"x"};
  problem.start = vector({2.0});
  problem.lower = vector({0.0});
  problem.upper = vector({10.0});
  problem.evaluate = [](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    const bool is_right = std::fabs(x[0] - 2.0) < 0.05;
    r = vector({is_right ? 0.1 : 1.0, 0.2 * (x[0] - 7.0) * (is_right ? 0.01 : 1.0)});
    if (jacobian != nullptr) {
      *jacobian << 0.0, 0.2;
    }
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_NEAR(fit.x[0], 2.0, 0.05);
  EXPECT_FALSE(fit.converged()) << "the gradient is not zero there: " << fit.message;
  EXPECT_EQ(fit.at_bound.front(), AtBound::Free);
}

TEST(LeastSquares, AProblemWithoutAnUnknownIsEvaluated) {
  LeastSquaresProblem problem;
  problem.residual_count = 2;
  problem.evaluate = [](const VectorXd&, VectorXd& r, MatrixXd*) {
    r = vector({3.0, 4.0});
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_EQ(fit.cost, 12.5);
  EXPECT_EQ(fit.x.size(), 0);
}

TEST(LeastSquares, AHeldParameterStaysAndTheOthersMove) {
  LeastSquaresProblem problem = bowl();
  problem.lower = vector({0.5, -5.0, -5.0});
  problem.upper = vector({0.5, 5.0, 5.0});
  const LeastSquaresResult fit = solve(problem);
  EXPECT_EQ(fit.x[0], 0.5);
  EXPECT_EQ(fit.at_bound[0], AtBound::Held);
  EXPECT_NEAR(fit.x[1], -1.0, 1e-12);

  problem.lower = problem.upper = problem.start;
  const LeastSquaresResult nothing = solve(problem);
  EXPECT_TRUE(nothing.converged());
  EXPECT_EQ(nothing.iterations, 0);
  EXPECT_EQ(nothing.x, problem.start);
}

TEST(LeastSquares, HuberLossOfALocationIsSolvedByHand) {
  // Nine values 0 and one 100 with δ = 1: the stationary point is 9·x = δ, x = 1/9. The mean would be 10.
  LeastSquaresProblem problem;
  problem.residual_count = 10;
  problem.start = vector({5.0});
  problem.evaluate = [](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    r.setConstant(x[0]);
    r[9] -= 100.0;
    if (jacobian != nullptr) {
      jacobian->setOnes();
    }
    return true;
  };
  EXPECT_NEAR(solve(problem).x[0], 10.0, 1e-12);
  const LeastSquaresResult robust = solve(problem, {.loss = Loss::Huber, .huber_threshold = 1.0});
  EXPECT_TRUE(robust.converged()) << robust.message;
  EXPECT_NEAR(robust.x[0], 1.0 / 9.0, 1e-10);
  EXPECT_NEAR(robust.weights[9], 1.0 / (100.0 - 1.0 / 9.0), 1e-10);
  EXPECT_EQ(robust.weights[0], 1.0);
}

TEST(LeastSquares, TheAutomaticThresholdForgivesOutliersInEveryUnit) {
  const auto spoiled = [](double metre) {
    LeastSquaresProblem problem = relaxation(metre, 1.0);
    problem.evaluate = [metre, inner = problem.evaluate](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
      inner(x, r, jacobian);
      for (const Eigen::Index i : {7, 23, 41, 58}) {
        r[i] += 3.0 * metre;
      }
      return true;
    };
    return problem;
  };
  const LeastSquaresResult clean = solve(relaxation(1.0, 1.0));
  const LeastSquaresResult squares = solve(spoiled(1.0));
  const LeastSquaresResult huber = solve(spoiled(1.0), {.loss = Loss::Huber});
  EXPECT_TRUE(huber.converged()) << huber.message;
  EXPECT_GT((squares.x - clean.x).norm(), 0.1);
  EXPECT_LT((huber.x - clean.x).norm(), 0.01);
  const LeastSquaresResult small = solve(spoiled(1e-6), {.loss = Loss::Huber});
  EXPECT_NEAR(small.x[0] / 1e-6, huber.x[0], 1e-6);
  EXPECT_NEAR(small.huber_threshold / 1e-6, huber.huber_threshold, 1e-5 * huber.huber_threshold);
}

TEST(LeastSquares, CancellingKeepsTheBestPointSoFar) {
  const auto complete = solve(relaxation(1.0, 1.0));
  int calls = 0;
  LeastSquaresOptions options;
  options.progress = [&calls](const FitProgress& progress) {
    EXPECT_TRUE(std::isfinite(progress.rms));
    return ++calls < 3;
  };
  const LeastSquaresProblem problem = relaxation(1.0, 1.0);
  const LeastSquaresResult fit = solve(problem, options);
  EXPECT_EQ(fit.status, FitStatus::Cancelled);
  EXPECT_EQ(calls, 3);
  VectorXd residuals(problem.residual_count);
  problem.evaluate(problem.start, residuals, nullptr);
  EXPECT_LT(fit.cost, 0.5 * residuals.squaredNorm());
  EXPECT_GT(fit.cost, complete.cost);
  problem.evaluate(fit.x, residuals, nullptr);
  EXPECT_EQ(fit.cost, 0.5 * residuals.squaredNorm());
}

TEST(LeastSquares, TheIterationLimitIsSaid) {
  const LeastSquaresResult fit = solve(relaxation(1.0, 1.0), {.max_iterations = 2});
  EXPECT_EQ(fit.status, FitStatus::IterationLimit);
  EXPECT_EQ(fit.iterations, 2);
}

TEST(LeastSquares, AStepIntoNotANumberIsShortened) {
  // ln(x) − ln(0.01): the full Gauss-Newton step from 1 is to −3.6, where the logarithm has no value.
  LeastSquaresProblem problem;
  problem.residual_count = 1;
  problem.start = vector({1.0});
  problem.evaluate = [](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    r[0] = std::log(x[0]) - std::log(0.01);
    if (jacobian != nullptr) {
      (*jacobian)(0, 0) = 1.0 / x[0];
    }
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_TRUE(fit.converged()) << fit.message;
  EXPECT_NEAR(fit.x[0], 0.01, 1e-14);
}

TEST(LeastSquares, AWrongJacobianNeverPassesForAFit) {
  LeastSquaresProblem problem = bowl();
  problem.evaluate = [inner = problem.evaluate](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    inner(x, r, jacobian);
    if (jacobian != nullptr) {
      *jacobian = -*jacobian;
    }
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_FALSE(fit.converged()) << fit.message;
}

TEST(LeastSquares, AParameterWithoutInfluenceIsSaid) {
  LeastSquaresProblem problem = bowl();
  problem.evaluate = [inner = problem.evaluate](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    inner(vector({x[0], x[1], 0.0}), r, jacobian);
    if (jacobian != nullptr) {
      jacobian->col(2).setZero();
    }
    return true;
  };
  const LeastSquaresResult fit = solve(problem);
  EXPECT_EQ(fit.status, FitStatus::NoInfluence);
  EXPECT_NEAR(fit.x[0], 2.0, 1e-9);
}

TEST(LeastSquares, ExceptionsOfTheModelPassThrough) {
  LeastSquaresProblem problem = bowl();
  int calls = 0;
  problem.evaluate = [&calls, inner = problem.evaluate](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    if (++calls > 2) {
      throw std::domain_error("the model's own");
    }
    return inner(x, r, jacobian);
  };
  EXPECT_THROW(solve(problem), std::domain_error);
}

int error_number(const LeastSquaresProblem& problem) {
  try {
    solve(problem);
  } catch (const InputError& error) {
    EXPECT_FALSE(error.diagnostics().all().front().mend.empty());
    return error.diagnostics().all().front().number;
  }
  return 0;
}

TEST(LeastSquares, InputsThatCannotBeFittedAreErrors) {
  LeastSquaresProblem problem = bowl();
  problem.lower = vector({1.0, -5.0, -5.0});
  EXPECT_EQ(error_number(problem), error::no_room_in_bounds);
  problem = bowl();
  problem.lower = vector({0.0, 0.0, 0.0});
  problem.upper = vector({1.0, -1.0, 1.0});
  EXPECT_EQ(error_number(problem), error::no_room_in_bounds);
  problem = bowl();
  problem.start[1] = not_a_number;
  EXPECT_EQ(error_number(problem), error::no_room_in_bounds);
  problem = bowl();
  problem.evaluate = [](const VectorXd&, VectorXd& r, MatrixXd*) {
    r.setConstant(not_a_number);
    return true;
  };
  EXPECT_EQ(error_number(problem), error::start_without_value);
  problem = bowl();
  problem.upper = vector({1.0});
  EXPECT_THROW(solve(problem), std::invalid_argument);
}

TEST(LeastSquares, TheSameBitsTwice) {
  const LeastSquaresResult one = solve(relaxation(1.0, 1.0));
  const LeastSquaresResult two = solve(relaxation(1.0, 1.0));
  EXPECT_EQ(one.x, two.x);
  EXPECT_EQ(one.residual_evaluations, two.residual_evaluations);
}

TEST(LeastSquares, NoOptionFileIsReadAndNothingIsPrinted) {
  const auto before = std::filesystem::current_path();
  const auto directory = std::filesystem::temp_directory_path() / "hysteron_ipopt_options";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "ipopt.opt") << "max_iter 1\nprint_level 5\n";
  std::filesystem::current_path(directory);
  ::testing::internal::CaptureStdout();
  const LeastSquaresResult fit = solve(relaxation(1.0, 1.0));
  const std::string printed = ::testing::internal::GetCapturedStdout();
  std::filesystem::current_path(before);
  std::filesystem::remove_all(directory);
  EXPECT_EQ(fit.status, FitStatus::Converged);
  EXPECT_EQ(printed, "");
}

TEST(LeastSquares, EveryStatusHasItsWords) {
  for (const auto status :
       {FitStatus::Converged, FitStatus::NearlyConverged, FitStatus::IterationLimit, FitStatus::Cancelled,
        FitStatus::Stalled, FitStatus::NoInfluence, FitStatus::Diverging, FitStatus::WorseThanConstant,
        FitStatus::Unbounded, FitStatus::ModelFailed, FitStatus::SolverFailed}) {
    EXPECT_FALSE(plain_words(status).empty());
  }
}

}  // namespace
}  // namespace hysteron
