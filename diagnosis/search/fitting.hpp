// The fit of one candidate: from the starts that the screening has found, first a few steps, then to the end.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/search/screening.hpp"

namespace hysteron::diagnosis {

/// A set of effects, fitted.
struct Explanation {
  Variant variant{};
  Fit fit{};
  [[nodiscard]] std::vector<std::string> names() const;   ///< identifiers, sorted
  [[nodiscard]] std::vector<std::string> places() const;  ///< identifiers with their edges, sorted
  [[nodiscard]] Index parameters() const { return std::ssize(variant.further); }
};

[[nodiscard]] double cost_of_fit(const Explanation& one);

/// Where in the fit's x a parameter of its effects stands; nothing where it was not fitted.
[[nodiscard]] std::optional<Index> place_in_fit(const Task& task, const Explanation& one, const std::string& path);

/// Where the known parameters of the bare diagram may stand when a fit begins.
struct KnownStarts {
  VectorXd calibrated{};
  VectorXd other{};  ///< the tuned ones where the screening was about the calibrated ones, else these
};

/// The effect beside what the diagram holds already, where its screening has found it; nothing is fitted.
[[nodiscard]] Explanation placed(const Task& task, const Screened& one, const Start& start, const VectorXd& known);

/// A few steps from each of its best starts, with the known parameters as in `from` and, on the bare diagram, as in
/// `known.other` too. The cost is ∞ where none has a value.
[[nodiscard]] Explanation begun_from(const Task& task, const Screened& one, const Explanation& from,
                                     const KnownStarts& known);

struct FinishOptions {
  bool thoroughly = false;       ///< with single steps by trial where a derivative may not see the way
  std::function<bool()> stop{};  ///< asked between steps: the fit ends where it stands
};

/// To the end, where it stands.
void finish(const Task& task, Explanation& one, const FinishOptions& options = {});

/// What the effects were fitted to is where their next fit begins.
void keep_starts(Explanation& one, const Model& model);

}  // namespace hysteron::diagnosis
