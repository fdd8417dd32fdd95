// Whether a record excites what is to be fitted, before it is fitted.
//
//   Cov = (JᵀJ)⁻¹,   J = ∂(y/σ)/∂θ   at the start, σ the noise of each measured output
//
// These are the standard errors that a fit would have if the diagram were right, the noise white, and the start near
// the solution (Cramér and Rao). What is not right in the diagram makes them larger, never smaller.
#pragma once

#include <string>
#include <vector>

#include "tuning/output_error.hpp"

namespace hysteron {

enum class Excited : std::uint8_t {
  Well,    ///< a standard error of a twentieth of the value at most
  Weakly,  ///< of half of it at most
  No       ///< more, or any value at all would do
};

struct Excitation {
  struct OfParameter {
    std::string name{};
    std::string unit{};
    double value = 0.0;           ///< at the start
    double standard_error = 0.0;  ///< ∞ where the record does not see it
    Excited excited = Excited::No;
  };
  std::vector<OfParameter> parameters{};  ///< initial states among them
  std::vector<std::string> notes{};       ///< which of them act together alone
};

/// `noise`: the standard deviation of each measured output, in its unit, above 0. Of a parameter that does nothing at
/// the start itself (C3 where C2 = 0) a point beside it decides.
/// @throws InputError HY711 where the diagram has no finite value at the start.
[[nodiscard]] Excitation excitation_of(const OutputErrorProblem& problem, const std::vector<double>& noise);

}  // namespace hysteron
