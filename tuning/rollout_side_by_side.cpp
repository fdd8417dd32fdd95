// Rollouts of several points at once: see rollout.hpp.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "tuning/dual_value.hpp"
#include "tuning/rollout.hpp"
#include "tuning/rollout_unknowns.hpp"

namespace hysteron::detail {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Eight points side by side take as long as two to four by themselves.
constexpr std::size_t worth_side_by_side = 4;
/// So many points are foreseen, and of those that were run so many are kept.
constexpr std::size_t most_foreseen = 128;
constexpr std::size_t most_kept = 16;

bool same_bits(const VectorXd& a, const VectorXd& b) {
  return std::ranges::equal(a, b, [](double one, double other) {
    return std::bit_cast<std::uint64_t>(one) == std::bit_cast<std::uint64_t>(other);
  });
}

}  // namespace

void Rollout::foresee(std::vector<VectorXd> points) {
  if (!can_run_side_by_side()) {
    return;
  }
  std::vector<Foreseen> all;
  for (VectorXd& x : points) {
    const auto is_x = [&](const Foreseen& one) { return same_bits(one.x, x); };
    if (const auto known = std::ranges::find_if(foreseen_, is_x); known != foreseen_.end()) {
      all.push_back(std::move(*known));
      foreseen_.erase(known);
    } else if (std::ranges::none_of(all, is_x)) {
      all.push_back({.x = std::move(x)});
    }
  }
  std::ranges::move(foreseen_, std::back_inserter(all));
  all.resize(std::min(all.size(), most_foreseen));
  std::size_t kept = 0;
  std::erase_if(all, [&](const Foreseen& one) { return one.done && ++kept > most_kept; });
  foreseen_ = std::move(all);
}

void Rollout::keep_some() {
  const auto asked = std::ranges::find_if(foreseen_, &Foreseen::asked);
  if (asked != foreseen_.end() && std::ranges::count(foreseen_, true, &Foreseen::done) > std::ptrdiff_t{most_kept}) {
    foreseen_.erase(asked);
  }
}

Rollout::Foreseen* Rollout::among_foreseen(const VectorXd& x) {
  const auto found = std::ranges::find_if(foreseen_, [&](const Foreseen& one) { return same_bits(one.x, x); });
  if (found == foreseen_.end()) {
    return nullptr;
  }
  if (!found->done) {
    std::vector<VectorXd> points;
    std::vector<Foreseen*> those;
    for (auto one = found; one != foreseen_.end() && points.size() < lane_count; ++one) {
      if (!one->done) {
        points.push_back(one->x);
        those.push_back(&*one);
      }
    }
    if (points.size() < worth_side_by_side) {
      foreseen_.erase(found);
      return nullptr;
    }
    std::vector<std::optional<VectorXd>> residuals = residuals_side_by_side(points);
    for (std::size_t k = 0; k < those.size(); ++k) {
      those[k]->done = true;
      those[k]->residuals = std::move(residuals[k]);
    }
  }
  return &*found;
}

std::vector<std::optional<VectorXd>> Rollout::residuals_side_by_side(std::span<const VectorXd> points) {
  std::vector<std::optional<VectorXd>> residuals(points.size(), VectorXd(rows_));
  for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
    Kept* const played = played_side_by_side(points, e, residuals);
    pass_side_by_side((played != nullptr ? played->machines : whole_).side_by_side(), points, e, played, residuals);
  }
  return residuals;
}

Kept* Rollout::played_side_by_side(std::span<const VectorXd> points, std::size_t experiment,
                                   std::vector<std::optional<VectorXd>>& residuals) {
  std::vector<Index> changed = columns_of(experiment);
  std::erase_if(changed, [&](Index column) {
    return std::ranges::all_of(points, [&](const VectorXd& x) { return x[column] == points.front()[column]; });
  });
  std::vector<bool> still = reach_.unreached(changed);
  if (std::ranges::count(still, true) == 0 || !residuals.front()) {
    return nullptr;
  }
  for (Kept* const kept : {unreached_.get(), of_grid_.get(), beside_.get()}) {
    if (kept != nullptr && kept->still == still && holds(*kept, points.front(), experiment)) {
      return kept;
    }
  }
  make_ready(beside_, std::move(still), experiment);
  if (!keeping_pass(points.front(), experiment, *beside_, *residuals.front())) {
    residuals.front().reset();
    return nullptr;
  }
  return beside_.get();
}

void Rollout::pass_side_by_side(Machine<Lanes>& machine, std::span<const VectorXd> points, std::size_t experiment,
                                const Kept* played, std::vector<std::optional<VectorXd>>& residuals) const {
  const auto of = [&](Index column, Index /*seed*/) {
    Lanes value(points.front()[column]);
    for (std::size_t k = 1; k < points.size(); ++k) {
      value.set_lane(k, points[k][column]);
    }
    return value;
  };
  prepare(machine, experiment, of);
  const Experiment& record = problem_.experiments[experiment];
  const std::size_t given = played != nullptr ? played->rest.given.size() : 0;
  std::size_t step = 0;
  std::size_t start = 0;
  Index row = 0;
  for (const records::RowRange& range : record.train) {
    for (; step < range.last; ++step) {
      (void)restarts(machine, experiment, step, start, of);
      set_inputs(machine, record.drive, step);
      for (std::size_t i = 0; i < given; ++i) {
        machine.set_input(played->rest.first_input + i, played->records[experiment].values[step * given + i]);
      }
      machine.step();
      if (step < range.first) {
        continue;
      }
      for (std::size_t output = 0; output < problem_.outputs.size(); ++output) {
        const Lanes y = machine.output(problem_.outputs[output]);
        const Index at = first_row_[experiment][output] + row;
        for (std::size_t k = 0; k < points.size(); ++k) {
          if (!residuals[k]) {
            continue;
          }
          if (!std::isfinite(y.lane(k))) {
            residuals[k].reset();
            continue;
          }
          (*residuals[k])[at] = (y.lane(k) - record.measured[output][step]) / scales_[output];
        }
      }
      ++row;
    }
  }
}

}  // namespace hysteron::detail
