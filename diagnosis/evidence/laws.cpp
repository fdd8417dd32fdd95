#include "diagnosis/evidence/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>

#include "codegen/graph/definition.hpp"
#include "diagnosis/effects/grid_points.hpp"
#include "diagnosis/evidence/driver_lines.hpp"
#include "diagnosis/evidence/lone_block.hpp"
#include "diagnosis/evidence/roles.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/noise/spectrum.hpp"
#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {
namespace {

/// A strength that the law is not linear in is as large as it was tried, but for what lies between two points of a
/// grid.
constexpr double share_low = 0.5;
constexpr double share_high = 2.0;
/// Points of a grid by samples of the records: each costs a pass over all of them.
constexpr double strengths_by_samples = 2e5;
constexpr std::size_t fewest_points = 8;
constexpr std::size_t most_points = 30;

double energy(const RecordSignals& signal) {
  double sum = 0.0;
  for (const Signal& one : signal) {
    for (const double value : one) {
      sum += value * value;
    }
  }
  return sum;
}

/// A law before its responses: the signals of its terms.
struct Draft {
  Law law{};
  std::vector<RecordSignals> signals{};
  std::vector<RecordSignals> slacks{};  ///< empty, or of each term
};

/// All settings of one effect on one edge with one set of drivers.
class Settings {
 public:
  Settings(const EffectKind& kind, const Candidate& candidate, const Grids& grids, LoneBlock& block, bool both_ways,
           std::size_t points)
      : kind_(kind), own_(candidate.own()), grids_(grids), block_(block), both_ways_(both_ways), points_(points) {
    neutral_.resize(std::ssize(own_.parameters));
    for (std::size_t j = 0; j < own_.parameters.size(); ++j) {
      const EffectParameter& one = own_.parameters[j];
      const bool set = !std::isnan(grids.settings[j]);
      neutral_[static_cast<Index>(j)] = set ? grids.settings[j] : one.strength ? one.field.neutral : one.field.preset;
      if (one.strength && !set && !grids.parameters[j].values.empty()) {
        strengths_.push_back(static_cast<Index>(j));
      }
    }
    for (const auto& [path, value] : own_.settings) {
      block_.set(path.substr(path.rfind('.') + 1), value);
    }
  }

  [[nodiscard]] std::vector<Draft> list() {
    std::vector<Draft> result;
    for (const VectorXd& shape : shapes_of(own_, grids_, neutral_)) {
      if (auto linear = linear_at(shape)) {
        if (!linear->signals.empty()) {
          result.push_back(std::move(*linear));
        }
      } else {
        points_at(shape, result);
      }
    }
    return result;
  }

 private:
  [[nodiscard]] const EffectParameter& parameter(Index j) const { return own_.parameters[static_cast<std::size_t>(j)]; }
  [[nodiscard]] const std::vector<double>& points(Index j) const {
    return grids_.parameters[static_cast<std::size_t>(j)].values;
  }

  [[nodiscard]] LoneBlock::Added at(const VectorXd& values) {
    for (Index j = 0; j < values.size(); ++j) {
      block_.set(parameter(j).name, values[j]);
    }
    return block_.added();
  }

  [[nodiscard]] Draft draft(const VectorXd& values) const {
    Draft result{.law = {.effect = kind_.id, .edge = own_.edge}};
    for (Index j = 0; j < values.size(); ++j) {
      result.law.shape.emplace_back(parameter(j).name, values[j]);
    }
    return result;
  }

  /// Nothing where the law is not linear in all of its strengths; no signals where it does nothing.
  std::optional<Draft> linear_at(const VectorXd& shape) {
    Draft result = draft(shape);
    for (const Index j : strengths_) {
      const Field& field = parameter(j).field;
      if (!std::isfinite(field.neutral) || is_gap(parameter(j).role) || parameter(j).role == Role::Duration ||
          parameter(j).role == Role::Rate) {
        return std::nullopt;
      }
      const double step = points(j).back() - field.neutral;
      VectorXd values = shape;
      values[j] = field.neutral + step;
      LoneBlock::Added added = at(values);
      RecordSignals& once = added.middle;
      values[j] = field.neutral + 0.5 * step;
      const RecordSignals half = at(values).middle;
      if (once.empty() || half.empty()) {
        return std::nullopt;
      }
      if (energy(once) == 0.0) {
        continue;
      }
      if (energy(combined(once, 1.0, half, -2.0)) > policy::linear.value * policy::linear.value * energy(once)) {
        return std::nullopt;
      }
      const double a = (std::max(field.minimum, field.effect_minimum) - field.neutral) / step;
      const double b = (std::min(field.maximum, field.effect_maximum) - field.neutral) / step;
      Law::Term term{.strength = parameter(j).name,
                     .measure = parameter(j).unit,
                     .unit = step,
                     .neutral = field.neutral,
                     .lowest = std::min(a, b),
                     .highest = std::max(a, b),
                     .either_way = both_ways_};
      std::erase_if(result.law.shape, [&](const auto& one) { return one.first == term.strength; });
      result.law.terms.push_back(std::move(term));
      result.signals.push_back(std::move(once));
      if (!added.slack.empty()) {
        result.slacks.push_back(std::move(added.slack));
      }
    }
    return result;
  }

  void point(const VectorXd& values, std::vector<Draft>& result) {
    RecordSignals signal = at(values).middle;
    if (signal.empty() || energy(signal) == 0.0) {
      return;
    }
    Draft one = draft(values);
    one.law.terms.push_back({.unit = 1.0, .lowest = share_low, .highest = share_high});
    one.signals.push_back(std::move(signal));
    result.push_back(std::move(one));
  }

  /// Each strength by itself over its grid, and all of them at once.
  void points_at(const VectorXd& shape, std::vector<Draft>& result) {
    for (const Index j : strengths_) {
      const std::vector<double>& grid = points(j);
      const std::size_t step = std::max<std::size_t>(1, (grid.size() + points_ - 1) / points_);
      for (std::size_t k = 0; k < grid.size(); k += step) {
        VectorXd values = shape;
        values[j] = grid[k];
        point(values, result);
      }
    }
    if (strengths_.size() > 1) {
      std::size_t longest = 0;
      for (const Index j : strengths_) {
        longest = std::max(longest, points(j).size());
      }
      for (std::size_t k = 0; k < longest; ++k) {
        VectorXd values = shape;
        for (const Index j : strengths_) {
          values[j] = points(j)[std::min(k, points(j).size() - 1)];
        }
        point(values, result);
      }
    }
  }

  const EffectKind& kind_;
  const Applied& own_;
  const Grids& grids_;
  LoneBlock& block_;
  bool both_ways_;
  std::size_t points_;
  VectorXd neutral_{};
  std::vector<Index> strengths_{};
};

/// Whether two laws of one effect cannot be told apart in this space: on two edges with nothing but a gain between
/// them.
bool do_the_same(const Law& a, const Law& b) {
  constexpr double same = 1e-8;
  if (a.effect != b.effect || a.drivers != b.drivers || a.terms.size() != b.terms.size()) {
    return false;
  }
  for (Index k = 0; k < a.responses.cols(); ++k) {
    const double both = a.responses.col(k).dot(b.responses.col(k));
    if (both <= 0.0 ||
        both * both < (1.0 - same) * a.responses.col(k).squaredNorm() * b.responses.col(k).squaredNorm()) {
      return false;
    }
  }
  return true;
}

/// What settles within a small part of a block is a lag by another name.
std::string family_at(const EffectKind& kind, const Law& law, double block) {
  const auto time = std::ranges::find_if(law.shape, [](const auto& one) { return one.first == "T1"; });
  const std::string& family = kind.family;
  return family == "slow_memory" && time != law.shape.end() && time->second < policy::quick.value * block
             ? "linear_dynamics"
             : family;
}

/// Time constants and dead times by ratios of a third of a decade less: nothing is fitted between them.
Grids with_finer_durations(const Applied& effect, Grids grids) {
  for (std::size_t j = 0; j < effect.parameters.size(); ++j) {
    if (effect.parameters[j].role != Role::Duration) {
      continue;
    }
    std::vector<double>& values = grids.parameters[j].values;
    std::vector<double> finer;
    for (std::size_t k = 0; k < values.size(); ++k) {
      finer.push_back(values[k]);
      for (const double part : {1.0 / 3.0, 2.0 / 3.0}) {
        if (k + 1 < values.size() && values[k] > 0.0) {
          finer.push_back(values[k] * std::pow(values[k + 1] / values[k], part));
        }
      }
    }
    values = std::move(finer);
  }
  return grids;
}

/// A smoother spreads what is open for a few samples over all rows, less and less, down to 10⁻³⁰⁰. A row that has a
/// thousandth of it at most is a test of the law like any other.
MatrixXd without_tails(MatrixXd slacks) {
  constexpr double tail = 1e-3;
  for (Index k = 0; k < slacks.cols(); ++k) {
    const double least = tail * slacks.col(k).cwiseAbs().maxCoeff();
    slacks.col(k) = (slacks.col(k).array().abs() <= least).select(0.0, slacks.col(k));
  }
  return slacks;
}

struct Job {
  const EffectKind* kind = nullptr;
  std::size_t place = 0;
  std::vector<const DriverSignal*> drivers{};
};

}  // namespace

std::vector<Law> laws_of(const Task& task, const Space& space, const Explanation& fitted, const Blocks& blocks,
                         const LawOptions& options) {
  Diagnostics none;  // the text compiled before
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", fitted.variant.text, none));
  const std::vector<EffectKind> kinds = effect_kinds(define(source, none));
  const double sample_time = task.records.front().sample_time();
  const std::vector<Space::Place>& places = space.places();
  const std::vector<DriverSignal>& drivers = space.drivers();
  const Hints hints = hints_of(task, fitted.fit.residuals);
  Hints free_hints = hints;
  bar_lines_of(drivers, sample_time, free_hints.frequencies);
  std::vector<Job> jobs;
  std::vector<bool> within_motion;
  within_motion.reserve(places.size());
  for (const Space::Place& place : places) {
    within_motion.push_back(!place.is_port && carries_velocity(place, drivers));
  }
  for (const EffectKind& kind : kinds) {
    if (!is_tried(options.effects, kind.id) || !is_law(kind)) {
      continue;
    }
    const bool oscillates = std::ranges::count(kind.parameters, Role::Frequency, &EffectParameter::role) > 0;
    for (std::size_t place = 0; place < places.size(); ++place) {
      if (!may_act_on(kind, places[place]) || (oscillates && free_hints.frequencies.empty()) || within_motion[place]) {
        continue;
      }
      if (kind.auxiliaries.empty()) {
        jobs.push_back({.kind = &kind, .place = place});
        continue;
      }
      for (const DriverSignal& signal : drivers) {
        if (!may_drive(kind, signal, places[place])) {
          continue;
        }
        if (kind.auxiliaries.size() == 1) {
          jobs.push_back({.kind = &kind, .place = place, .drivers = {&signal}});
          continue;
        }
        for (const DriverSignal& load : drivers) {
          if (may_load(load)) {
            jobs.push_back({.kind = &kind, .place = place, .drivers = {&signal, &load}});
          }
        }
      }
    }
  }
  std::size_t samples = 0;
  for (const records::Record& record : task.records) {
    samples += record.size();
  }
  const std::size_t points = std::clamp(static_cast<std::size_t>(strengths_by_samples / static_cast<double>(samples)),
                                        fewest_points, most_points);
  std::vector<std::vector<Law>> found(jobs.size());
  StrongestPeriods strongest(fitted.fit.residuals, periods_tried);
  in_parallel(jobs.size(), options.threads, [&](std::size_t i) {
    const Job& job = jobs[i];
    const Space::Place& place = places[job.place];
    // What the edge carries as the diagram runs, never a measured output: that would explain itself.
    const RecordSignals& input = place.carried;
    const Extent extent = extent_of(input, sample_time);
    if (!(extent.range() > 0.0)) {
      return;
    }
    Candidate candidate{.kind = *job.kind};
    Applied applied{.effect = job.kind->id, .block = job.kind->block, .edge = place.edge.name, .instance = "E"};
    applied.parameters = job.kind->parameters;
    for (const EffectParameter& one : applied.parameters) {
      applied.paths.push_back("E." + one.name);
    }
    candidate.variant.effects.push_back(std::move(applied));
    const Extent* const auxiliary = job.drivers.empty() ? nullptr : &job.drivers.front()->extent;
    std::vector<Candidate> guesses = other_guesses(candidate, extent, auxiliary);
    guesses.insert(guesses.begin(), candidate);
    std::vector<const RecordSignals*> signals;
    std::vector<std::string> names;
    for (const DriverSignal* one : job.drivers) {
      signals.push_back(&one->values);
      names.push_back(one->name);
    }
    const RecordSignals* const unsure =
        job.kind->by_velocity && job.kind->slides() && space.is_at_once() && !job.drivers.front()->deviations.empty()
            ? &job.drivers.front()->deviations
            : nullptr;
    const bool imposed = job.kind->by_velocity && !job.drivers.empty() && job.drivers.front()->is_imposed();
    for (const Candidate& guess : guesses) {
      std::vector<double> periods;
      if (guess.own().has(Role::Period)) {
        periods = strongest.over(signals.empty() ? input : *signals.front());
      }
      const Grids grids = with_finer_durations(
          guess.own(),
          grids_of(guess, extent, auxiliary, guess.own().has(Role::Frequency) ? free_hints : hints, periods));
      LoneBlock block(*job.kind, input, signals, unsure, sample_time);
      std::vector<Draft> drafts = Settings(*job.kind, guess, grids, block, imposed, points).list();
      std::vector<RecordSignals> all;
      for (Draft& draft : drafts) {
        std::ranges::move(draft.signals, std::back_inserter(all));
        std::ranges::move(draft.slacks, std::back_inserter(all));
      }
      if (all.empty()) {
        continue;
      }
      const MatrixXd changed = space.of(job.place, all);
      if (changed.size() == 0) {
        continue;
      }
      const MatrixXd thin = blocks.thinned(changed);
      Index column = 0;
      for (Draft& draft : drafts) {
        draft.law.drivers = names;
        draft.law.place = job.place;
        draft.law.family = family_at(*job.kind, draft.law, hints.duration / static_cast<double>(blocks.count()));
        draft.law.responses = thin.middleCols(column, std::ssize(draft.law.terms));
        column += std::ssize(draft.law.terms);
        draft.law.slacks = without_tails(thin.middleCols(column, std::ssize(draft.slacks)));
        column += std::ssize(draft.slacks);
        if (draft.law.responses.squaredNorm() > 0.0) {
          found[i].push_back(std::move(draft.law));
        }
      }
    }
  });
  std::vector<Law> result;
  for (std::vector<Law>& list : found) {
    for (Law& law : list) {
      if (std::ranges::none_of(result, [&](const Law& other) { return do_the_same(law, other); })) {
        result.push_back(std::move(law));
      }
    }
  }
  return result;
}

}  // namespace hysteron::diagnosis
