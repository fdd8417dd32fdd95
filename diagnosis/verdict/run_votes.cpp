#include "diagnosis/verdict/run_votes.hpp"

#include <limits>

#include "diagnosis/evidence/draws.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/verdict/held_out.hpp"

namespace hysteron::diagnosis {
namespace {

/// Sums of squares and counts of a run, by block and output.
struct Energies {
  MatrixXd squares{};
  MatrixXd counts{};
};

Energies energies_of(const Task& task, const VectorXd& residuals) {
  const std::vector<HeldOut> outputs = by_blocks(task, residuals);
  const auto blocks = std::ssize(outputs.front().squares);
  Energies result{.squares = MatrixXd(blocks, std::ssize(outputs)), .counts = MatrixXd(blocks, std::ssize(outputs))};
  for (std::size_t output = 0; output < outputs.size(); ++output) {
    const auto column = static_cast<Index>(output);
    result.squares.col(column) = Eigen::Map<const VectorXd>(outputs[output].squares.data(), blocks);
    result.counts.col(column) = Eigen::Map<const VectorXd>(outputs[output].counts.data(), blocks);
  }
  return result;
}

}  // namespace

std::vector<double> votes_of_runs(const Task& task, std::span<const RunSet> sets, std::uint64_t seed,
                                  const Prior& prior, const Rules& rules) {
  std::vector<double> votes(sets.size(), 0.0);
  if (sets.empty()) {
    return votes;
  }
  std::vector<Energies> energies;
  for (const RunSet& one : sets) {
    energies.push_back(energies_of(task, one.residuals));
  }
  const double own_choice = rules[policy::own_choice];
  const double displaced = rules[policy::displaced];
  Draws draws(seed, static_cast<std::size_t>(energies.front().squares.rows()), rules);
  double sum = 0.0;
  for (int draw = 0; draw < static_cast<int>(policy::draws.value); ++draw) {
    draws.draw();
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const double left = log_square(energies[i].squares, energies[i].counts, draws.weights()) +
                          draws.cost(sets[i].families, sets[i].effects) + (sets[i].is_own_choice ? own_choice : 0.0) +
                          displaced * static_cast<double>(sets[i].displaced);
      if (left < least) {
        least = left;
        best = i;
      }
    }
    const double counts = prior.weight_of_set(sets[best].families);
    votes[best] += counts;
    sum += counts;
  }
  for (double& one : votes) {
    one /= sum;
  }
  return votes;
}

}  // namespace hysteron::diagnosis
