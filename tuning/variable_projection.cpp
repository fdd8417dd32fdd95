// See variable_projection.hpp.
#include "tuning/variable_projection.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hysteron::detail {

using Eigen::ArrayXd;
using Eigen::Index;

namespace {

/// ln 0 for this purpose: x^c3 underflows to nothing, and its products with ln x stay finite.
constexpr double log_of_zero = -1e10;
/// Points worked on at a time, so that the intermediate arrays stay in the first-level cache.
constexpr Index chunk = 512;

}  // namespace

struct VariableProjection::Sums {
  double q = 0.0, qq = 0.0, ql = 0.0, qql = 0.0, qqll = 0.0, qll = 0.0, mq = 0.0, mql = 0.0, mqll = 0.0;
};

VariableProjection::VariableProjection(std::span<const double> x, std::span<const double> m,
                                       std::span<const double> weights)
    : ln_x_(std::ssize(x)), m_(Eigen::Map<const ArrayXd>(m.data(), std::ssize(m))) {
  const Eigen::Map<const ArrayXd> all(x.data(), std::ssize(x));
  ln_x_ = (all > 0.0).select(all.log(), log_of_zero);
  const auto n = static_cast<double>(x.size());
  if (weights.empty()) {
    weight_ = n;
    mean_ = m_.sum() / weight_;
  } else {
    weights_ = Eigen::Map<const ArrayXd>(weights.data(), std::ssize(weights));
    weight_ = weights_.sum();
    mean_ = (weights_ * m_).sum() / weight_;
  }
  m_ -= mean_;
  m_m_ = weights.empty() ? m_.square().sum() : (weights_ * m_.square()).sum();
}

VariableProjection::Sums VariableProjection::sums(double c3) const {
  Sums s;
  Eigen::Array<double, Eigen::Dynamic, 1, 0, chunk, 1> q;
  Eigen::Array<double, Eigen::Dynamic, 1, 0, chunk, 1> wq;
  Eigen::Array<double, Eigen::Dynamic, 1, 0, chunk, 1> wql;
  for (Index first = 0; first < m_.size(); first += chunk) {
    const Index size = std::min(chunk, m_.size() - first);
    const auto l = ln_x_.segment(first, size);
    const auto m = m_.segment(first, size);
    q = (c3 * l).exp();
    if (weights_.size() == 0) {
      wq = q;
    } else {
      wq = weights_.segment(first, size) * q;
    }
    wql = wq * l;
    s.q += wq.sum();
    s.ql += wql.sum();
    s.qll += (wql * l).sum();
    s.mq += (wq * m).sum();
    s.mql += (wql * m).sum();
    s.mqll += (wql * l * m).sum();
    s.qq += (wq * q).sum();
    s.qql += (wql * q).sum();
    s.qqll += (wql * q * l).sum();
  }
  return s;
}

Projection VariableProjection::at(double c3) const {
  const Sums s = sums(c3);
  Projection result;
  const double variance = s.qq - s.q * s.q / weight_;
  if (!(variance > 0.0)) {
    result.cost = cost_of_constant();
    return result;
  }
  result.c2 = s.mq / variance;  // Σ w m = 0
  result.c1 = -result.c2 * s.q / weight_;
  result.cost = std::max(0.5 * (m_m_ - result.c2 * s.mq), 0.0);
  const double c1 = result.c1;
  const double c2 = result.c2;
  const double r_ql = s.mql - c1 * s.ql - c2 * s.qql;      // Σ w r·∂q/∂c3
  const double r_qll = s.mqll - c1 * s.qll - c2 * s.qqll;  // Σ w r·∂²q/∂c3²
  result.slope = -c2 * r_ql;
  // The Hessian in (c1, c2, c3) with c1 and c2 eliminated.
  const auto reduced = [&](double h33, double h13, double h23) {
    // (h13, h23)·[[W, q], [q, qq]]⁻¹·(h13, h23)ᵀ, written without cancellation against h13
    const double along = h23 - h13 * s.q / weight_;
    return h33 - h13 * h13 / weight_ - along * along / variance;
  };
  result.curvature = reduced(c2 * c2 * s.qqll - c2 * r_qll, c2 * s.ql, c2 * s.qql - r_ql);
  result.gauss_newton = reduced(c2 * c2 * s.qqll, c2 * s.ql, c2 * s.qql);
  return result;
}

Eigen::VectorXd VariableProjection::residuals(const Projection& solution, double c3) const {
  return (solution.c1 + solution.c2 * (c3 * ln_x_).exp() - m_).matrix();
}

Eigen::Matrix3d VariableProjection::normal_matrix(const Projection& solution, double c3) const {
  const Sums s = sums(c3);
  const double c2 = solution.c2;
  Eigen::Matrix3d normal;
  normal << weight_, s.q, c2 * s.ql,  //
      s.q, s.qq, c2 * s.qql,          //
      c2 * s.ql, c2 * s.qql, c2 * c2 * s.qqll;
  return normal;
}

namespace {

/// Newton from c3 inside the range; a step may at most halve or double c3, and is halved while the cost rises.
ProjectionSearch newton(const VariableProjection& problem, double c3, double least, double largest, int most_passes) {
  ProjectionSearch search;
  search.c3 = c3;
  search.solution = problem.at(c3);
  search.passes = 1;
  while (search.passes < most_passes) {
    const Projection& here = search.solution;
    const bool convex = here.curvature > 0.01 * here.gauss_newton;
    const double steepness = convex ? here.curvature : here.gauss_newton;
    if (!(steepness > 0.0)) {
      break;
    }
    double step = std::clamp(-here.slope / steepness, -0.5 * search.c3, search.c3);
    const double wanted = std::clamp(search.c3 + step, least, largest);
    if (wanted == search.c3) {
      search.at_least = wanted == least;
      search.at_largest = wanted == largest;
      search.converged = true;
      break;
    }
    step = wanted - search.c3;
    // Newton squares the error: after a step this small nothing is left but rounding.
    const bool last = convex && std::fabs(step) < 1e-8 * search.c3;
    Projection next;
    double reached = wanted;
    for (;;) {
      next = problem.at(reached);
      ++search.passes;
      // Below the rounding of the cost itself the slope decides.
      const bool better = next.cost < here.cost ||
                          (next.cost <= here.cost * (1.0 + 1e-12) && std::fabs(next.slope) <= std::fabs(here.slope)) ||
                          here.cost <= 1e-26 * problem.cost_of_constant();
      if (better || last || search.passes >= most_passes) {
        break;
      }
      step *= 0.5;
      reached = search.c3 + step;
      if (std::fabs(step) < 1e-15 * search.c3) {
        search.converged = true;
        return search;
      }
    }
    search.c3 = reached;
    search.solution = next;
    if (last) {
      search.converged = true;
      break;
    }
  }
  return search;
}

/// Evenly spread points, the first and the last among them.
std::vector<double> thinned(std::span<const double> values, std::size_t wanted) {
  std::vector<double> result;
  if (values.size() <= wanted) {
    result.assign(values.begin(), values.end());
    return result;
  }
  for (std::size_t k = 0; k < wanted; ++k) {
    result.push_back(values[k * (values.size() - 1) / (wanted - 1)]);
  }
  return result;
}

}  // namespace

ProjectionSearch search_c3(const VariableProjection& all, std::span<const double> x, std::span<const double> m,
                           std::span<const double> weights, double least, double largest, int most_passes) {
  constexpr std::size_t few = 512;
  const VariableProjection some(thinned(x, few), thinned(m, few), thinned(weights, few));
  constexpr int candidates = 24;
  std::vector<double> c3(candidates);
  std::vector<double> cost(candidates);
  for (int k = 0; k < candidates; ++k) {
    const auto i = static_cast<std::size_t>(k);
    c3[i] = least * std::pow(largest / least, k / (candidates - 1.0));
    cost[i] = some.at(c3[i]).cost;
  }
  // Every local minimum of the coarse search is refined on the few points; the best of them starts on all.
  ProjectionSearch best;
  bool found = false;
  for (std::size_t k = 0; k < c3.size(); ++k) {
    const bool below_left = k == 0 || cost[k] <= cost[k - 1];
    const bool below_right = k + 1 == c3.size() || cost[k] <= cost[k + 1];
    if (below_left && below_right) {
      const ProjectionSearch local = newton(some, c3[k], least, largest, 30);
      if (!found || local.solution.cost < best.solution.cost) {
        best = local;
        found = true;
      }
    }
  }
  return newton(all, found ? best.c3 : 1.0, least, largest, most_passes);
}

}  // namespace hysteron::detail
