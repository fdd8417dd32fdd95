#include "diagnosis/evidence/gap_budget.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "diagnosis/evidence/gap_kinds.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/policy.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t count_of_kinds = gap_kinds.size();
/// Of the mean square of a column, each of which has the same: from hardly any to what leaves a tenth of it. Those
/// first that are the best more often.
constexpr std::array ridges{1e-3, 1e-1, 1e-5, 10.0, 1e-7};
constexpr std::size_t fewest_blocks = 3;

/// Fits of any of the kinds together, each block predicted by one without it.
class HeldOutFits {
 public:
  HeldOutFits(const Blocks& blocks, const VectorXd& residuals, const MatrixXd& known,
              const std::array<MatrixXd, count_of_kinds>& bases)
      : fixed_(known.cols()) {
    Index size = fixed_;
    for (const MatrixXd& one : bases) {
      begins_.push_back(size);
      size += one.cols();
    }
    begins_.push_back(size);
    MatrixXd columns(residuals.size(), size);
    columns.leftCols(fixed_) = known;
    for (std::size_t kind = 0; kind < count_of_kinds; ++kind) {
      columns.middleCols(begins_[kind], bases[kind].cols()) = bases[kind];
    }
    for (Index j = 0; j < size; ++j) {
      const double length = columns.col(j).norm();
      columns.col(j) *= length > 0.0 ? 1.0 / length : 0.0;
    }
    for (const Blocks::Run& run : blocks.runs()) {
      const auto rows = columns.middleRows(run.first, run.size);
      const auto residual = residuals.segment(run.first, run.size);
      grams_.emplace_back(rows.transpose() * rows);
      products_.emplace_back(rows.transpose() * residual);
      energies_.push_back(residual.squaredNorm());
    }
    whole_ = std::accumulate(grams_.begin() + 1, grams_.end(), grams_.front());
    product_ = std::accumulate(products_.begin() + 1, products_.end(), products_.front());
  }

  /// Σr² of each block; without any kind what the refitted known parameters leave, or what they leave as they are.
  [[nodiscard]] VectorXd left(const std::vector<std::size_t>& kinds) const {
    std::vector<Index> used(static_cast<std::size_t>(fixed_));
    std::iota(used.begin(), used.end(), Index{0});
    for (const std::size_t kind : kinds) {
      for (Index j = begins_[kind]; j < begins_[kind + 1]; ++j) {
        used.push_back(j);
      }
    }
    VectorXd best = Eigen::Map<const VectorXd>(energies_.data(), std::ssize(energies_));
    if (used.empty()) {
      return best;
    }
    const MatrixXd whole = whole_(used, used);
    const VectorXd product = product_(used);
    MatrixXd gram;
    MatrixXd matrix(whole.rows(), whole.cols());
    for (const double ridge : ridges) {
      VectorXd one = VectorXd::Zero(best.size());
      // Energies are not negative: where the first blocks are worse than all of the best, the others are not asked.
      for (Index b = 0; b < one.size() && one.sum() < best.sum(); ++b) {
        const auto block = static_cast<std::size_t>(b);
        gram = grams_[block](used, used);
        const VectorXd here = products_[block](used);
        matrix = whole - gram;
        matrix.diagonal().array() += ridge;  // by which it is positive definite
        const Eigen::LLT<Eigen::Ref<MatrixXd>> factor(matrix);
        const VectorXd x = factor.solve(product - here);
        const double energy = energies_[block] - 2.0 * x.dot(here) + x.dot(gram * x);
        one[b] = factor.info() == Eigen::Success && std::isfinite(energy) ? std::max(0.0, energy) : infinity;
      }
      if (one.sum() < best.sum()) {
        best = one;
      }
    }
    return best;
  }

 private:
  Index fixed_ = 0;
  std::vector<Index> begins_{};  ///< of the columns of each kind, and their end
  std::vector<MatrixXd> grams_{};
  std::vector<VectorXd> products_{};
  std::vector<double> energies_{};
  MatrixXd whole_{};
  VectorXd product_{};
};

/// Of 1 − Σ left / Σ bare over the blocks, twice the standard error by leaving blocks out (the jackknife).
double uncertainty(const VectorXd& left, const VectorXd& bare) {
  const auto count = static_cast<double>(left.size());
  VectorXd shares(left.size());
  for (Index b = 0; b < left.size(); ++b) {
    shares[b] = 1.0 - (left.sum() - left[b]) / std::max(bare.sum() - bare[b], 1e-300);
  }
  constexpr double in_95_percent = 1.96;
  return in_95_percent * std::sqrt((count - 1.0) / count * (shares.array() - shares.mean()).square().sum());
}

}  // namespace

std::optional<GapBudget> gap_budget(const Task& task, const Space& space, const std::string& name, unsigned threads) {
  const bool at_outputs = space.name() == OutputSpace::title;
  const auto named = std::ranges::find(task.outputs, name);
  const auto output = at_outputs && named != task.outputs.end() ? static_cast<std::size_t>(named - task.outputs.begin())
                                                                : std::size_t{0};
  const Blocks blocks(task, 1, static_cast<std::size_t>(policy::blocks.value),
                      static_cast<std::size_t>(policy::rows.value));
  const Index samples = space.residuals().size() / static_cast<Index>(space.outputs());
  const Index first = static_cast<Index>(output) * samples;
  const VectorXd residuals = blocks.thinned(space.residuals().segment(first, samples)).col(0);
  if (blocks.count() < fewest_blocks || !(residuals.squaredNorm() > 0.0) || !residuals.allFinite()) {
    return std::nullopt;
  }
  const MatrixXd known = blocks.thinned(space.known().middleRows(first, samples));
  const std::array<MatrixXd, count_of_kinds> bases = gap_bases(task, space, output, blocks, threads);
  const HeldOutFits fits(blocks, residuals, known, bases);
  std::vector<std::size_t> all(count_of_kinds);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const VectorXd bare = fits.left({});
  const auto closed = [&](const VectorXd& left) { return std::max(0.0, 1.0 - left.sum() / bare.sum()); };
  std::vector<VectorXd> alone(count_of_kinds);
  std::vector<VectorXd> without(count_of_kinds);
  in_parallel(2 * count_of_kinds, threads, [&](std::size_t i) {
    const std::size_t kind = i / 2;
    if (i % 2 == 0) {
      alone[kind] = fits.left({kind});
    } else {
      std::vector<std::size_t> others = all;
      std::erase(others, kind);
      without[kind] = fits.left(others);
    }
  });
  // More columns never hold less, only more to err by: what predicts best of the sets that were fitted is what can be.
  double together = closed(fits.left(all));
  for (std::size_t kind = 0; kind < count_of_kinds; ++kind) {
    together = std::max({together, closed(alone[kind]), closed(without[kind])});
  }
  const double squares = space.residuals().segment(first, samples).squaredNorm();
  GapBudget result{.at = at_outputs ? task.outputs[output] : space.name(),
                   .closed = together,
                   .noise = at_outputs ? std::min(1.0, static_cast<double>(samples) / squares) : 0.0};
  double sum = 0.0;
  for (std::size_t kind = 0; kind < count_of_kinds; ++kind) {
    double others = closed(without[kind]);
    for (std::size_t other = 0; other < count_of_kinds; ++other) {
      others = other == kind ? others : std::max(others, closed(alone[other]));
    }
    KindFinding finding{
        .kind = std::string(gap_kinds[kind].name), .alone = closed(alone[kind]), .only = together - others};
    if (finding.alone > 0.0) {  // else it errs by more than it tells, and has no share that an interval were about
      const double half = uncertainty(alone[kind], bare);
      finding.low = std::max(0.0, finding.alone - half);
      finding.high = std::min(1.0, finding.alone + half);
    }
    finding.share = 0.5 * (finding.alone + finding.only);
    sum += finding.share;
    result.kinds.push_back(std::move(finding));
  }
  for (KindFinding& finding : result.kinds) {
    finding.share *= sum > 0.0 ? together / sum : 0.0;
  }
  std::ranges::stable_sort(result.kinds, std::ranges::greater(), &KindFinding::share);
  return result;
}

}  // namespace hysteron::diagnosis
