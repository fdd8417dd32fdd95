#include "diagnosis/verdict/jitter.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/effects/added_signal.hpp"
#include "diagnosis/model/parallel.hpp"

namespace hysteron::diagnosis {
namespace {

/// A network draws its delay anew every few samples; more knots than this take longer than they tell.
constexpr std::size_t fewest_samples = 4;
constexpr std::size_t most_knots = 400;
constexpr std::size_t most_values = 10'000'000;
/// Copies of the delayed signal's rate that stand for a linear filter in the delay's place, samples.
constexpr std::array<std::ptrdiff_t, 13> shifts{-64, -32, -16, -8, -4, -2, 0, 2, 4, 8, 16, 32, 64};

/// The rate of a signal, from the samples on either side.
Signal rate_of(const Signal& signal, double sample_time) {
  Signal rate(signal.size(), 0.0);
  for (std::size_t k = 1; k + 1 < signal.size(); ++k) {
    rate[k] = (signal[k + 1] - signal[k - 1]) / (2.0 * sample_time);
  }
  return rate;
}

/// A sample of a record.
struct Knot {
  std::size_t record = 0;
  std::size_t middle = 0;
};

/// What a delay that is longer about a knot, by `size` there and straight down to 0 on either side, takes from a
/// signal.
RecordSignals peak_at(const Knot& knot, std::size_t reach, const RecordSignals& rates, double size) {
  RecordSignals result;
  for (const Signal& rate : rates) {
    result.emplace_back(rate.size(), 0.0);
  }
  const Signal& rate = rates[knot.record];
  const std::size_t end = std::min(rate.size(), knot.middle + reach);
  for (std::size_t k = knot.middle < reach ? 0 : knot.middle - reach + 1; k < end; ++k) {
    const double away = std::abs(static_cast<double>(k) - static_cast<double>(knot.middle));
    result[knot.record][k] = -size * rate[k] * (1.0 - away / static_cast<double>(reach));
  }
  return result;
}

/// The rates so many samples later, which stand still where the record has none.
RecordSignals shifted(const RecordSignals& rates, std::ptrdiff_t samples, double size) {
  RecordSignals result;
  for (const Signal& rate : rates) {
    result.emplace_back(rate.size(), 0.0);
    const auto count = std::ssize(rate);
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, samples); k < std::min(count, count + samples); ++k) {
      result.back()[static_cast<std::size_t>(k)] = size * rate[static_cast<std::size_t>(k - samples)];
    }
  }
  return result;
}

/// How fast the signal moves that leaves the delay.
RecordSignals rates_behind(const Task& task, const AddedSignal& added, const Explanation& one) {
  Task at_fit = task;  // with all that was fitted as known
  at_fit.known.insert(at_fit.known.end(), one.variant.further.begin(), one.variant.further.end());
  const RecordSignals delayed =
      wire_signals(at_fit, *added.program, {added.before}, one.fit.x.head(std::ssize(at_fit.known))).front();
  RecordSignals rates;
  for (const Signal& signal : delayed) {
    rates.push_back(rate_of(signal, task.records.front().sample_time()));
  }
  return rates;
}

std::size_t samples_between_knots(const RecordSignals& rates) {
  std::size_t samples = 1;
  for (const Signal& rate : rates) {
    samples += rate.size();
  }
  const std::size_t affordable = std::max<std::size_t>(1, std::min(most_knots, most_values / samples));
  return std::max(fewest_samples, samples / affordable + 1);
}

std::vector<Knot> knots_over(const RecordSignals& rates, std::size_t reach) {
  std::vector<Knot> knots;
  for (std::size_t e = 0; e < rates.size(); ++e) {
    for (std::size_t k = 0; k < rates[e].size(); k += reach) {
      knots.push_back({.record = e, .middle = k});
    }
  }
  return knots;
}

/// λ and σ² of a residual, and what they leave of it.
struct Likeliest {
  double lambda = 0.0;
  double variance = 0.0;
  double unexplained = 0.0;
};

/// From the eigenvalues of SᵀS and the projections of r on its eigenvectors.
Likeliest likeliest(const VectorXd& eigenvalues, const VectorXd& projections, double squares, double count) {
  const double scale = eigenvalues.mean();
  Likeliest best{.variance = squares / count, .unexplained = std::sqrt(squares / count)};
  for (double power = -4.0; power <= 4.0; power += 0.25) {
    const double lambda = std::pow(10.0, power) / scale;
    double explained = 0.0;
    double determinant = 0.0;
    for (Index k = 0; k < eigenvalues.size(); ++k) {
      const double grown = 1.0 + lambda * std::max(0.0, eigenvalues[k]);
      explained += lambda * projections[k] * projections[k] / grown;
      determinant += std::log(grown);
    }
    const double variance = std::max(0.0, squares - explained) / count;
    const double unexplained = std::sqrt(variance * std::exp(determinant / count));
    if (unexplained < best.unexplained) {
      best = {.lambda = lambda, .variance = variance, .unexplained = unexplained};
    }
  }
  return best;
}

/// By direction that the variation rules, the weakest first: what standardises a projection Eᵀ Sᵀ r on it.
VectorXd standards(const VectorXd& eigenvalues, const Likeliest& fit) {
  constexpr double ruled = 3.0;
  std::vector<double> result;
  for (Index k = 0; k < eigenvalues.size(); ++k) {  // from the smallest
    if (fit.lambda * eigenvalues[k] > ruled) {
      result.push_back(1.0 / std::sqrt(eigenvalues[k] * fit.variance * (1.0 + fit.lambda * eigenvalues[k])));
    }
  }
  return Eigen::Map<const VectorXd>(result.data(), std::ssize(result));
}

double evenness_of(const VectorXd& standardised) {
  constexpr Index fewest = 20;
  if (standardised.size() < fewest) {
    return 1.0;
  }
  const Index strong = standardised.size() / 4;
  const double weak = standardised.head(standardised.size() - strong).squaredNorm();
  return standardised.tail(strong).squaredNorm() / static_cast<double>(strong) /
         std::max(weak / static_cast<double>(standardised.size() - strong), 1e-300);
}

/// What columns leave of others.
MatrixXd less(const Eigen::ColPivHouseholderQR<MatrixXd>& columns, const MatrixXd& of) {
  MatrixXd rotated = columns.householderQ().transpose() * of;
  rotated.topRows(columns.rank()).setZero();
  return columns.householderQ() * rotated;
}

/// 1 − the variance beside both kinds of columns over that beside the known ones, each for its degrees of freedom.
double share_explained(const MatrixXd& columns, const MatrixXd& known, const VectorXd& by) {
  if (by.size() < 2 * (columns.cols() + known.cols())) {
    return 0.0;
  }
  const Eigen::ColPivHouseholderQR<MatrixXd> first(known);
  const VectorXd before = less(first, by);
  const Eigen::ColPivHouseholderQR<MatrixXd> second(less(first, columns));
  const VectorXd after = less(second, before);
  const auto variance = [](const VectorXd& left, Index degrees) {
    return left.squaredNorm() / static_cast<double>(degrees);
  };
  const Index degrees = by.size() - first.rank();
  return std::max(0.0, 1.0 - variance(after, degrees - second.rank()) /
                                 std::max(variance(before, degrees), std::numeric_limits<double>::min()));
}

}  // namespace

const Applied* delay_of(const Explanation& one) {
  const auto found = std::ranges::find(one.variant.effects, "delay", &Applied::effect);
  return found == one.variant.effects.end() ? nullptr : &*found;
}

double mean_delay(const Task& task, const Explanation& one) {
  const std::optional<Index> at = place_in_fit(task, one, delay_of(one)->path_of(FieldRole::DeadTime));
  return at ? one.fit.x[*at] : 0.0;
}

std::optional<JitterResponse> response_to_jitter(const Task& task, const std::string& top, const Explanation& one,
                                                 unsigned threads) {
  const Applied* const delay = delay_of(one);
  if (delay == nullptr) {
    return std::nullopt;
  }
  Diagnostics none;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", one.variant.text, none));
  const Definitions definitions = define(source, none);
  const std::uint32_t index = top_definition(definitions, top);
  const std::vector<Edge> edges = edges_of(definitions, index);
  const Edge* const edge = find_edge(edges, delay->instance + ".XOUT");
  if (edge == nullptr || edge->definition != index) {
    return std::nullopt;
  }
  const std::optional<AddedSignal> added = with_added_signal(*source, *edge, top, one.variant);
  if (!added) {
    return std::nullopt;
  }
  const RecordSignals rates = rates_behind(task, *added, one);
  const VectorXd& as_it_is = one.fit.residuals;
  const double size = 0.1 * task.records.front().sample_time();
  const std::size_t reach = samples_between_knots(rates);
  const std::vector<Knot> knots = knots_over(rates, reach);
  JitterResponse result{.columns = MatrixXd::Zero(as_it_is.size(), std::ssize(knots))};
  in_parallel(knots.size(), threads, [&](std::size_t k) {
    const VectorXd there =
        residuals_with(task, *added, peak_at(knots[k], reach, rates, size), one.variant.further, one.fit.x);
    if (there.size() > 0) {
      result.columns.col(static_cast<Index>(k)) = (there - as_it_is) / size;
    }
  });
  result.fitted = one.fit.jacobian;
  result.filtered = MatrixXd::Zero(as_it_is.size(), std::ssize(shifts));
  in_parallel(shifts.size(), threads, [&](std::size_t j) {
    const VectorXd there =
        residuals_with(task, *added, shifted(rates, shifts[j], size), one.variant.further, one.fit.x);
    if (there.size() > 0) {
      result.filtered.col(static_cast<Index>(j)) = there - as_it_is;
    }
  });
  const Index rows = as_it_is.size() / std::ssize(task.outputs);
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    result.moves.push_back(result.columns.middleRows(output * rows, rows).squaredNorm() > 0.0);
  }
  return std::ranges::any_of(result.moves, std::identity{}) ? std::optional(std::move(result)) : std::nullopt;
}

Jitter jitter_of(const Task& task, const JitterResponse& response, const VectorXd& residuals) {
  VectorXd moved = residuals;  // without the outputs that the delay does not reach
  const Index rows = moved.size() / std::ssize(task.outputs);
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    if (!response.moves[static_cast<std::size_t>(output)]) {
      moved.segment(output * rows, rows).setZero();
    }
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solved(response.columns.transpose() * response.columns);
  const auto projected = [&](const MatrixXd& of) -> MatrixXd {
    return solved.eigenvectors().transpose() * (response.columns.transpose() * of);
  };
  const VectorXd projections = projected(moved);
  const auto count = static_cast<double>(rows * std::ranges::count(response.moves, true) - std::ssize(task.left_out));
  const Likeliest best = likeliest(solved.eigenvalues(), projections, moved.squaredNorm(), std::max(1.0, count));
  Jitter result{.deviation = std::sqrt(best.lambda * best.variance),
                .unexplained = best.unexplained,
                .left = std::sqrt(moved.squaredNorm() / std::max(1.0, count))};
  const double elsewhere = residuals.squaredNorm() - moved.squaredNorm();
  result.everywhere = std::sqrt((best.unexplained * best.unexplained * count + elsewhere) /
                                std::max(1.0, static_cast<double>(residuals.size() - std::ssize(task.left_out))));
  const VectorXd standard = standards(solved.eigenvalues(), best);
  const VectorXd standardised = standard.cwiseProduct(projections.tail(standard.size()));
  result.evenness = evenness_of(standardised);
  const auto standardised_columns = [&](const MatrixXd& of) -> MatrixXd {
    return standard.asDiagonal() * projected(of).bottomRows(standard.size());
  };
  result.filtered =
      share_explained(standardised_columns(response.filtered), standardised_columns(response.fitted), standardised);
  return result;
}

}  // namespace hysteron::diagnosis
