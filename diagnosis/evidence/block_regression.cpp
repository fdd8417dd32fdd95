#include "diagnosis/evidence/block_regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "diagnosis/evidence/draws.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of each column's own size: keeps a fit without a block solvable where a law acts in that block alone.
constexpr double ridge = 1e-9;
/// Within its slack a row tells nothing; which rows are, follows from the fit, and mostly stands after three.
constexpr int rounds = 6;

VectorXd solved(const MatrixXd& gram, const VectorXd& diagonal, const VectorXd& right) {
  MatrixXd matrix = gram;
  matrix.diagonal() += diagonal;
  return -matrix.ldlt().solve(right);
}

VectorXd ridge_of(const MatrixXd& gram) {
  return (gram.diagonal() * ridge).cwiseMax(1e-300);
}

/// Each share within its bounds; what may be turned round, all of a family on an edge alike.
bool are_within_bounds(std::span<const Law* const> laws, const VectorXd& shares) {
  std::map<std::pair<std::string_view, std::string_view>, std::pair<bool, bool>> ways;  // by family and edge
  Index at = 0;
  for (const Law* law : laws) {
    for (const Law::Term& term : law->terms) {
      const double share = shares[at++];
      if (!term.either_way && !term.holds(share)) {
        return false;
      }
      if (term.either_way) {
        auto& [forwards, backwards] = ways.try_emplace({law->family, law->edge}, true, true).first->second;
        forwards = forwards && term.holds(share);
        backwards = backwards && term.holds(-share);
      }
    }
  }
  return std::ranges::all_of(ways, [](const auto& one) { return one.second.first || one.second.second; });
}

/// What is left beyond a slack.
double beyond(double left, double slack) {
  return std::max(0.0, std::abs(left) - std::abs(slack));
}

}  // namespace

BlockRegression::BlockRegression(const Blocks& blocks, VectorXd residuals, MatrixXd known,
                                 BlockRegressionOptions options)
    : blocks_(blocks),
      residuals_(std::move(residuals)),
      known_(std::move(known)),
      reach_(options.reach.size() > 0 ? std::move(options.reach) : VectorXd::Constant(known_.cols(), infinity)),
      is_held_to_tests_(options.is_held_to_tests),
      weights_(VectorXd::Ones(static_cast<Index>(blocks.outputs()))),
      counts_(MatrixXd::Zero(static_cast<Index>(blocks.count()), static_cast<Index>(blocks.outputs()))) {
  for (const Blocks::Run& run : blocks_.runs()) {
    const auto rows = known_.middleRows(run.first, run.size);
    grams_.emplace_back(rows.transpose() * rows);
    counts_(static_cast<Index>(run.block), static_cast<Index>(run.output)) += static_cast<double>(run.size);
  }
  gap_ = gap_without_laws();
}

BlockRegression::Terms BlockRegression::terms_of(std::span<const Law* const> laws, bool bounded) const {
  Index size = 0;
  bool slack = false;
  for (const Law* law : laws) {
    size += law->responses.cols();
    slack = slack || law->slacks.cols() > 0;
  }
  Terms terms{.columns = MatrixXd(residuals_.size(), size), .low = VectorXd(size), .high = VectorXd(size)};
  if (slack) {
    terms.slacks = MatrixXd::Zero(residuals_.size(), size);
  }
  Index at = 0;
  for (const Law* law : laws) {
    terms.columns.middleCols(at, law->responses.cols()) = law->responses;
    if (law->slacks.cols() > 0) {
      terms.slacks.middleCols(at, law->slacks.cols()) = law->slacks;
    }
    for (const Law::Term& term : law->terms) {
      const bool held = bounded && !term.either_way;
      terms.low[at] = held ? term.lowest : -infinity;
      terms.high[at] = held ? term.highest : infinity;
      ++at;
    }
  }
  return terms;
}

BlockRegression::Products BlockRegression::products_of(const MatrixXd& known, const MatrixXd& columns,
                                                       const VectorXd& residuals, bool is_own) const {
  const Index fixed = known.cols();
  const Index size = fixed + columns.cols();
  const std::vector<Blocks::Run>& runs = blocks_.runs();
  Products result{.grams = std::vector<MatrixXd>(runs.size()),
                  .products = std::vector<VectorXd>(runs.size()),
                  .whole = MatrixXd::Zero(size, size),
                  .product = VectorXd::Zero(size),
                  .of_block = std::vector<MatrixXd>(blocks_.count(), MatrixXd::Zero(size, size)),
                  .product_of_block = std::vector<VectorXd>(blocks_.count(), VectorXd::Zero(size))};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Blocks::Run& run = runs[i];
    const auto law_rows = columns.middleRows(run.first, run.size);
    const auto known_rows = known.middleRows(run.first, run.size);
    const auto residual = residuals.segment(run.first, run.size);
    MatrixXd& gram = result.grams[i];
    gram.resize(size, size);
    if (is_own) {
      gram.topLeftCorner(fixed, fixed) = grams_[i];
    } else {
      gram.topLeftCorner(fixed, fixed).noalias() = known_rows.transpose() * known_rows;
    }
    gram.topRightCorner(fixed, size - fixed).noalias() = known_rows.transpose() * law_rows;
    gram.bottomLeftCorner(size - fixed, fixed) = gram.topRightCorner(fixed, size - fixed).transpose();
    gram.bottomRightCorner(size - fixed, size - fixed).noalias() = law_rows.transpose() * law_rows;
    VectorXd& here = result.products[i];
    here.resize(size);
    here.head(fixed).noalias() = known_rows.transpose() * residual;
    here.tail(size - fixed).noalias() = law_rows.transpose() * residual;
    const double weight = weights_[static_cast<Index>(run.output)];
    result.whole += weight * gram;
    result.product += weight * here;
    result.of_block[run.block] += weight * gram;
    result.product_of_block[run.block] += weight * here;
  }
  return result;
}

BlockRegression::Products BlockRegression::settled(const Terms& terms) const {
  MatrixXd known = known_;
  MatrixXd columns = terms.columns;
  VectorXd residuals = residuals_;
  const Index fixed = known_.cols();
  Products products = products_of(known, columns, residuals, true);
  std::vector<int> sides(static_cast<std::size_t>(residuals_.size()), 2);
  for (int round = 0; round < rounds; ++round) {
    const VectorXd all = solved(products.whole, ridge_of(products.whole), products.product);
    if (!all.allFinite()) {
      break;
    }
    bool moved = false;
    const VectorXd left = residuals_ + known_ * all.head(fixed) + terms.columns * all.tail(terms.columns.cols());
    const VectorXd slack = terms.slacks * all.tail(terms.columns.cols());
    for (Index row = 0; row < residuals_.size(); ++row) {
      if ((terms.slacks.row(row).array() == 0.0).all()) {
        continue;
      }
      // Of the two ends of what the laws give the nearer one counts: at v + 2s where that is 1, at v - 2s where -1.
      const int nearer = (left[row] > 0.0) == (slack[row] > 0.0) ? -1 : 1;
      const int side = std::abs(left[row]) <= std::abs(slack[row]) ? 0 : nearer;
      int& before = sides[static_cast<std::size_t>(row)];
      if (side == before) {
        continue;
      }
      before = side;
      moved = true;
      if (side == 0) {
        known.row(row).setZero();
        columns.row(row).setZero();
        residuals[row] = 0.0;
      } else {
        known.row(row) = known_.row(row);
        columns.row(row) = terms.columns.row(row) + side * terms.slacks.row(row);
        residuals[row] = residuals_[row];
      }
    }
    if (!moved) {
      break;
    }
    products = products_of(known, columns, residuals, false);
  }
  return products;
}

BlockRegression::Score BlockRegression::with(std::span<const Law* const> laws, bool bounded) const {
  const Terms terms = terms_of(laws, bounded);
  const Index fixed = known_.cols();
  const Index own = terms.columns.cols();
  const bool slack = terms.slacks.cols() > 0;
  const Products sums = slack ? settled(terms) : products_of(known_, terms.columns, residuals_, true);
  const VectorXd diagonal = ridge_of(sums.whole);
  Score score{.held_out = MatrixXd::Zero(static_cast<Index>(blocks_.count()), static_cast<Index>(blocks_.outputs()))};
  const VectorXd all = solved(sums.whole, diagonal, sums.product);
  if (!all.allFinite()) {
    return score;
  }
  score.known = all.head(fixed);
  score.shares = all.tail(own);
  score.allowed =
      !bounded || (are_within_bounds(laws, score.shares) && (score.known.array().abs() <= reach_.array()).all());
  if (!score.allowed) {
    return score;
  }
  std::vector<VectorXd> without(blocks_.count());
  for (std::size_t b = 0; b < blocks_.count(); ++b) {
    without[b] = solved(sums.whole - sums.of_block[b], diagonal, sums.product - sums.product_of_block[b]);
    // A part that acts in this block alone is 0 elsewhere; of bounded shares no fit may leave its bounds.
    without[b].tail(own) = without[b].tail(own).cwiseMax(terms.low).cwiseMin(terms.high);
    if (!without[b].allFinite()) {
      score.allowed = false;
      return score;
    }
  }
  const auto count = static_cast<double>(without.size());
  VectorXd mean = VectorXd::Zero(fixed + own);
  for (const VectorXd& one : without) {
    mean += one / count;
  }
  score.errors = VectorXd::Zero(own);
  for (const VectorXd& one : without) {
    score.errors += (one - mean).tail(own).cwiseAbs2();
  }
  score.errors = (score.errors * ((count - 1.0) / count)).cwiseSqrt();
  if (slack) {
    score.held_out = left_with_slack(terms, without);
    return score;
  }
  const std::vector<Blocks::Run>& runs = blocks_.runs();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Blocks::Run& run = runs[i];
    const VectorXd& c = without[run.block];
    const double energy = residuals_.segment(run.first, run.size).squaredNorm() + 2.0 * c.dot(sums.products[i]) +
                          c.dot(sums.grams[i] * c);
    score.held_out(static_cast<Index>(run.block), static_cast<Index>(run.output)) += std::max(0.0, energy);
  }
  return score;
}

MatrixXd BlockRegression::left_with_slack(const Terms& terms, const std::vector<VectorXd>& without) const {
  struct Open {
    const Blocks::Run* run = nullptr;
    double beyond = 0.0;  ///< the squares of what lies beyond the slack, and of what is missing there without laws
    double gap = 0.0;
  };
  const Index fixed = known_.cols();
  const Index own = terms.columns.cols();
  MatrixXd held_out = MatrixXd::Zero(counts_.rows(), counts_.cols());
  const auto energy = [&](const Blocks::Run& run) -> double& {
    return held_out(static_cast<Index>(run.block), static_cast<Index>(run.output));
  };
  std::vector<Open> open;
  double tested = 0.0;
  double tested_gap = 0.0;
  for (const Blocks::Run& run : blocks_.runs()) {
    const VectorXd& c = without[run.block];
    const auto slack_rows = terms.slacks.middleRows(run.first, run.size);
    const auto gap = gap_.segment(run.first, run.size);
    const VectorXd left = residuals_.segment(run.first, run.size) +
                          known_.middleRows(run.first, run.size) * c.head(fixed) +
                          terms.columns.middleRows(run.first, run.size) * c.tail(own);
    const VectorXd free = slack_rows * c.tail(own);
    const double weight = weights_[static_cast<Index>(run.output)];
    for (Index row = 0; row < run.size; ++row) {
      if ((slack_rows.row(row).array() == 0.0).all()) {
        energy(run) += left[row] * left[row];
        tested += weight * left[row] * left[row];
        tested_gap += weight * gap[row] * gap[row];
      } else {
        const double out = beyond(left[row], free[row]);
        open.push_back({.run = &run, .beyond = out * out, .gap = gap[row] * gap[row]});
      }
    }
  }
  const double share = !is_held_to_tests_ ? 0.0 : tested_gap > 0.0 ? tested / tested_gap : 1.0;
  for (const Open& row : open) {
    energy(*row.run) += std::max(row.beyond, share * row.gap);
  }
  return held_out;
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

VectorXd BlockRegression::gap_without_laws() const {
  const Products sums = products_of(known_, MatrixXd(residuals_.size(), 0), residuals_, true);
  VectorXd refitted(residuals_.size());
  for (const Blocks::Run& run : blocks_.runs()) {
    const VectorXd c = solved(sums.whole - sums.of_block[run.block], ridge_of(sums.whole),
                              sums.product - sums.product_of_block[run.block]);
    refitted.segment(run.first, run.size) =
        residuals_.segment(run.first, run.size) + known_.middleRows(run.first, run.size) * c;
  }
  return refitted.squaredNorm() < residuals_.squaredNorm() ? refitted : residuals_;
}

void BlockRegression::weigh(const MatrixXd& held_out) {
  for (Index output = 0; output < held_out.cols(); ++output) {
    weights_[output] = counts_.col(output).sum() / std::max(held_out.col(output).sum(), 1e-300);
  }
}

double BlockRegression::log_square(const MatrixXd& held_out, const VectorXd& weights) const {
  return diagnosis::log_square(held_out, counts_, weights);
}

double BlockRegression::log_square(const MatrixXd& held_out) const {
  return log_square(held_out, VectorXd::Ones(held_out.rows()));
}

}  // namespace hysteron::diagnosis
