#include "diagnosis/screening.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hysteron::diagnosis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Outputs within this share of twice the change at half the strength: linear in it.
constexpr double linear_within = 0.05;

/// One setting of all shapes, for each combination of their grids.
std::vector<VectorXd> shapes_of(const Applied& effect, const Grids& grids, const VectorXd& neutral) {
  std::vector<VectorXd> shapes{neutral};
  for (std::size_t j = 0; j < effect.parameters.size(); ++j) {
    const std::vector<double>& values = grids.parameters[j].values;
    if (effect.parameters[j].strength || values.empty()) {
      continue;
    }
    std::vector<VectorXd> more;
    for (const VectorXd& shape : shapes) {
      for (const double value : values) {
        more.push_back(shape);
        more.back()[static_cast<Index>(j)] = value;
      }
    }
    shapes = std::move(more);
  }
  return shapes;
}

class Screening {
 public:
  Screening(const Task& task, Candidate candidate, const Grids& grids, const VectorXd& at, const Background& background)
      : grids_(grids), background_(background) {
    screened_.candidate = std::move(candidate);
    const Applied& own = screened_.candidate.own();
    parameters_ = static_cast<Index>(own.parameters.size());
    neutral_.resize(parameters_);
    std::vector<Unknown> further = screened_.candidate.variant.further;
    for (std::size_t j = 0; j < own.parameters.size(); ++j) {
      if (std::isnan(grids.settings[j])) {
        screened_.unknowns.push_back(unknown_of(own.parameters[j], own.paths[j], grids.parameters[j]));
        further.push_back(screened_.unknowns.back());
        free_.push_back(static_cast<Index>(j));
        neutral_[static_cast<Index>(j)] =
            own.parameters[j].strength ? own.parameters[j].field.neutral : screened_.unknowns.back().start;
      } else {
        screened_.candidate.variant.effects.back().settings.emplace_back(own.paths[j], grids.settings[j]);
        neutral_[static_cast<Index>(j)] = grids.settings[j];
      }
    }
    auto program = std::make_shared<Program>(*screened_.candidate.variant.program);
    for (const auto& [path, value] : own.settings) {
      const std::int64_t found = find_parameter(program->graph, path);
      if (found >= 0) {
        program->graph.parameters[static_cast<std::size_t>(found)].value.front() = value;
      }
    }
    screened_.candidate.variant.program = std::move(program);
    model_.emplace(task, *screened_.candidate.variant.program, further);
    first_ = model_->first_further() + static_cast<Index>(screened_.candidate.variant.further.size());
    base_.resize(model_->unknowns());
    base_.head(first_) = at.head(first_);
    base_.tail(model_->unknowns() - first_ - std::ssize(free_)) = at.tail(at.size() - first_);
  }

  Screened run(std::size_t keep) {
    std::vector<Start> starts;
    for (const VectorXd& shape : shapes_of(screened_.candidate.own(), grids_, neutral_)) {
      try_shape(shape, starts);
    }
    std::ranges::stable_sort(starts, [](const Start& a, const Start& b) { return a.gain > b.gain; });
    if (starts.size() > keep) {
      starts.resize(keep);
    }
    for (Start& start : starts) {  // the free ones only
      VectorXd values(std::ssize(free_));
      for (Index k = 0; k < std::ssize(free_); ++k) {
        values[k] = start.values[free_[static_cast<std::size_t>(k)]];
      }
      start.values = std::move(values);
    }
    screened_.starts = std::move(starts);
    return std::move(screened_);
  }

 private:
  [[nodiscard]] const EffectParameter& parameter(Index j) const {
    return screened_.candidate.own().parameters[static_cast<std::size_t>(j)];
  }

  /// The residuals at one setting of the effect's parameters; empty where the model has no value there.
  VectorXd residuals_at(const VectorXd& values) {
    VectorXd x = base_;
    for (Index k = 0; k < std::ssize(free_); ++k) {
      const double value = values[free_[static_cast<std::size_t>(k)]];
      x[first_ + k] = std::clamp(value, model_->lower()[first_ + k], model_->upper()[first_ + k]);
    }
    VectorXd residuals;
    return model_->residuals(x, residuals) ? residuals : VectorXd();
  }

  VectorXd change_at(const VectorXd& values) {
    VectorXd residuals = residuals_at(values);
    if (residuals.size() > 0) {
      residuals -= background_.residuals();
    }
    return residuals;
  }

  [[nodiscard]] std::vector<Index> strengths() const {
    std::vector<Index> list;
    for (Index j = 0; j < parameters_; ++j) {
      if (parameter(j).strength && !grids_.parameters[static_cast<std::size_t>(j)].values.empty()) {
        list.push_back(j);
      }
    }
    return list;
  }

  /// Whether the change at twice a strength is twice the change: asked once for each strength.
  bool is_linear(Index strength, const VectorXd& values, const VectorXd& change) {
    if (!std::isfinite(parameter(strength).field.neutral)) {
      return false;
    }
    VectorXd twice = values;
    twice[strength] += values[strength] - parameter(strength).field.neutral;
    const VectorXd double_change = change_at(twice);
    return double_change.size() > 0 && (double_change - 2.0 * change).norm() <= linear_within * double_change.norm();
  }

  void try_shape(const VectorXd& shape, std::vector<Start>& starts) {
    const std::vector<Index> list = strengths();
    MatrixXd changes(background_.residuals().size(), std::ssize(list));
    bool all_linear = true;
    bool any_change = false;
    VectorXd small = shape;
    for (Index k = 0; k < std::ssize(list) && all_linear; ++k) {
      const Index j = list[static_cast<std::size_t>(k)];
      VectorXd values = shape;
      values[j] = grids_.parameters[static_cast<std::size_t>(j)].values.front();
      small[j] = values[j];
      const VectorXd change = change_at(values);
      if (change.size() == 0) {
        return;
      }
      changes.col(k) = change;
      any_change = any_change || change.squaredNorm() > 0.0;
      if (std::ssize(linear_) <= k) {
        linear_.push_back(is_linear(j, values, change));
      }
      all_linear = linear_[static_cast<std::size_t>(k)];
    }
    if (!all_linear) {
      try_grid(shape, list, starts);
    } else if (any_change) {
      try_linear(shape, small, list, changes, starts);
    }
  }

  void try_linear(const VectorXd& shape, const VectorXd& small, const std::vector<Index>& list, const MatrixXd& changes,
                  std::vector<Start>& starts) {
    VectorXd low(std::ssize(list));
    VectorXd high(std::ssize(list));
    for (Index k = 0; k < std::ssize(list); ++k) {
      const Index j = list[static_cast<std::size_t>(k)];
      const Field& field = parameter(j).field;
      const double size = small[j] - field.neutral;
      const double a = (field.minimum - field.neutral) / size;
      const double b = (field.maximum - field.neutral) / size;
      low[k] = std::min(a, b);
      high[k] = std::max(a, b);
    }
    VectorXd alpha;
    const double gain = background_.gain(changes, low, high, alpha);
    VectorXd values = shape;
    for (Index k = 0; k < std::ssize(list); ++k) {
      const Index j = list[static_cast<std::size_t>(k)];
      values[j] = parameter(j).field.neutral + alpha[k] * (small[j] - parameter(j).field.neutral);
    }
    // What the straight line promises, held against the diagram itself, there and short of there.
    for (const double share : {1.0, 0.3, 0.1}) {
      VectorXd there = shape;
      for (const Index j : list) {
        there[j] += share * (values[j] - shape[j]);
      }
      try_point(there, starts);
      if (!starts.empty() && starts.back().gain > 0.8 * gain) {
        break;
      }
    }
  }

  /// Each strength by itself over its grid, and all of them at once.
  void try_grid(const VectorXd& shape, const std::vector<Index>& list, std::vector<Start>& starts) {
    std::size_t longest = 0;
    for (const Index j : list) {
      const std::vector<double>& grid = grids_.parameters[static_cast<std::size_t>(j)].values;
      longest = std::max(longest, grid.size());
      for (const double value : grid) {
        VectorXd values = shape;
        values[j] = value;
        try_point(values, starts);
        if (grid.size() < 5 && parameter(j).field.minimum < parameter(j).field.neutral) {
          values[j] = 2.0 * parameter(j).field.neutral - value;
          try_point(values, starts);
        }
      }
    }
    const bool limits = std::ranges::all_of(list, [&](Index j) { return std::isinf(parameter(j).field.neutral); });
    for (std::size_t k = 0; limits && list.size() > 1 && k < longest; ++k) {
      VectorXd values = shape;
      for (const Index j : list) {
        const std::vector<double>& grid = grids_.parameters[static_cast<std::size_t>(j)].values;
        values[j] = grid[std::min(k, grid.size() - 1)];
      }
      try_point(values, starts);
    }
  }

  void try_point(const VectorXd& values, std::vector<Start>& starts) {
    const VectorXd change = change_at(values);
    if (change.size() == 0 || change.squaredNorm() == 0.0) {
      return;
    }
    const VectorXd one = VectorXd::Ones(1);
    VectorXd alpha;
    starts.push_back({.values = values, .gain = background_.gain(change, one, one, alpha)});
  }

  const Grids& grids_;
  const Background& background_;
  Screened screened_{};
  std::optional<Model> model_{};
  Index parameters_ = 0;
  Index first_ = 0;             ///< of the effect's unknowns in the model
  std::vector<Index> free_{};   ///< the parameters that are unknowns
  VectorXd neutral_{};          ///< by parameter: neutral, default or setting
  VectorXd base_{};             ///< of the model's unknowns
  std::vector<bool> linear_{};  ///< by strength
};

}  // namespace

Background::Background(const Model& model, const Fit& at) : residuals_(at.residuals), jacobian_(at.jacobian) {
  MatrixXd normal = jacobian_.transpose() * jacobian_;
  normal.diagonal() += model.prior().cwiseAbs2();
  for (Index j = 0; j < normal.rows(); ++j) {  // a parameter without influence, or two that cannot be told apart
    normal(j, j) = normal(j, j) > 0.0 ? normal(j, j) * (1.0 + 1e-9) : 1.0;
  }
  normal_.compute(normal);
  unexplained_ = 0.5 * residuals_.dot(projected(residuals_));
}

VectorXd Background::projected(const VectorXd& v) const {
  if (jacobian_.cols() == 0) {
    return v;
  }
  return v - jacobian_ * normal_.solve(jacobian_.transpose() * v);
}

double Background::gain(const MatrixXd& changes, const VectorXd& low, const VectorXd& high, VectorXd& alpha) const {
  MatrixXd projected_changes(changes.rows(), changes.cols());
  for (Index k = 0; k < changes.cols(); ++k) {
    projected_changes.col(k) = projected(changes.col(k));
  }
  MatrixXd matrix = changes.transpose() * projected_changes;
  const VectorXd slope = projected_changes.transpose() * residuals_;
  for (Index k = 0; k < matrix.rows(); ++k) {
    matrix(k, k) = matrix(k, k) > 0.0 ? matrix(k, k) * (1.0 + 1e-9) : 1.0;
  }
  alpha = (-matrix.ldlt().solve(slope)).cwiseMax(low).cwiseMin(high);
  return -(alpha.dot(slope) + 0.5 * alpha.dot(matrix * alpha));
}

Screened screened(const Task& task, Candidate candidate, const Grids& grids, const VectorXd& at,
                  const Background& background, std::size_t keep) {
  return Screening(task, std::move(candidate), grids, at, background).run(keep);
}

}  // namespace hysteron::diagnosis
