// What the outputs of a diagram make of signals that are added on its edges: exact derivatives along the run.
//
//   y(ε) = outputs with ε·w(k) added on an edge in each step k,   response = ∂y/∂ε at ε = 0
//
// Several signals are carried at once, as the lanes of a dual number.
#pragma once

#include "diagnosis/evidence/space.hpp"
#include "diagnosis/evidence/summed_edge.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// The measured outputs; the diagram runs by itself from its start. It keeps references to what it is made of.
class OutputSpace : public Space {
 public:
  OutputSpace(const Task& task, const std::string& top, const Explanation& fitted,
              const std::vector<std::string>& unused, unsigned threads);

  static constexpr std::string_view title = "outputs";
  [[nodiscard]] std::string name() const override { return std::string(title); }
  [[nodiscard]] std::size_t outputs() const override { return task_.outputs.size(); }
  [[nodiscard]] const std::vector<Place>& places() const override { return places_; }
  [[nodiscard]] const std::vector<DriverSignal>& drivers() const override { return drivers_; }
  [[nodiscard]] const VectorXd& residuals() const override { return fitted_.fit.residuals; }
  [[nodiscard]] const MatrixXd& known() const override { return fitted_.fit.jacobian; }
  [[nodiscard]] MatrixXd of(std::size_t place, std::span<const RecordSignals> signals) const override;

 private:
  const Task& task_;
  const Explanation& fitted_;
  std::vector<Place> places_{};
  std::vector<SummedEdge> added_{};  ///< beside the places
  std::vector<DriverSignal> drivers_{};
};

/// Whether an edge is an input or an output of the diagram.
[[nodiscard]] bool is_port(const Graph& graph, const Edge& edge);

/// An edge of a diagram as a place, without what it carries: what its unit, its wires and the outputs say of it.
/// `there` is the diagram with a sum on that edge, `graph` the one without.
[[nodiscard]] Space::Place place_of(const Task& task, const Program& there, const SummedEdge& edge, const Graph& graph);

/// A program with the values of the task's file and the known parameters as given.
[[nodiscard]] Program with_values(const Task& task, const Program& program, const VectorXd& known);

}  // namespace hysteron::diagnosis
