#include "codegen/graph/unit_solver.hpp"

#include <algorithm>

namespace hysteron::units {

std::uint32_t UnitSolver::add(std::size_t count) {
  const auto first = static_cast<std::uint32_t>(solutions_.size());
  solutions_.resize(solutions_.size() + count);
  return first;
}

bool UnitSolver::is_flat(const Unit& unit) const {
  return std::ranges::none_of(unit.variables, [&](const auto& one) { return solutions_[one.first].has_value(); });
}

/// Replaces the solved variables of a unit once: enough where their solutions are flat.
Unit UnitSolver::replaced(const Unit& unit) const {
  Unit result;
  result.factor = unit.factor;
  result.powers = unit.powers;
  result.symbols = unit.symbols;
  result.declared = unit.declared;
  for (const auto& [variable, power] : unit.variables) {
    if (solutions_[variable]) {
      result.multiply(*solutions_[variable], power);
    } else {
      result.add_variable(variable, power);
    }
  }
  return result;
}

// A solution may name variables that were solved after it, and so on, as deep as a chain of blocks is long: hence a
// stack of our own. What was followed once is written back, so that nobody follows it again.
void UnitSolver::flatten(std::uint32_t variable) {
  open_.assign(1, variable);
  while (!open_.empty()) {
    std::optional<Unit>& solution = solutions_[open_.back()];
    if (!solution || is_flat(*solution)) {
      open_.pop_back();
      continue;
    }
    const std::size_t depth = open_.size();
    for (const auto& [inner, power] : solution->variables) {
      if (solutions_[inner] && !is_flat(*solutions_[inner])) {
        open_.push_back(inner);
      }
    }
    if (open_.size() == depth) {
      solution = replaced(*solution);
      open_.pop_back();
    }
  }
}

Unit UnitSolver::solved(const Unit& unit) {
  for (const auto& [variable, power] : unit.variables) {
    flatten(variable);
  }
  return replaced(unit);
}

Unit UnitSolver::ratio(const Unit& given, const Unit& expected) {
  Unit quotient = solved(given);
  quotient.multiply(solved(expected), {-1, 1});
  return quotient;
}

void UnitSolver::solve(const Unit& ratio) {
  // The newest variable by the older ones: along a chain all then hang on the first.
  const auto [variable, power] = ratio.variables.back();
  Unit rest = ratio;
  rest.variables.pop_back();
  Unit solution;
  solution.multiply(rest, (power * Fraction{-1, 1}).inverse());
  solutions_[variable] = solution;
}

}  // namespace hysteron::units
