#include "tuning/goal/constrained.hpp"

#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "support/numbers.hpp"
#include "tuning/ipopt_application.hpp"

namespace hysteron {
namespace {

using Eigen::VectorXd;

class InequalityProblem : public Ipopt::TNLP {
 public:
  InequalityProblem(const ConstrainedProblem& problem, const ConstrainedOptions& options)
      : problem_(problem), options_(options) {
    result.x = problem.start;
    result.multipliers = VectorXd::Zero(problem.constraint_count);
    const Eigen::Index n = problem.start.size();
    point_.gradient.resize(n);
    point_.constraints.resize(problem.constraint_count);
    point_.jacobian.resize(problem.constraint_count, n);
  }

  bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& nonzeros_jacobian, Ipopt::Index& nonzeros_hessian,
                    IndexStyleEnum& style) override {
    n = static_cast<Ipopt::Index>(problem_.start.size());
    m = static_cast<Ipopt::Index>(problem_.constraint_count);
    nonzeros_jacobian = n * m;
    nonzeros_hessian = 0;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Ipopt::Index n, double* low, double* high, Ipopt::Index m, double* g_low,
                       double* g_high) override {
    for (Ipopt::Index j = 0; j < n; ++j) {
      low[j] = (problem_.lower[j] - problem_.start[j]) / problem_.typical[j];
      high[j] = (problem_.upper[j] - problem_.start[j]) / problem_.typical[j];
    }
    std::fill(g_low, g_low + m, -infinity);
    std::fill(g_high, g_high + m, 0.0);
    return true;
  }
  bool get_starting_point(Ipopt::Index n, bool /*with_x*/, double* z, bool /*with_z*/, double* /*z_low*/,
                          double* /*z_high*/, Ipopt::Index /*m*/, bool /*with_lambda*/, double* /*lambda*/) override {
    std::fill(z, z + n, 0.0);
    return true;
  }
  bool eval_f(Ipopt::Index /*n*/, const double* z, bool /*is_new*/, double& value) override {
    const bool valid = evaluate(z);
    value = point_.cost;
    return valid;
  }
  bool eval_grad_f(Ipopt::Index n, const double* z, bool /*is_new*/, double* gradient) override {
    if (!evaluate(z)) {
      return false;
    }
    for (Ipopt::Index j = 0; j < n; ++j) {
      gradient[j] = point_.gradient[j] * problem_.typical[j];
    }
    return true;
  }
  bool eval_g(Ipopt::Index /*n*/, const double* z, bool /*is_new*/, Ipopt::Index m, double* g) override {
    if (!evaluate(z)) {
      return false;
    }
    std::copy(point_.constraints.data(), point_.constraints.data() + m, g);
    return true;
  }
  bool eval_jac_g(Ipopt::Index n, const double* z, bool /*is_new*/, Ipopt::Index m, Ipopt::Index /*nonzeros*/,
                  Ipopt::Index* rows, Ipopt::Index* columns, double* values) override {
    if (values != nullptr && !evaluate(z)) {
      return false;
    }
    for (Ipopt::Index i = 0, entry = 0; i < m; ++i) {
      for (Ipopt::Index j = 0; j < n; ++j, ++entry) {
        if (values == nullptr) {
          rows[entry] = i;
          columns[entry] = j;
        } else {
          values[entry] = point_.jacobian(i, j) * problem_.typical[j];
        }
      }
    }
    return true;
  }
  bool intermediate_callback(Ipopt::AlgorithmMode /*mode*/, Ipopt::Index iteration, double /*value*/,
                             double /*infeasibility*/, double /*gradient*/, double /*barrier*/, double /*step*/,
                             double /*regularization*/, double /*alpha_dual*/, double /*alpha_primal*/,
                             Ipopt::Index /*trials*/, const Ipopt::IpoptData* /*data*/,
                             Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    return !failure && (!options_.progress || options_.progress(iteration));
  }
  void finalize_solution(Ipopt::SolverReturn /*status*/, Ipopt::Index /*n*/, const double* z, const double* /*z_low*/,
                         const double* /*z_high*/, Ipopt::Index m, const double* /*g*/, const double* lambda,
                         double /*value*/, const Ipopt::IpoptData* /*data*/,
                         Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    result.x = unscaled(z);
    std::copy(lambda, lambda + m, result.multipliers.data());
  }

 private:
  /// Rounding may not take an unknown over its bound.
  [[nodiscard]] VectorXd unscaled(const double* z) const {
    VectorXd x = problem_.start;
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      x[j] = std::clamp(problem_.start[j] + problem_.typical[j] * z[j], problem_.lower[j], problem_.upper[j]);
    }
    return x;
  }
  /// The point at z, evaluated once. Exceptions do not pass through Ipopt's frames: they are kept, and thrown again.
  bool evaluate(const double* z) {
    if (failure) {
      return false;
    }
    VectorXd x = unscaled(z);
    if (is_known_ && x == x_) {
      return is_valid_;
    }
    x_ = std::move(x);
    is_known_ = true;
    try {
      is_valid_ = problem_.evaluate(x_, point_) && std::isfinite(point_.cost) && point_.gradient.allFinite() &&
                  point_.constraints.allFinite() && point_.jacobian.allFinite();
    } catch (...) {
      failure = std::current_exception();
      is_valid_ = false;
    }
    return is_valid_;
  }

  const ConstrainedProblem& problem_;
  const ConstrainedOptions& options_;
  ConstrainedPoint point_{};
  VectorXd x_{};
  bool is_known_ = false;
  bool is_valid_ = false;

 public:
  ConstrainedResult result{};
  std::exception_ptr failure{};
};

}  // namespace

ConstrainedResult solve(const ConstrainedProblem& problem, const ConstrainedOptions& options) {
  const auto application =
      detail::quiet_application({.tolerance = options.tolerance, .max_iterations = options.max_iterations});
  const auto settings = application->Options();
  settings->SetStringValue("hessian_approximation", "limited-memory");
  settings->SetIntegerValue("limited_memory_max_history", 20);
  settings->SetNumericValue("constr_viol_tol", 1e-7);
  settings->SetNumericValue("acceptable_constr_viol_tol", 1e-6);
  settings->SetNumericValue("mu_init", options.barrier);
  settings->SetNumericValue("bound_push", std::min(1e-2, options.barrier));
  settings->SetNumericValue("bound_frac", std::min(1e-2, options.barrier));
  const Ipopt::SmartPtr<InequalityProblem> inequality = new InequalityProblem(problem, options);
  if (const auto initialized = detail::initialize(*application); initialized != Ipopt::Solve_Succeeded) {
    inequality->result.status = detail::translate(initialized).status;
    return inequality->result;
  }
  const auto code = application->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(inequality)));
  if (inequality->failure) {
    std::rethrow_exception(std::exchange(inequality->failure, nullptr));
  }
  inequality->result.status = detail::translate(code).status;
  return std::move(inequality->result);
}

}  // namespace hysteron
