// An effect in the model, at settings of its parameters: what it changes there.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "diagnosis/effects/grid_points.hpp"
#include "diagnosis/effects/starts.hpp"
#include "diagnosis/model/background.hpp"
#include "diagnosis/search/screening.hpp"

namespace hysteron::diagnosis {

class TriedEffect {
 public:
  /// The grids and the background outlive it.
  TriedEffect(const Task& task, Candidate candidate, const Grids& grids, const VectorXd& at,
              const Background& background);

  // A setting has a value for each parameter of the effect.

  [[nodiscard]] Index parameter_count() const { return neutral_.size(); }
  [[nodiscard]] const EffectParameter& parameter(Index j) const {
    return screened_.candidate.own().parameters[static_cast<std::size_t>(j)];
  }
  [[nodiscard]] const Grid& grid(Index j) const { return grids_.parameters[static_cast<std::size_t>(j)]; }
  [[nodiscard]] const std::vector<double>& points(Index j) const { return grid(j).values; }
  [[nodiscard]] const std::vector<Index>& free() const { return free_; }  ///< the parameters that are unknowns
  [[nodiscard]] const VectorXd& neutral() const { return neutral_; }      ///< neutral, default or setting
  [[nodiscard]] const Background& background() const { return background_; }
  [[nodiscard]] const Applied& own() const { return screened_.candidate.own(); }
  [[nodiscard]] std::vector<VectorXd> shapes() const { return shapes_of(own(), grids_, neutral_); }
  [[nodiscard]] std::vector<Index> strengths() const;

  /// A setting with its strengths off.
  [[nodiscard]] VectorXd shape_of(VectorXd setting) const;
  /// Where a line through the neutral setting of a strength begins.
  [[nodiscard]] double small(Index strength, bool linear) const;
  /// Whether all strengths are sizes of something that is added, so that a straight line is a guess for each of them.
  [[nodiscard]] bool are_amplitudes(const std::vector<Index>& list) const;

  /// Residuals with the effect less those of the background; empty where the model has no value there.
  [[nodiscard]] VectorXd change_at(const VectorXd& setting);
  /// Whether the output is linear in all strengths, asked at the first shape.
  [[nodiscard]] bool is_linear_there(const VectorXd& shape);

  /// Settings that are likely to be tried next, before others that were foreseen.
  void foresee(std::span<const VectorXd> settings);
  /// What each shape asks for first: the change by each of its strengths.
  void foresee_changes(std::span<const VectorXd> shapes);

  /// What was found, to be given away.
  [[nodiscard]] Screened with(std::vector<Start> starts) &&;

 private:
  [[nodiscard]] VectorXd unknowns_at(const VectorXd& setting) const;
  bool is_linear(Index strength, const VectorXd& setting, const VectorXd& change);

  const Grids& grids_;
  const Background& background_;
  Screened screened_{};
  std::optional<Model> model_{};
  Index first_ = 0;  ///< of the effect's unknowns in the model
  std::vector<Index> free_{};
  VectorXd neutral_{};
  VectorXd base_{};             ///< of the model's unknowns
  std::vector<bool> linear_{};  ///< by strength
};

}  // namespace hysteron::diagnosis
