// Where a model and a record are held against each other: at the measured outputs, or at the edge on which a signal is
// missing. Laws are compared within one space, by the share of its gap that they predict.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "diagnosis/effects/edges.hpp"
#include "diagnosis/evidence/driver_signals.hpp"
#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

class Space {
 public:
  /// An edge of the top block on which laws may act, and the signal that it carries.
  struct Place {
    Edge edge{};
    RecordSignals carried{};
    std::string unit{};    ///< empty where the diagram does not say it
    bool is_port = false;  ///< an input or an output of the diagram
    bool is_integral = false;
    bool is_balance = false;         ///< see motions.hpp
    bool is_of_velocity = false;     ///< a constant times a velocity
    bool is_given_motion = false;    ///< it follows from a motion that is an input, where no output is a motion
    bool is_differentiated = false;  ///< such a one, on its way to nothing but its rates
  };

  Space() = default;
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;
  virtual ~Space() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::size_t outputs() const = 0;
  [[nodiscard]] virtual const std::vector<Place>& places() const = 0;
  [[nodiscard]] virtual const std::vector<DriverSignal>& drivers() const = 0;
  /// What is missing: rows output by output, record by record.
  [[nodiscard]] virtual const VectorXd& residuals() const = 0;
  /// How it changes with the known parameters.
  [[nodiscard]] virtual const MatrixXd& known() const = 0;
  /// Whether it changes with a signal there and then, and not for long after.
  [[nodiscard]] virtual bool is_at_once() const { return false; }
  /// How it changes with signals that are added at a place: a column each. Empty where one is not finite.
  [[nodiscard]] virtual MatrixXd of(std::size_t place, std::span<const RecordSignals> signals) const = 0;
};

}  // namespace hysteron::diagnosis
