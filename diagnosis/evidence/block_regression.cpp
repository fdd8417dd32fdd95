#include "diagnosis/evidence/block_regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hysteron::diagnosis {
namespace {

/// Of each column's own size: keeps a fit without a block solvable where a law acts in that block alone.
constexpr double ridge = 1e-9;

}  // namespace

BlockRegression::BlockRegression(const Blocks& blocks, VectorXd residuals, MatrixXd known)
    : blocks_(blocks),
      residuals_(std::move(residuals)),
      known_(std::move(known)),
      weights_(VectorXd::Ones(static_cast<Index>(blocks.outputs()))),
      counts_(MatrixXd::Zero(static_cast<Index>(blocks.count()), static_cast<Index>(blocks.outputs()))) {
  for (const Blocks::Run& run : blocks_.runs()) {
    const auto rows = known_.middleRows(run.first, run.size);
    grams_.emplace_back(rows.transpose() * rows);
    counts_(static_cast<Index>(run.block), static_cast<Index>(run.output)) += static_cast<double>(run.size);
  }
}

BlockRegression::Score BlockRegression::with(std::span<const Law* const> laws, bool bounded) const {
  const Index fixed = known_.cols();
  Index size = fixed;
  for (const Law* law : laws) {
    size += law->responses.cols();
  }
  MatrixXd columns(residuals_.size(), size - fixed);
  VectorXd low(size - fixed);
  VectorXd high(size - fixed);
  Index at = 0;
  for (const Law* law : laws) {
    columns.middleCols(at, law->responses.cols()) = law->responses;
    for (const Law::Term& term : law->terms) {
      low[at] = bounded ? term.lowest : -std::numeric_limits<double>::infinity();
      high[at] = bounded ? term.highest : std::numeric_limits<double>::infinity();
      ++at;
    }
  }
  const auto block_count = static_cast<Index>(blocks_.count());
  const std::vector<Blocks::Run>& runs = blocks_.runs();
  std::vector<MatrixXd> grams(runs.size());
  std::vector<VectorXd> products(runs.size());
  MatrixXd whole = MatrixXd::Zero(size, size);
  VectorXd product = VectorXd::Zero(size);
  std::vector<MatrixXd> of_block(blocks_.count(), MatrixXd::Zero(size, size));
  std::vector<VectorXd> product_of_block(blocks_.count(), VectorXd::Zero(size));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Blocks::Run& run = runs[i];
    const auto law_rows = columns.middleRows(run.first, run.size);
    const auto known_rows = known_.middleRows(run.first, run.size);
    const auto residual = residuals_.segment(run.first, run.size);
    MatrixXd& gram = grams[i];
    gram.resize(size, size);
    gram.topLeftCorner(fixed, fixed) = grams_[i];
    gram.topRightCorner(fixed, size - fixed).noalias() = known_rows.transpose() * law_rows;
    gram.bottomLeftCorner(size - fixed, fixed) = gram.topRightCorner(fixed, size - fixed).transpose();
    gram.bottomRightCorner(size - fixed, size - fixed).noalias() = law_rows.transpose() * law_rows;
    VectorXd& here = products[i];
    here.resize(size);
    here.head(fixed).noalias() = known_rows.transpose() * residual;
    here.tail(size - fixed).noalias() = law_rows.transpose() * residual;
    const double weight = weights_[static_cast<Index>(run.output)];
    whole += weight * gram;
    product += weight * here;
    of_block[run.block] += weight * gram;
    product_of_block[run.block] += weight * here;
  }
  VectorXd diagonal = whole.diagonal() * ridge;
  diagonal = diagonal.cwiseMax(1e-300);
  const auto solved = [&](const MatrixXd& gram, const VectorXd& right) -> VectorXd {
    MatrixXd matrix = gram;
    matrix.diagonal() += diagonal;
    return -matrix.ldlt().solve(right);
  };
  Score score{.held_out = MatrixXd::Zero(block_count, static_cast<Index>(blocks_.outputs()))};
  const VectorXd all = solved(whole, product);
  if (!all.allFinite()) {
    return score;
  }
  score.known = all.head(fixed);
  score.shares = all.tail(size - fixed);
  score.allowed = (score.shares.array() >= low.array()).all() && (score.shares.array() <= high.array()).all();
  if (!score.allowed) {
    return score;
  }
  std::vector<VectorXd> without(blocks_.count());
  for (std::size_t b = 0; b < blocks_.count(); ++b) {
    without[b] = solved(whole - of_block[b], product - product_of_block[b]);
    // A part that acts in this block alone is 0 elsewhere; of bounded shares no fit may leave its bounds.
    without[b].tail(size - fixed) = without[b].tail(size - fixed).cwiseMax(low).cwiseMin(high);
    if (!without[b].allFinite()) {
      score.allowed = false;
      return score;
    }
  }
  const auto count = static_cast<double>(without.size());
  VectorXd mean = VectorXd::Zero(size);
  for (const VectorXd& one : without) {
    mean += one / count;
  }
  score.errors = VectorXd::Zero(size - fixed);
  for (const VectorXd& one : without) {
    score.errors += (one - mean).tail(size - fixed).cwiseAbs2();
  }
  score.errors = (score.errors * ((count - 1.0) / count)).cwiseSqrt();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const VectorXd& c = without[runs[i].block];
    const double energy =
        residuals_.segment(runs[i].first, runs[i].size).squaredNorm() + 2.0 * c.dot(products[i]) + c.dot(grams[i] * c);
    score.held_out(static_cast<Index>(runs[i].block), static_cast<Index>(runs[i].output)) += std::max(0.0, energy);
  }
  return score;
}

BlockRegression::Score BlockRegression::bare() const {
  Score kept{.allowed = true,
             .held_out = MatrixXd::Zero(counts_.rows(), counts_.cols()),
             .known = VectorXd::Zero(known_.cols())};
  for (const Blocks::Run& run : blocks_.runs()) {
    kept.held_out(static_cast<Index>(run.block), static_cast<Index>(run.output)) +=
        residuals_.segment(run.first, run.size).squaredNorm();
  }
  Score refitted = with({});
  return refitted.allowed && log_square(refitted.held_out) < log_square(kept.held_out) ? refitted : kept;
}

void BlockRegression::weigh(const MatrixXd& held_out) {
  for (Index output = 0; output < held_out.cols(); ++output) {
    weights_[output] = counts_.col(output).sum() / std::max(held_out.col(output).sum(), 1e-300);
  }
}

double BlockRegression::log_square(const MatrixXd& held_out, const VectorXd& weights) const {
  double sum = 0.0;
  for (Index output = 0; output < held_out.cols(); ++output) {
    sum += std::log(std::max(weights.dot(held_out.col(output)) / weights.dot(counts_.col(output)), 1e-300));
  }
  return sum / static_cast<double>(held_out.cols());
}

double BlockRegression::log_square(const MatrixXd& held_out) const {
  return log_square(held_out, VectorXd::Ones(held_out.rows()));
}

}  // namespace hysteron::diagnosis
