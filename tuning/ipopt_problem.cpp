// See ipopt_problem.hpp. The rounds, scales and bounds; Ipopt itself is behind ipopt_round.hpp.
#include "tuning/ipopt_problem.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/median.hpp"
#include "tuning/ipopt_round.hpp"
#include "tuning/least_squares_model.hpp"

namespace hysteron {
namespace {

using detail::Model;
using detail::Outcome;
using detail::Point;
using detail::Round;
using detail::RoundResult;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The problem with every optional vector filled in, after its checks.
LeastSquaresProblem completed(LeastSquaresProblem problem) {
  const Index n = problem.start.size();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto fill = [n](VectorXd& vector, double value) {
    if (vector.size() == 0) {
      vector = VectorXd::Constant(n, value);
    }
  };
  fill(problem.lower, -infinity);
  fill(problem.upper, infinity);
  const bool has_typical = problem.typical.size() != 0;
  fill(problem.typical, 1.0);
  if (problem.lower.size() != n || problem.upper.size() != n || problem.typical.size() != n || !problem.evaluate ||
      problem.residual_count < 0 || (!problem.names.empty() && std::ssize(problem.names) != n)) {
    throw std::invalid_argument("least squares: vectors of different lengths, or no residuals");
  }
  Diagnostics diagnostics;
  for (Index j = 0; j < n; ++j) {
    if (problem.names.empty() || std::ssize(problem.names) < n) {
      problem.names.push_back(fmt::format("parameter {}", j + 1));
    }
    const std::string& name = problem.names[static_cast<std::size_t>(j)];
    const double low = problem.lower[j];
    const double high = problem.upper[j];
    const double start = problem.start[j];
    if (!(low <= high)) {
      diagnostics.error(error::no_room_in_bounds, {},
                        fmt::format("The bounds of {}, {} to {}, leave no room.", name, low, high),
                        "Give a minimum that is not above the maximum.");
    } else if (!(low <= start && start <= high) || !std::isfinite(start)) {
      diagnostics.error(error::no_room_in_bounds, {},
                        fmt::format("{} starts at {}, outside its bounds {} to {}.", name, start, low, high),
                        "Start inside the bounds, or widen them.");
    }
    if (!has_typical) {
      const double width = high - low;
      problem.typical[j] = start != 0.0 ? std::fabs(start) : (std::isfinite(width) && width > 0.0 ? 0.5 * width : 1.0);
    } else if (!(problem.typical[j] > 0.0)) {
      throw std::invalid_argument("least squares: a typical size that is not positive");
    }
  }
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
  return problem;
}

/// Scales at a point: ‖r‖ (by the loss), with a floor where the data are met to six digits beyond the model's own
/// size, and ‖∂r/∂xⱼ‖.
struct Scales {
  double residual = 1.0;
  VectorXd columns{};
};

Scales scales_at(const LeastSquaresProblem& problem, const Point& point) {
  Scales scales;
  scales.columns = point.jacobian.colwise().norm().transpose();
  const double size = scales.columns.cwiseProduct(point.x).lpNorm<Eigen::Infinity>();  // 0 of none
  scales.residual = std::max(std::sqrt(2.0 * point.cost), 1e-6 * size);
  if (!(scales.residual > 0.0)) {
    scales.residual = 1.0;
  }
  for (Index j = 0; j < scales.columns.size(); ++j) {
    if (!(scales.columns[j] > 0.0)) {
      scales.columns[j] = scales.residual / problem.typical[j];  // no influence: any unit will do
    }
  }
  return scales;
}

/// Descends from x by rounds of Ipopt (see the header) and keeps track of who lies on a bound.
class Descent {
 public:
  Descent(Model& model, VectorXd start) : model_(model), problem_(model.problem()), x(std::move(start)) {
    for (Index j = 0; j < x.size(); ++j) {
      at_bound.push_back(problem_.lower[j] == problem_.upper[j] ? AtBound::Held : AtBound::Free);
    }
    released_.assign(at_bound.size(), false);
  }

  void run() {
    const Point* point = model_.at(x, true);
    if (point == nullptr) {
      outcome = {FitStatus::ModelFailed, "no value"};
      return;
    }
    if (free().empty() || point->cost == 0.0) {
      outcome = {FitStatus::Converged, "nothing to do"};
      return;
    }
    Round first{.origin = x, .unit = problem_.typical, .cost_unit = 2.0 * point->cost, .free = free()};
    first.tolerance = 1e-8;
    solve_round(first);
    refine_all();
  }

  /// From a point that is worth more than where the first, wide round would go on to.
  void run_nearby() {
    outcome = {FitStatus::Converged, "nothing to do"};
    refine_all();
  }

  /// Whether the outcome is an end of its own, and not one by a limit, the user or a failure.
  [[nodiscard]] bool may_go_on() const {
    return outcome.status == FitStatus::Converged || outcome.status == FitStatus::NearlyConverged ||
           outcome.status == FitStatus::Stalled;
  }

  /// Takes a point as it is: which of its unknowns lie on bounds that hold them, the gradient says.
  void stay_at(const VectorXd& point) {
    x = point;
    std::ranges::replace_if(
        at_bound, [](AtBound one) { return one != AtBound::Held; }, AtBound::Free);
    released_.assign(at_bound.size(), false);
    if (const Point* const here = model_.at(x, true)) {
      settle_on_bounds(*here, 0.0);
    }
  }

  /// Largest |cosine| between the residual and a free column of the Jacobian.
  [[nodiscard]] double gradient_norm(const Point& point) const {
    const Scales scales = scales_at(problem_, point);
    const VectorXd gradient = model_.gradient(point);
    double largest = 0.0;
    for (const Index j : free()) {
      largest = std::max(largest, std::fabs(gradient[j]) / (scales.columns[j] * scales.residual));
    }
    return largest;
  }

 private:
  [[nodiscard]] std::vector<Index> free() const {
    std::vector<Index> list;
    for (std::size_t j = 0; j < at_bound.size(); ++j) {
      if (at_bound[j] == AtBound::Free) {
        list.push_back(static_cast<Index>(j));
      }
    }
    return list;
  }
  void refine_all() {
    constexpr int most_rounds = 6;
    for (int k = 0; k < most_rounds && may_go_on(); ++k) {
      if (!refine() && at_bounds_is_right()) {
        polish();
        break;
      }
    }
  }

  void solve_round(const Round& round) {
    const RoundResult result = detail::run_ipopt(model_, round);
    outcome = result.outcome;
    // Where the run ended early, the best point ever seen is worth more than the last.
    x = may_go_on() || model_.best.x.size() == 0 ? result.x : model_.best.x;
  }

  /// One round in the scales of the present point; true where its end calls for another.
  bool refine() {
    const Point* point = model_.at(x, true);
    if (point == nullptr) {
      outcome = {FitStatus::ModelFailed, "no value"};
      return false;
    }
    settle_on_bounds(*point, 1e-4);
    point = model_.at(x, true);
    if (point == nullptr || free().empty()) {
      return false;
    }
    const Scales scales = scales_at(problem_, *point);
    Round round{.origin = x, .unit = scales.residual * scales.columns.cwiseInverse()};
    round.cost_unit = scales.residual * scales.residual;
    round.free = free();
    round.bound_push = 1e-8;
    round.barrier = 1e-9;
    round.tolerance = model_.options().tolerance;
    solve_round(round);
    const Point* next = may_go_on() ? model_.at(x, true) : nullptr;
    return next != nullptr && scales_at(problem_, *next).residual < 0.3 * scales.residual;
  }

  /// A parameter that the barrier keeps just inside its bound, within a share of its typical size, against a gradient
  /// that points outwards, is set onto it.
  void settle_on_bounds(const Point& point, double within) {
    const VectorXd gradient = model_.gradient(point);
    for (std::size_t k = 0; k < at_bound.size(); ++k) {
      const auto j = static_cast<Index>(k);
      const double near = within * problem_.typical[j];
      if (at_bound[k] != AtBound::Free || released_[k]) {
        continue;
      }
      if (x[j] - problem_.lower[j] <= near && gradient[j] > 0.0) {
        at_bound[k] = AtBound::Lower;
        x[j] = problem_.lower[j];
      } else if (problem_.upper[j] - x[j] <= near && gradient[j] < 0.0) {
        at_bound[k] = AtBound::Upper;
        x[j] = problem_.upper[j];
      }
    }
  }

  /// Frees a parameter whose gradient at the bound points inwards after all; false where there was one.
  bool at_bounds_is_right() {
    const Point* point = may_go_on() ? model_.at(x, true) : nullptr;
    if (point == nullptr) {
      return true;
    }
    const VectorXd gradient = model_.gradient(*point);
    bool right = true;
    for (std::size_t k = 0; k < at_bound.size(); ++k) {
      const double slope = gradient[static_cast<Index>(k)];
      if ((at_bound[k] == AtBound::Lower && slope < 0.0) || (at_bound[k] == AtBound::Upper && slope > 0.0)) {
        at_bound[k] = AtBound::Free;
        released_[k] = true;
        right = false;
      }
    }
    return right;
  }

  /// Full Gauss-Newton steps as long as each makes the gradient smaller.
  void polish() {
    constexpr int most_steps = 20;
    for (int k = 0; k < most_steps && may_go_on(); ++k) {
      const Point* point = model_.at(x, true);
      if (point == nullptr) {
        return;
      }
      const double before = gradient_norm(*point);
      if (before < 1e-3 * model_.options().tolerance) {
        return;
      }
      const std::vector<Index> columns = free();
      const Scales scales = scales_at(problem_, *point);
      const VectorXd roots = model_.robust() ? VectorXd(model_.weights(point->residuals).cwiseSqrt())
                                             : VectorXd(VectorXd::Ones(point->residuals.size()));
      MatrixXd jacobian(point->residuals.size(), std::ssize(columns));
      for (std::size_t i = 0; i < columns.size(); ++i) {
        jacobian.col(static_cast<Index>(i)) =
            point->jacobian.col(columns[i]).cwiseProduct(roots) / scales.columns[columns[i]];
      }
      const VectorXd step = jacobian.colPivHouseholderQr().solve(-point->residuals.cwiseProduct(roots));
      VectorXd next = x;
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const Index j = columns[i];
        next[j] =
            std::clamp(x[j] + step[static_cast<Index>(i)] / scales.columns[j], problem_.lower[j], problem_.upper[j]);
      }
      const Point* reached = model_.at(next, true);
      if (reached == nullptr || !(gradient_norm(*reached) < 0.9 * before)) {
        return;
      }
      x = next;
    }
  }

  Model& model_;
  const LeastSquaresProblem& problem_;
  std::vector<bool> released_{};

 public:
  VectorXd x;
  Outcome outcome{};
  std::vector<AtBound> at_bound{};
};

double robust_threshold(const VectorXd& residuals) {
  std::vector<double> sizes(residuals.data(), residuals.data() + residuals.size());
  std::transform(sizes.begin(), sizes.end(), sizes.begin(), [](double r) { return std::fabs(r); });
  return 1.345 * deviation_of_median * median(std::move(sizes));
}

/// Ipopt descends the cost and a barrier, and a polish the gradient: where the cost is rough, either may leave a good
/// point for another valley. Another descent begins at the best point that was seen, the start among them, and where
/// that is worse again the point itself is the result.
void keep_best(Model& model, Descent& descent) {
  constexpr double notably = 1e-6;  // of the cost: a thousandth of a standard error at a thousand samples
  constexpr int most_descents = 2;
  (void)model.at(model.problem().start, false);  // by the loss as it is now
  const auto is_worse = [&] {
    const Point* const here = model.at(descent.x, true);
    return model.best.x.size() > 0 && (here == nullptr || model.best.cost < (1.0 - notably) * here->cost);
  };
  for (int k = 0; k < most_descents && is_worse(); ++k) {
    const VectorXd best = model.best.x;
    if (!descent.may_go_on()) {
      break;
    }
    Descent nearby(model, best);
    nearby.run_nearby();
    descent.x = nearby.x;
    descent.outcome = nearby.outcome;
    descent.at_bound = nearby.at_bound;
  }
  if (is_worse()) {
    descent.stay_at(VectorXd(model.best.x));
  }
}

/// Whether each free parameter is known to its own size at least. On a plateau, where a peak has left the samples say,
/// the cost stands still too, and its gradient is small.
bool is_determined(const LeastSquaresResult& result, const LeastSquaresProblem& problem) {
  const double deviation = result.residuals.norm() / std::sqrt(static_cast<double>(result.residuals.size()));
  for (Index j = 0; j < result.x.size(); ++j) {
    const bool is_free = result.at_bound[static_cast<std::size_t>(j)] == AtBound::Free;
    if (is_free && deviation > problem.typical[j] * result.jacobian.col(j).norm()) {
      return false;
    }
  }
  return true;
}

/// Ipopt's word held against the gradient itself, which does not depend on the units of a round.
FitStatus confirmed(const LeastSquaresResult& result, const LeastSquaresProblem& problem, bool stood_still) {
  constexpr double small = 1e-5;
  const bool ended = result.converged() || result.status == FitStatus::Stalled;
  if (!ended) {
    return result.status;
  }
  for (Index j = 0; j < result.x.size(); ++j) {
    const bool is_free = result.at_bound[static_cast<std::size_t>(j)] == AtBound::Free;
    if (is_free && result.cost > 0.0 && result.jacobian.col(j).isZero(0.0)) {
      return FitStatus::NoInfluence;
    }
  }
  if (stood_still && !is_determined(result, problem)) {
    return FitStatus::NoInfluence;
  }
  if (result.gradient_norm <= small) {
    return result.status == FitStatus::Stalled ? FitStatus::NearlyConverged : result.status;
  }
  const bool far = ((result.x - problem.start).array().abs() > 1e6 * problem.typical.array()).any();
  return far ? FitStatus::Diverging : FitStatus::Stalled;
}

LeastSquaresResult report(Model& model, const Descent& descent) {
  LeastSquaresResult result;
  result.x = descent.x;
  result.at_bound = descent.at_bound;
  result.status = descent.outcome.status;
  result.iterations = model.iterations;
  const Point* point = model.at(descent.x, true);
  if (point == nullptr) {
    result.status = FitStatus::ModelFailed;
  } else {
    result.residuals = point->residuals;
    result.jacobian = point->jacobian;
    result.cost = point->cost;
    result.rms =
        std::sqrt(point->residuals.squaredNorm() / static_cast<double>(std::max<Index>(point->residuals.size(), 1)));
    if (model.robust()) {
      result.huber_threshold = model.threshold();
      result.weights = model.weights(point->residuals);
    }
    result.gradient_norm = descent.gradient_norm(*point);
    result.status = confirmed(result, model.problem(), descent.outcome.stood_still);
  }
  result.residual_evaluations = model.residual_evaluations;
  result.jacobian_evaluations = model.jacobian_evaluations;
  result.message = fmt::format("{} (Ipopt: {})", plain_words(result.status), descent.outcome.name);
  return result;
}

}  // namespace

std::string_view plain_words(FitStatus status) {
  switch (status) {
    case FitStatus::Converged:
      return "The fit converged.";
    case FitStatus::NearlyConverged:
      return "The fit converged as far as double precision goes.";
    case FitStatus::IterationLimit:
      return "The limit of iterations was reached before the fit converged; the best point is kept.";
    case FitStatus::Cancelled:
      return "The fit was cancelled; the best point so far is kept.";
    case FitStatus::Stalled:
      return "No step lowers the cost although its gradient is not zero; the model may jump, or its derivatives be "
             "wrong.";
    case FitStatus::NoInfluence:
      return "The fit ended where a parameter no longer has any influence on the residuals. Start elsewhere, or give "
             "bounds.";
    case FitStatus::Diverging:
      return "Parameters ran towards infinity: the record does not determine them. Give bounds, or hold one.";
    case FitStatus::WorseThanConstant:
      return "The fit ended at a model that is no nearer to the record than a constant would be: no solution. Start "
             "elsewhere, from several points with --start 20, or give bounds.";
    case FitStatus::Unbounded:
      return "The fit ended at a model whose output runs away within the record: no solution. Start from parameters at "
             "which the diagram is stable, or give bounds.";
    case FitStatus::ModelFailed:
      return "The model gave no finite values where they were needed; tighten the bounds of the parameters.";
    case FitStatus::SolverFailed:
      return "The solver failed; the best point so far is kept.";
  }
  return "";
}

LeastSquaresResult solve(const LeastSquaresProblem& problem, const LeastSquaresOptions& options) {
  const LeastSquaresProblem complete = completed(problem);
  Model model(complete, options);
  if (model.at(complete.start, false) == nullptr) {
    throw InputError(error::start_without_value, {}, "The model has no finite value at the start of the fit.",
                     "Start from parameters at which the diagram runs without overflow or division by zero.");
  }
  if (options.loss == Loss::Huber && options.huber_threshold > 0.0) {
    model.set_threshold(options.huber_threshold);
  }
  Descent descent(model, complete.start);
  descent.run();
  if (options.loss == Loss::Huber && options.huber_threshold <= 0.0) {
    constexpr int most_rounds = 20;
    for (int k = 0; k < most_rounds; ++k) {
      const Point* point = model.at(descent.x, true);
      const double threshold = point == nullptr ? 0.0 : robust_threshold(point->residuals);
      const bool settled = std::fabs(threshold - model.threshold()) <= 1e-3 * threshold;
      const bool ended = descent.outcome.status != FitStatus::Converged &&
                         descent.outcome.status != FitStatus::NearlyConverged &&
                         descent.outcome.status != FitStatus::Stalled;
      if (!(threshold > 0.0) || settled || ended) {
        break;
      }
      model.set_threshold(threshold);
      const VectorXd from = descent.x;
      Descent again(model, from);
      again.run();
      descent.x = again.x;
      descent.outcome = again.outcome;
      descent.at_bound = again.at_bound;
    }
  }
  keep_best(model, descent);
  return report(model, descent);
}

}  // namespace hysteron
