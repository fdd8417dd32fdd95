// The gap of each output: as it was, calibrated, improved, and what is closed of it on stretches held out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

/// Residuals of a verdict, in the scales of the task.
struct GapResiduals {
  const VectorXd& nominal;
  const VectorXd& calibrated;
  const VectorXd& kept;      ///< of the improved diagram
  const VectorXd& held_out;  ///< of the same, on what its fits have not seen
};

/// By output. `seed` is that of the bootstrap.
[[nodiscard]] std::vector<GapFinding> gaps_of(const Task& task, const Graph& graph, const GapResiduals& residuals,
                                              const std::vector<NoiseFloor>& floors, std::uint64_t seed);

/// The output whose gap is the largest, in floors.
[[nodiscard]] std::size_t largest_gap(const Task& task, const std::vector<NoiseFloor>& floors,
                                      const VectorXd& residuals);

/// Whether the refit closed something material in an output: more than a quarter of its floor, and than `material` in
/// its unit.
[[nodiscard]] bool calibration_matters(const Task& task, const std::vector<NoiseFloor>& floors, double material,
                                       const VectorXd& nominal, const VectorXd& calibrated);

/// That a floor rests on fast noise alone, of each output where it does.
[[nodiscard]] std::vector<std::string> remarks_on_floors(const Task& task, const std::vector<NoiseFloor>& floors);

}  // namespace hysteron::diagnosis
