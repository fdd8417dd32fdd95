// See ipopt_round.hpp. Ipopt is seen by this source, ipopt_application and goal/constrained.cpp alone.
#include "tuning/ipopt_round.hpp"

#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tuning/ipopt_application.hpp"

namespace hysteron::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class DimensionlessProblem : public Ipopt::TNLP {
 public:
  DimensionlessProblem(Model& model, const Round& round) : model_(model), round_(round), solution(round.origin) {}

  bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& nonzeros_jacobian, Ipopt::Index& nonzeros_hessian,
                    IndexStyleEnum& style) override {
    n = size();
    m = 0;
    nonzeros_jacobian = 0;
    nonzeros_hessian = n * (n + 1) / 2;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Ipopt::Index n, double* low, double* high, Ipopt::Index /*m*/, double* /*g_low*/,
                       double* /*g_high*/) override {
    for (Ipopt::Index k = 0; k < n; ++k) {
      const Index j = round_.free[static_cast<std::size_t>(k)];
      low[k] = (model_.problem().lower[j] - round_.origin[j]) / round_.unit[j];
      high[k] = (model_.problem().upper[j] - round_.origin[j]) / round_.unit[j];
    }
    return true;
  }
  bool get_starting_point(Ipopt::Index n, bool /*with_x*/, double* z, bool /*with_z*/, double* /*z_low*/,
                          double* /*z_high*/, Ipopt::Index /*m*/, bool /*with_lambda*/, double* /*lambda*/) override {
    std::fill(z, z + n, 0.0);
    return true;
  }
  bool eval_f(Ipopt::Index /*n*/, const double* z, bool /*is_new*/, double& value) override {
    return guarded([&] {
      const Point* point = model_.at(unscaled(z), false);
      value = point == nullptr ? 0.0 : point->cost / round_.cost_unit;
      return point != nullptr;
    });
  }
  bool eval_grad_f(Ipopt::Index n, const double* z, bool /*is_new*/, double* gradient) override {
    return guarded([&] {
      const Point* point = model_.at(unscaled(z), true);
      if (point == nullptr) {
        return false;
      }
      const VectorXd all = model_.gradient(*point);
      for (Ipopt::Index k = 0; k < n; ++k) {
        const Index j = round_.free[static_cast<std::size_t>(k)];
        gradient[k] = all[j] * round_.unit[j] / round_.cost_unit;
      }
      return true;
    });
  }
  bool eval_g(Ipopt::Index /*n*/, const double* /*z*/, bool /*is_new*/, Ipopt::Index /*m*/, double* /*g*/) override {
    return true;
  }
  bool eval_jac_g(Ipopt::Index /*n*/, const double* /*z*/, bool /*is_new*/, Ipopt::Index /*m*/,
                  Ipopt::Index /*nonzeros*/, Ipopt::Index* /*rows*/, Ipopt::Index* /*columns*/,
                  double* /*values*/) override {
    return true;
  }
  bool eval_h(Ipopt::Index n, const double* z, bool /*is_new*/, double factor, Ipopt::Index /*m*/,
              const double* /*lambda*/, bool /*new_lambda*/, Ipopt::Index /*nonzeros*/, Ipopt::Index* rows,
              Ipopt::Index* columns, double* values) override {
    if (values == nullptr) {
      for (Ipopt::Index row = 0, entry = 0; row < n; ++row) {
        for (Ipopt::Index column = 0; column <= row; ++column, ++entry) {
          rows[entry] = row;
          columns[entry] = column;
        }
      }
      return true;
    }
    return guarded([&] {
      const Point* point = model_.at(unscaled(z), true);
      if (point == nullptr) {
        return false;
      }
      MatrixXd all = model_.hessian(*point);
      // Marquardt's scaling; a column that has just vanished is remembered for a while.
      const VectorXd now = all.diagonal();
      diagonal_ = diagonal_.size() == 0 ? now : VectorXd(now.cwiseMax(0.3 * diagonal_));
      all.diagonal() += damping_ * diagonal_;
      for (Ipopt::Index row = 0, entry = 0; row < n; ++row) {
        const Index i = round_.free[static_cast<std::size_t>(row)];
        for (Ipopt::Index column = 0; column <= row; ++column, ++entry) {
          const Index j = round_.free[static_cast<std::size_t>(column)];
          values[entry] = factor * all(i, j) * round_.unit[i] * round_.unit[j] / round_.cost_unit;
        }
      }
      return true;
    });
  }
  bool intermediate_callback(Ipopt::AlgorithmMode /*mode*/, Ipopt::Index iteration, double value,
                             double /*infeasibility*/, double gradient, double /*barrier*/, double /*step*/,
                             double /*regularization*/, double /*alpha_dual*/, double /*alpha_primal*/,
                             Ipopt::Index trials, const Ipopt::IpoptData* /*data*/,
                             Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    iterations = iteration;
    adapt_damping(trials);
    if (watch_cost(value)) {
      return false;
    }
    if (!model_.options().progress) {
      return true;
    }
    return guarded([&] {
      const double mean =
          2.0 * value * round_.cost_unit / static_cast<double>(std::max<Index>(model_.problem().residual_count, 1));
      return model_.options().progress({model_.iterations + iteration, std::sqrt(mean), gradient});
    });
  }
  void finalize_solution(Ipopt::SolverReturn /*status*/, Ipopt::Index /*n*/, const double* z, const double* /*z_low*/,
                         const double* /*z_high*/, Ipopt::Index /*m*/, const double* /*g*/, const double* /*lambda*/,
                         double /*value*/, const Ipopt::IpoptData* /*data*/,
                         Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    solution = unscaled(z);
  }

 private:
  [[nodiscard]] Ipopt::Index size() const { return static_cast<Ipopt::Index>(round_.free.size()); }

  /// Rounding may not take a parameter over its bound.
  [[nodiscard]] VectorXd unscaled(const double* z) const {
    VectorXd x = round_.origin;
    for (std::size_t k = 0; k < round_.free.size(); ++k) {
      const Index j = round_.free[k];
      x[j] = std::clamp(round_.origin[j] + round_.unit[j] * z[k], model_.problem().lower[j], model_.problem().upper[j]);
    }
    return x;
  }
  /// Levenberg and Marquardt's idea: where the line search had to halve the Gauss-Newton step twice, the next one is
  /// shorter and nearer to the gradient; near the solution the damping is gone. From the 36 starts of NIST's set it
  /// finds 33 certified solutions, without it 31.
  void adapt_damping(Ipopt::Index trials) {
    constexpr double smallest = 0.1;
    constexpr double factor = 10.0;
    if (trials > 2) {
      damping_ = std::max(factor * damping_, smallest);
    } else {
      damping_ = damping_ > smallest ? damping_ / factor : 0.0;
    }
  }
  /// True where the cost has not moved for so long that it will not: at a kink of the model its gradient stays, and
  /// Ipopt, which waits for the gradient, would go to the limit of iterations.
  bool watch_cost(double value) {
    constexpr int patience = 15;
    constexpr double step = 1e-6;  // of the cost: a thousandth of a standard error at a thousand samples
    if (value < (1.0 - step) * marked_cost_) {
      marked_cost_ = value;
      still_ = 0;
    } else {
      ++still_;
    }
    stands_still = still_ >= patience;
    return stands_still;
  }
  /// Exceptions do not pass through Ipopt's frames: they are kept, the run stops, and solve throws them again.
  template <class Body>
  bool guarded(Body body) {
    if (model_.failure) {
      return false;
    }
    try {
      return body();
    } catch (...) {
      model_.failure = std::current_exception();
      return false;
    }
  }

  double damping_ = 0.0;
  double marked_cost_ = std::numeric_limits<double>::infinity();
  int still_ = 0;
  VectorXd diagonal_{};
  Model& model_;
  const Round& round_;

 public:
  VectorXd solution;
  int iterations = 0;
  bool stands_still = false;
};

}  // namespace

RoundResult run_ipopt(Model& model, const Round& round) {
  const auto application = quiet_application(
      {.tolerance = round.tolerance, .max_iterations = model.options().max_iterations - model.iterations});
  const auto options = application->Options();
  options->SetNumericValue("bound_push", round.bound_push);
  options->SetNumericValue("bound_frac", round.bound_push);
  options->SetNumericValue("mu_init", round.barrier);
  const auto initialized = initialize(*application);
  if (initialized != Ipopt::Solve_Succeeded) {
    return {translate(initialized), round.origin};
  }
  const Ipopt::SmartPtr<DimensionlessProblem> dimensionless = new DimensionlessProblem(model, round);
  const auto code = application->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(dimensionless)));
  model.iterations += dimensionless->iterations;
  if (model.failure) {
    std::rethrow_exception(std::exchange(model.failure, nullptr));
  }
  if (code == Ipopt::User_Requested_Stop && dimensionless->stands_still) {
    return {{FitStatus::Stalled, "stopped, the cost stood still", true}, dimensionless->solution};
  }
  return {translate(code), dimensionless->solution};
}

}  // namespace hysteron::detail
