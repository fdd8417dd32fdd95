// Points of the grids on which an effect's parameters are searched.
#pragma once

#include <vector>

#include "diagnosis/effects/starts.hpp"

namespace hysteron::diagnosis {

/// Every combination of the shapes' grids, or where these are many a star: one shape moved, the others in the middle.
/// Strengths are as in `neutral`.
[[nodiscard]] std::vector<VectorXd> shapes_of(const Applied& effect, const Grids& grids, const VectorXd& neutral);

/// Whether two starts would lead to the same place: no parameter differs by a twentieth.
[[nodiscard]] bool is_near(const VectorXd& a, const VectorXd& b);

/// The point of a grid that is nearest to a value.
[[nodiscard]] std::size_t nearest(const std::vector<double>& values, double value);

}  // namespace hysteron::diagnosis
