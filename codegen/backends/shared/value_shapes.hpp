// What an expression looks like apart from the places of its arrays, so that values which may share a loop are found
// before they are written.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/backends/shared/routine.hpp"
#include "codegen/graph/graph.hpp"

namespace hysteron {

/// Rows of at least this many elements, and sums of at least this many terms, are loops (decision 46).
inline constexpr std::size_t shortest_loop = 3;
/// Values of a block that are alike, or a chain behind its first value, are a loop from this many on.
inline constexpr std::size_t shortest_family = 4;
/// The same of the terms of a sum, where a target computes several rows at once (decision 48).
inline constexpr std::size_t shortest_sum_at_once = 9;

class ValueShapes {
 public:
  ValueShapes() = default;
  /// `named(id)`: a value that has a name of its own wherever it is used; `in_array`, by value: an element of an array.
  template <class Named>
  ValueShapes(const Graph& graph, const Routine& routine, const std::vector<bool>& in_array, Named named) {
    find_groups(graph, routine);
    shape_.resize(routine.tape.size());
    inside_.resize(routine.tape.size());
    is_sum_.assign(routine.tape.size(), false);
    std::vector<bool> goes_on(routine.tape.size(), false);  // the left side of a sum, used there alone
    for (ValueId id = 0; id < routine.tape.size(); ++id) {
      const Value& value = routine.tape[id];
      if (routine.uses[id] > 0 && adds(value.op) && !named(value.args[0])) {
        goes_on[value.args[0]] = routine.uses[value.args[0]] == 1;
      }
    }
    in_array_ = in_array;
    named_.assign(routine.tape.size(), false);
    has_place_.assign(routine.tape.size(), false);
    for (ValueId id = 0; id < routine.tape.size(); ++id) {
      named_[id] = named(id);
      has_place_[id] = place_inside(routine.tape, id);
      inside_[id] = shape_inside(routine.tape, id);
      shape_[id] = named_[id] ? shape_of_name(routine.tape[id]) : inside_[id];
      is_sum_[id] = routine.uses[id] > 0 && adds(routine.tape[id].op) && !goes_on[id] && is_long(routine, id);
    }
  }

  /// Whether a value is a sum of terms, enough of which are alike for a loop.
  [[nodiscard]] bool is_sum(ValueId id) const { return id < is_sum_.size() && is_sum_[id]; }
  [[nodiscard]] bool has_sums() const { return std::ranges::find(is_sum_, true) != is_sum_.end(); }
  /// What a sum adds, or takes off.
  struct Term {
    ValueId value = no_value;
    bool minus = false;
  };
  /// The terms of a sum, in their order.
  [[nodiscard]] std::vector<Term> terms(const Routine& routine, ValueId sum) const;
  /// How many terms from the first on are alike.
  [[nodiscard]] std::size_t terms_alike_from(std::span<const Term> terms) const;
  /// Whether enough values that follow each other are alike, and name elements of arrays, for a loop over them.
  [[nodiscard]] bool has_loop(std::span<const ValueId> rows) const;

 private:
  [[nodiscard]] static bool adds(Op op) { return op == Op::Add || op == Op::Subtract; }
  void find_groups(const Graph& graph, const Routine& routine);
  [[nodiscard]] static std::uint64_t shape_of_name(const Value& value);
  [[nodiscard]] std::uint64_t shape_inside(const Tape& tape, ValueId id) const;
  [[nodiscard]] bool place_inside(const Tape& tape, ValueId id) const;
  [[nodiscard]] bool is_long(const Routine& routine, ValueId id) const;

  std::vector<PortGroup> cell_group_;   ///< by cell
  std::vector<PortGroup> input_group_;  ///< by input
  std::vector<bool> in_array_;          ///< by value
  std::vector<bool> named_;             ///< by value
  std::vector<bool> has_place_;         ///< by value: an element of an array stands in what is written for it
  std::vector<std::uint64_t> inside_;   ///< by value: the shape of what is written for it
  std::vector<std::uint64_t> shape_;    ///< by value: the same where it is used, which is a name where it has one
  std::vector<bool> is_sum_;
};

}  // namespace hysteron
