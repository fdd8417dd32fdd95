// The record as it can be diagnosed: mended where its logger or a sensor spoilt it, with noise floors, beside the
// diagram with the values of its parameter file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/faults/left_out.hpp"
#include "diagnosis/model/input.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/materiality.hpp"
#include "diagnosis/noise/noise_floor.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

struct Cleaned {
  DiagnosisInput input{};  ///< as it was given, with an output for each measured inner signal
  Task task{};
  std::string top{};                       ///< the diagram's top block
  std::shared_ptr<const Program> given{};  ///< with the values of the parameter file
  Variant base{};                          ///< the same with the noise of its sensors in its loops
  std::vector<std::string> inner{};        ///< outputs that are inner signals of the user's diagram
  std::vector<std::string> unused{};       ///< columns that the diagram does not name
  std::vector<NoiseFloor> floors{};
  std::vector<LeftOut> left_out{};
  VectorXd nominal{};                   ///< residuals of `base` against the outputs as they were measured, in floors
  double floor_cost = 0.0;              ///< ½Σr² of noise alone
  bool one_motion = false;              ///< see RecordCheck
  std::vector<std::string> refusals{};  ///< not empty: no diagnosis, and nothing behind the task is filled
  std::vector<std::string> warnings{};
};

/// @throws InputError where the diagram cannot be run over the records.
[[nodiscard]] Cleaned cleaned(const DiagnosisInput& input, const DiagnosisOptions& options);

/// The floors anew: where an input rests, what was taken off the record since had counted as noise.
void find_floors(Cleaned& record);

/// `nominal` anew, without the samples that are left out.
void simulate_nominal(Cleaned& record);

/// It keeps references into the record.
[[nodiscard]] inline Materiality materiality_of(const Cleaned& record, const DiagnosisOptions& options) {
  return {record.task, record.floors, options.material};
}

}  // namespace hysteron::diagnosis
