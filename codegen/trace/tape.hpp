// A tape: the expression graph of a piece of a step, in the order in which it was computed.
//
// Equal expressions are one value (so that output and update share what they both need). The only rewriting is of
// truth values that are known beforehand: it cannot change a rounding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "codegen/trace/operation.hpp"

namespace hysteron {

using ValueId = std::uint32_t;
inline constexpr ValueId no_value = std::numeric_limits<ValueId>::max();

struct Value {
  Op op = Op::RealLiteral;
  Type type = Type::Real;
  std::array<ValueId, 3> args{no_value, no_value, no_value};
  std::uint32_t index = 0;  ///< which pin, cell, input or parameter
  double literal = 0.0;     ///< the value of a literal of any type

  bool operator==(const Value&) const = default;
};

/// `array[index] := value` at the end of the step; the array is a cell.
struct Store {
  std::uint32_t cell = 0;
  ValueId index = no_value;  ///< no_value: every element
  ValueId value = no_value;
};

class Tape {
 public:
  /// The value of a leaf.
  ValueId leaf(Op op, Type type, std::uint32_t index);
  ValueId literal(Op op, double value);
  /// The value of an operation on earlier values. Known truth values are folded.
  ValueId apply(Op op, ValueId a, ValueId b = no_value, ValueId c = no_value);

  [[nodiscard]] const Value& operator[](ValueId id) const { return values_[id]; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  /// Forgets which expressions are equal, not the expressions: what comes later shares nothing with what was before.
  void forget() { first_known_ = static_cast<ValueId>(values_.size()); }
  /// Makes room for a number of values.
  void reserve(std::size_t count) { values_.reserve(count); }

 private:
  ValueId intern(const Value& value);
  [[nodiscard]] bool is_known(ValueId id) const { return id >= first_known_ && id != no_value; }
  [[nodiscard]] bool is_bool(ValueId id, bool value) const;
  void grow();

  std::vector<Value> values_;
  ValueId first_known_ = 0;      ///< earlier values are forgotten
  std::vector<ValueId> places_;  ///< a hash table, a power of two; places of forgotten values count as free
};

}  // namespace hysteron
