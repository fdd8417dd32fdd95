// Ipopt by itself on a static map: its interface TNLP, with the Gauss-Newton Hessian, or with its own approximation of
// one. Default tolerances; without a covariance, which it does not give.
#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <cmath>

#include "bench/rivals/static_map_points.hpp"

namespace {

using Ipopt::Index;
using Ipopt::Number;

class StaticMap : public Ipopt::TNLP {
 public:
  StaticMap(const TwoRows& points, std::vector<double>& solution) : points_(points), solution_(solution) {}

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac, Index& nnz_hessian, IndexStyleEnum& style) override {
    n = 3;
    m = 0;
    nnz_jac = 0;
    nnz_hessian = 6;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* lower, Number* upper, Index, Number*, Number*) override {
    for (Index j = 0; j < n; ++j) {
      lower[j] = -2e19;
      upper[j] = 2e19;
    }
    return true;
  }
  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    const auto start = straight_line(points_);
    std::copy(start.begin(), start.end(), x);
    return true;
  }
  bool eval_f(Index, const Number* x, bool, Number& value) override {
    value = 0.0;
    for (std::size_t i = 0; i < points_.first.size(); ++i) {
      const double residual = x[0] + x[1] * std::pow(points_.first[i], x[2]) - points_.second[i];
      value += 0.5 * residual * residual;
    }
    return true;
  }
  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    gradient[0] = gradient[1] = gradient[2] = 0.0;
    for (std::size_t i = 0; i < points_.first.size(); ++i) {
      const double power = std::pow(points_.first[i], x[2]);
      const double residual = x[0] + x[1] * power - points_.second[i];
      gradient[0] += residual;
      gradient[1] += residual * power;
      gradient[2] += residual * x[1] * power * std::log(points_.first[i]);
    }
    return true;
  }
  bool eval_g(Index, const Number*, bool, Index, Number*) override { return true; }
  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index*, Index*, Number*) override { return true; }
  bool eval_h(Index, const Number* x, bool, Number factor, Index, const Number*, bool, Index, Index* row, Index* column,
              Number* values) override {
    if (values == nullptr) {
      for (Index j = 0, k = 0; j < 3; ++j) {
        for (Index i = 0; i <= j; ++i, ++k) {
          row[k] = j;
          column[k] = i;
        }
      }
      return true;
    }
    std::fill(values, values + 6, 0.0);
    for (const double p : points_.first) {
      const double power = std::pow(p, x[2]);
      const double j[] = {1.0, power, x[1] * power * std::log(p)};
      for (int a = 0, k = 0; a < 3; ++a) {
        for (int b = 0; b <= a; ++b, ++k) {
          values[k] += factor * j[a] * j[b];
        }
      }
    }
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution_.assign(x, x + n);
  }

 private:
  const TwoRows& points_;
  std::vector<double>& solution_;
};

std::vector<double> fit(const TwoRows& points, bool gauss_newton) {
  std::vector<double> solution;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  application->Options()->SetIntegerValue("print_level", 0);
  application->Options()->SetStringValue("sb", "yes");
  application->Options()->SetStringValue("hessian_approximation", gauss_newton ? "exact" : "limited-memory");
  application->Initialize("");
  Ipopt::SmartPtr<Ipopt::TNLP> problem = new StaticMap(points, solution);
  application->OptimizeTNLP(problem);
  return solution;
}

}  // namespace

int main(int, char** arguments) {
  for (const std::size_t size : static_map_sizes) {
    const TwoRows points = static_map_points(arguments[1], size);
    repeat_fit("ipopt_gauss_newton", std::to_string(size), [&] { return fit(points, true); });
    repeat_fit("ipopt_limited_memory", std::to_string(size), [&] { return fit(points, false); });
  }
}
