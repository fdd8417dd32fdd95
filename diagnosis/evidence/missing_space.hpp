// The missing signal of an edge, as the space in which laws are compared.
//
// For a bottleneck of the diagram (summed_edge.hpp), the smoothest signal w is found that, added there, lets the model
// reproduce the measurement; how smooth, the likelihood of the record says. A law c·φ on an edge behind it, or another
// value of a known parameter, takes its part off w. So a force is held against a force, not against the position at the
// end of two integrals, states are those at which the machine really was, and what is linear in the equations stays so
// (equation error, with a smoother in the place of derivatives: Kristensen, Madsen and Jørgensen, Automatica 40 (2004)
// 225; Masri and Caughey, J. Appl. Mech. 46 (1979) 433).
#pragma once

#include <memory>
#include <optional>

#include "diagnosis/evidence/smoother.hpp"
#include "diagnosis/evidence/space.hpp"
#include "diagnosis/evidence/summed_edge.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

class MissingSpace : public Space {
 public:
  /// Null where the diagram has no bottleneck, or a block whose past is an array.
  static std::unique_ptr<MissingSpace> of_bottleneck(const Task& task, const std::string& top,
                                                     const Explanation& fitted, const std::vector<std::string>& unused,
                                                     unsigned threads);

  [[nodiscard]] std::string name() const override { return bottleneck_.edge.edge.name; }
  [[nodiscard]] std::size_t outputs() const override { return 1; }
  [[nodiscard]] const std::vector<Place>& places() const override { return places_; }
  [[nodiscard]] const std::vector<DriverSignal>& drivers() const override { return drivers_; }
  [[nodiscard]] const VectorXd& residuals() const override { return missing_; }
  [[nodiscard]] const MatrixXd& known() const override { return known_; }
  [[nodiscard]] bool is_at_once() const override { return true; }
  [[nodiscard]] MatrixXd of(std::size_t place, std::span<const RecordSignals> signals) const override;

  [[nodiscard]] double smoothness() const { return step_; }

 private:
  MissingSpace(const Task& task, Bottleneck bottleneck) : task_(task), bottleneck_(std::move(bottleneck)) {}
  bool solve(const Explanation& fitted, const std::vector<std::string>& unused, unsigned threads);
  [[nodiscard]] LinearSystem linearised(const TangentRun& run, std::size_t record,
                                        const TangentRun::Course& course) const;

  const Task& task_;
  Bottleneck bottleneck_;
  double scale_ = 1.0;           ///< of w
  double step_ = 0.0;            ///< of w a sample
  std::vector<double> noise_{};  ///< by output
  std::vector<LinearSystem> systems_{};
  std::vector<Smoother> smoothers_{};
  std::vector<TangentRun::Course> courses_{};
  std::vector<std::vector<MatrixXd>> ways_{};  ///< by place and record
  VectorXd missing_{};
  MatrixXd known_{};
  std::vector<Place> places_{};
  std::vector<DriverSignal> drivers_{};
};

}  // namespace hysteron::diagnosis
