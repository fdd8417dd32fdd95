// Unit variables and what is known of them: a union-find over units instead of sets.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "codegen/graph/unit.hpp"

namespace hysteron::units {

class UnitSolver {
 public:
  /// Adds variables of which nothing is known; returns the number of the first.
  std::uint32_t add(std::size_t count);
  /// A unit with all solved variables replaced.
  Unit solved(const Unit& unit);
  /// given / expected, solved: 1 where the two are the same.
  Unit ratio(const Unit& given, const Unit& expected);
  /// Solves `ratio` = 1 for one of its variables, of which it must have at least one.
  void solve(const Unit& ratio);

 private:
  void flatten(std::uint32_t variable);
  [[nodiscard]] bool is_flat(const Unit& unit) const;
  [[nodiscard]] Unit replaced(const Unit& unit) const;

  std::vector<std::optional<Unit>> solutions_;  ///< by variable
  std::vector<std::uint32_t> open_;             ///< used by flatten alone
};

}  // namespace hysteron::units
