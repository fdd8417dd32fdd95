#include "diagnosis/jitter.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/added_signal.hpp"
#include "diagnosis/discrepancy.hpp"
#include "diagnosis/parallel.hpp"
#include "diagnosis/task.hpp"

namespace hysteron::diagnosis {
namespace {

/// A network draws its delay anew every few samples; more knots than this take longer than they tell.
constexpr std::size_t fewest_samples = 4;
constexpr std::size_t most_knots = 400;
constexpr std::size_t most_values = 10'000'000;
/// Of the energy that a constant delay leaves, what its jitter may leave.
constexpr double most_left = 0.5;
/// A residual of which this share is foretold by inputs and outputs has another cause.
constexpr double foretold = 0.2;
/// Residuals of so many floors' energy are no gap.
constexpr double is_noise = 1.3;
/// Of the mean, what a delay varies by at most: one that varies more is something else.
constexpr double most_varied = 0.7;
/// Of sets with a delay so many are tried, none that leaves more than so many times what the chosen one leaves.
constexpr std::size_t most_sets = 4;
constexpr double far_behind = 4.0;

const Applied* delay_of(const Explanation& one) {
  const auto found = std::ranges::find(one.variant.effects, "delay", &Applied::effect);
  return found == one.variant.effects.end() ? nullptr : &*found;
}

double mean_square(const VectorXd& residuals) {
  return residuals.squaredNorm() / static_cast<double>(std::max<Index>(1, residuals.size()));
}

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

/// The likeliest λ and what it leaves, from the eigenvalues of SᵀS and the projections of r on its eigenvectors.
Jitter likeliest(const VectorXd& eigenvalues, const VectorXd& projections, double squares, double count) {
  const double scale = eigenvalues.mean();
  Jitter best{.deviation = 0.0, .unexplained = std::sqrt(squares / count), .left = std::sqrt(squares / count)};
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
      best.unexplained = unexplained;
      best.deviation = std::sqrt(lambda * variance);
    }
  }
  return best;
}

/// Whether inputs and outputs foretell the residual of an output.
bool is_foretold(const Task& task, const Explanation& one) {
  const Model model(task, *one.variant.program, one.variant.further);
  const Index rows = model.rows() / std::ssize(task.outputs);
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    const VectorXd own = one.fit.residuals.segment(output * rows, rows);
    if (mean_square(own) > is_noise && discrepancy(model.problem().experiments, own).share_low > foretold) {
      return true;
    }
  }
  return false;
}

/// The chosen set and the same with its delay on other edges, since a constant delay commutes with much that its
/// variation does not. Where it has none, those that have one and no more effects, the smallest first.
std::vector<const Explanation*> sets_with_delay(const Search& search, const Explanation& chosen) {
  std::vector<const Explanation*> list;
  const auto has_place = [&](const Explanation& one) {
    return list.size() < most_sets && delay_of(one) != nullptr && one.fit.cost < far_behind * chosen.fit.cost;
  };
  if (delay_of(chosen) != nullptr) {
    list.push_back(&chosen);
    std::set<std::string> edges{delay_of(chosen)->edge};
    for (const Explanation& one : search.explanations) {
      if (has_place(one) && one.names() == chosen.names() && edges.insert(delay_of(one)->edge).second) {
        list.push_back(&one);
      }
    }
    return list;
  }
  std::set<std::vector<std::string>> taken;
  for (std::size_t effects = 1; effects <= chosen.variant.effects.size(); ++effects) {
    for (const Explanation& one : search.explanations) {
      if (one.variant.effects.size() == effects && has_place(one) && taken.insert(one.names()).second) {
        list.push_back(&one);
      }
    }
  }
  return list;
}

/// The dead time of the delay at the fit; 0 where it is none of its parameters.
double mean_delay(const Task& task, const Explanation& one) {
  const std::optional<Index> at = place_in_fit(task, one, delay_of(one)->instance + ".DEAD_TIME");
  return at ? one.fit.x[*at] : 0.0;
}

}  // namespace

std::optional<Jitter> jitter_of(const Task& task, const std::string& top, const Explanation& one, unsigned threads) {
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
  const std::optional<AddedSignal> added = with_added_signal(*source, *edge, top, one.variant.effects);
  if (!added) {
    return std::nullopt;
  }
  const RecordSignals rates = rates_behind(task, *added, one);
  const VectorXd& as_it_is = one.fit.residuals;
  const double size = 0.1 * task.records.front().sample_time();
  const std::size_t reach = samples_between_knots(rates);
  const std::vector<Knot> knots = knots_over(rates, reach);
  MatrixXd responses = MatrixXd::Zero(as_it_is.size(), std::ssize(knots));
  in_parallel(knots.size(), threads, [&](std::size_t k) {
    const VectorXd there =
        residuals_with(task, *added, peak_at(knots[k], reach, rates, size), one.variant.further, one.fit.x);
    if (there.size() > 0) {
      responses.col(static_cast<Index>(k)) = (there - as_it_is) / size;
    }
  });
  VectorXd moved = as_it_is;  // without the outputs that the delay does not reach
  const Index rows = moved.size() / std::ssize(task.outputs);
  std::vector<bool> moves;
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    moves.push_back(responses.middleRows(output * rows, rows).squaredNorm() > 0.0);
    if (!moves.back()) {
      moved.segment(output * rows, rows).setZero();
    }
  }
  const MatrixXd gram = responses.transpose() * responses;
  if (!(gram.trace() > 0.0)) {
    return std::nullopt;
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solved(gram);
  const VectorXd projections = solved.eigenvectors().transpose() * (responses.transpose() * moved);
  const auto count = static_cast<double>(rows * std::ranges::count(moves, true) - std::ssize(task.left_out));
  Jitter result = likeliest(solved.eigenvalues(), projections, moved.squaredNorm(), std::max(1.0, count));
  result.moves = std::move(moves);
  return result;
}

std::optional<Unrepeatable> with_jitter(const Task& task, const std::string& top, const Search& search,
                                        Judgement& judgement, unsigned threads) {
  const Explanation& chosen = *judgement.chosen;
  const double left = mean_square(chosen.fit.residuals);
  if (chosen.variant.effects.empty() || left < is_noise) {
    return std::nullopt;
  }
  const Explanation* best = nullptr;
  Jitter jitter{.unexplained = std::sqrt(most_left * left)};
  for (const Explanation* const one : sets_with_delay(search, chosen)) {
    const std::optional<Jitter> own = jitter_of(task, top, *one, threads);
    const bool larger = best != nullptr && one->variant.effects.size() > best->variant.effects.size();
    if (own && own->unexplained < (larger ? std::sqrt(most_left) : 1.0) * jitter.unexplained &&
        own->deviation < most_varied * mean_delay(task, *one) && !is_foretold(task, *one)) {
      best = one;
      jitter = *own;
    }
  }
  if (best == nullptr) {
    return std::nullopt;
  }
  if (best != &chosen) {
    choose_instead(task, *best, judgement);
  }
  Unrepeatable result{.residuals = best->fit.residuals};
  const Index rows = result.residuals.size() / std::ssize(task.outputs);
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    if (jitter.moves[static_cast<std::size_t>(output)]) {
      result.residuals.segment(output * rows, rows) *= jitter.unexplained / jitter.left;
    }
  }
  result.remark = fmt::format(
      "The delay at {} varies by {:.3g} s RMS about its mean: of the {:.2g} floors that a constant one leaves, {:.2g} "
      "are no consequence of that.",
      in_the_diagram(delay_of(*best)->edge, best->variant.effects), jitter.deviation, jitter.left, jitter.unexplained);
  return result;
}

}  // namespace hysteron::diagnosis
