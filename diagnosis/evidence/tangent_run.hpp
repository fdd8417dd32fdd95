// A diagram stepped along a given course of its states, with the derivatives of each step.
//
//   x(k+1) = f(x(k), u(k), w(k)),   y(k) = g(x(k), u(k), w(k)),   ∂(f, g)/∂(x, θ, w)
#pragma once

#include <span>
#include <string>
#include <vector>

#include "diagnosis/effects/signals.hpp"

namespace hysteron::diagnosis {

class TangentRun {
 public:
  enum class Kind : std::uint8_t { State, Parameter, Signal };
  struct Variable {
    Kind kind = Kind::State;
    std::size_t index = 0;  ///< of the states, of the task's known parameters; of the inputs of the graph
  };
  /// Of one record: columns are steps.
  struct Course {
    MatrixXd states{};   ///< before each step
    VectorXd missing{};  ///< the added signal
  };
  struct Steps {
    MatrixXd values{};  ///< the states after each step, then the outputs
    MatrixXd slopes{};  ///< of the same, by the variables: step by step side by side
  };

  /// `input` is the diagram's input of the missing signal. The program has the values of all parameters.
  TangentRun(const Task& task, Program program, std::vector<std::string> states, std::string_view input);

  /// Real states of a graph, but for arrays; nothing where a block keeps an array: its past has no place among them.
  [[nodiscard]] static std::vector<std::string> states_of(const Graph& graph, bool& complete);

  /// As the diagram runs by itself.
  [[nodiscard]] Course free_run(std::size_t record) const;
  [[nodiscard]] Steps along(std::size_t record, const Course& course, std::span<const Variable> variables) const;
  /// How the outputs change with a signal that is 1 from the start on, as the diagram runs by itself: outputs × steps.
  [[nodiscard]] MatrixXd held(std::size_t record, std::size_t input) const;
  /// What wires carry along it.
  [[nodiscard]] std::vector<Signal> wires_along(std::size_t record, const Course& course,
                                                const std::vector<Wire>& wires) const;

  [[nodiscard]] Index states() const { return std::ssize(states_); }
  [[nodiscard]] std::size_t input() const { return input_; }

 private:
  template <class S, class Visit>
  void run(std::size_t record, const Course* course, std::span<const Variable> seeded, const Visit& visit) const;

  const Task& task_;
  Program program_;
  std::vector<std::string> states_;
  std::size_t input_ = 0;
  std::vector<std::size_t> outputs_{};
  std::vector<std::size_t> known_{};  ///< places of the known parameters in the graph
};

}  // namespace hysteron::diagnosis
