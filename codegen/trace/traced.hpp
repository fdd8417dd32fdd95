// The traced scalar: computing with it writes down what was computed.
//
// A block run with trace::Real leaves its expression graph on the current tape. From that graph come the text of
// every target and the feedthrough of every pair of ports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "blocks/scalar.hpp"
#include "codegen/trace/tape.hpp"

namespace hysteron::trace {

/// Makes a tape the current one of this thread, for as long as the scope lives.
class Recording {
 public:
  explicit Recording(Tape& tape) : previous_(current_) { current_ = &tape; }
  ~Recording() { current_ = previous_; }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  static Tape& tape() {
    if (current_ == nullptr) {
      throw std::logic_error("a traced scalar was used outside a recording");
    }
    return *current_;
  }

 private:
  static inline thread_local Tape* current_ = nullptr;  // NOLINT(readability-identifier-naming): a private member
  Tape* previous_;
};

struct Bool {
  ValueId id = no_value;
  Bool() = default;
  explicit Bool(bool value) : id(Recording::tape().literal(Op::BoolLiteral, value ? 1.0 : 0.0)) {}
  static Bool of(ValueId id) {
    Bool result;
    result.id = id;
    return result;
  }
};

struct Int {
  ValueId id = no_value;
  Int() = default;
  explicit Int(std::int32_t value) : id(Recording::tape().literal(Op::IntLiteral, value)) {}
  static Int of(ValueId id) {
    Int result;
    result.id = id;
    return result;
  }
};

struct Word {
  ValueId id = no_value;
  Word() = default;
  explicit Word(std::uint16_t value) : id(Recording::tape().literal(Op::WordLiteral, value)) {}
  static Word of(ValueId id) {
    Word result;
    result.id = id;
    return result;
  }
};

struct Real {
  ValueId id = no_value;
  Real() = default;
  explicit Real(double value) : id(Recording::tape().literal(Op::RealLiteral, value)) {}
  static Real of(ValueId id) {
    Real result;
    result.id = id;
    return result;
  }
};

/// An array of the state or of the parameters: a cell or pin, and what this step stores into it.
template <std::size_t N>
struct Array {
  ValueId id = no_value;
  std::vector<Store> stores{};
};

inline ValueId apply(Op op, ValueId a, ValueId b = no_value, ValueId c = no_value) {
  return Recording::tape().apply(op, a, b, c);
}

inline Real operator+(Real a, Real b) {
  return Real::of(apply(Op::Add, a.id, b.id));
}
inline Real operator-(Real a, Real b) {
  return Real::of(apply(Op::Subtract, a.id, b.id));
}
inline Real operator*(Real a, Real b) {
  return Real::of(apply(Op::Multiply, a.id, b.id));
}
inline Real operator/(Real a, Real b) {
  return Real::of(apply(Op::Divide, a.id, b.id));
}
inline Real operator-(Real a) {
  return Real::of(apply(Op::Negate, a.id));
}
inline Real& operator+=(Real& a, Real b) {
  return a = a + b;
}
inline Real& operator-=(Real& a, Real b) {
  return a = a - b;
}
inline Real& operator*=(Real& a, Real b) {
  return a = a * b;
}
inline Real& operator/=(Real& a, Real b) {
  return a = a / b;
}
inline Bool operator<(Real a, Real b) {
  return Bool::of(apply(Op::Less, a.id, b.id));
}
inline Bool operator<=(Real a, Real b) {
  return Bool::of(apply(Op::LessEqual, a.id, b.id));
}
inline Bool operator>(Real a, Real b) {
  return b < a;
}
inline Bool operator>=(Real a, Real b) {
  return b <= a;
}
inline Bool operator==(Real a, Real b) {
  return Bool::of(apply(Op::Equal, a.id, b.id));
}
inline Bool operator!=(Real a, Real b) {
  return Bool::of(apply(Op::NotEqual, a.id, b.id));
}
inline Real abs(Real x) {
  return Real::of(apply(Op::Abs, x.id));
}
inline Real sqrt(Real x) {
  return Real::of(apply(Op::Sqrt, x.id));
}
inline Real exp(Real x) {
  return Real::of(apply(Op::Exp, x.id));
}
inline Real log(Real x) {
  return Real::of(apply(Op::Log, x.id));
}
inline Real sin(Real x) {
  return Real::of(apply(Op::Sin, x.id));
}
inline Real cos(Real x) {
  return Real::of(apply(Op::Cos, x.id));
}
inline Real tan(Real x) {
  return Real::of(apply(Op::Tan, x.id));
}
inline Real asin(Real x) {
  return Real::of(apply(Op::Asin, x.id));
}
inline Real acos(Real x) {
  return Real::of(apply(Op::Acos, x.id));
}
inline Real atan(Real x) {
  return Real::of(apply(Op::Atan, x.id));
}
inline Real power(Real base, Real exponent) {
  return Real::of(apply(Op::Power, base.id, exponent.id));
}
inline Real min(Real a, Real b) {
  return Real::of(apply(Op::Min, a.id, b.id));
}
inline Real max(Real a, Real b) {
  return Real::of(apply(Op::Max, a.id, b.id));
}

inline Int operator+(Int a, Int b) {
  return Int::of(apply(Op::IntAdd, a.id, b.id));
}
inline Int operator-(Int a, Int b) {
  return Int::of(apply(Op::IntSubtract, a.id, b.id));
}
inline Int operator*(Int a, Int b) {
  return Int::of(apply(Op::IntMultiply, a.id, b.id));
}
inline Int operator/(Int a, Int b) {
  return Int::of(apply(Op::IntDivide, a.id, b.id));
}
inline Int operator%(Int a, Int b) {
  return Int::of(apply(Op::IntModulo, a.id, b.id));
}
inline Int operator-(Int a) {
  return Int::of(apply(Op::IntNegate, a.id));
}
inline Bool operator<(Int a, Int b) {
  return Bool::of(apply(Op::IntLess, a.id, b.id));
}
inline Bool operator<=(Int a, Int b) {
  return Bool::of(apply(Op::IntLessEqual, a.id, b.id));
}
inline Bool operator>(Int a, Int b) {
  return b < a;
}
inline Bool operator>=(Int a, Int b) {
  return b <= a;
}
inline Bool operator==(Int a, Int b) {
  return Bool::of(apply(Op::IntEqual, a.id, b.id));
}
inline Bool operator!=(Int a, Int b) {
  return Bool::of(apply(Op::IntNotEqual, a.id, b.id));
}
inline Int min(Int a, Int b) {
  return Int::of(apply(Op::IntMin, a.id, b.id));
}
inline Int max(Int a, Int b) {
  return Int::of(apply(Op::IntMax, a.id, b.id));
}

inline Bool operator&&(Bool a, Bool b) {
  return Bool::of(apply(Op::And, a.id, b.id));
}
inline Bool operator||(Bool a, Bool b) {
  return Bool::of(apply(Op::Or, a.id, b.id));
}
inline Bool operator!=(Bool a, Bool b) {
  return Bool::of(apply(Op::Xor, a.id, b.id));
}
inline Bool operator==(Bool a, Bool b) {
  return Bool::of(apply(Op::Not, apply(Op::Xor, a.id, b.id)));
}
inline Bool operator!(Bool a) {
  return Bool::of(apply(Op::Not, a.id));
}

inline Real select(Bool c, Real a, Real b) {
  return Real::of(apply(Op::Select, c.id, a.id, b.id));
}
inline Int select(Bool c, Int a, Int b) {
  return Int::of(apply(Op::SelectInt, c.id, a.id, b.id));
}
inline Bool select(Bool c, Bool a, Bool b) {
  return Bool::of(apply(Op::SelectBool, c.id, a.id, b.id));
}
inline Word select(Bool c, Word a, Word b) {
  return Word::of(apply(Op::SelectWord, c.id, a.id, b.id));
}

inline Int to_int(Real x) {
  return Int::of(apply(Op::ToInt, x.id));
}
template <class S>
requires std::is_same_v<S, Real> Real to_real(Int i) {
  return Real::of(apply(Op::ToReal, i.id));
}

template <std::size_t N>
Real at(const Array<N>& array, Int index) {
  if (!array.stores.empty()) {
    throw std::logic_error("a block loads from an array after it stored into it; load first");
  }
  return Real::of(apply(Op::At, array.id, index.id));
}
template <std::size_t N>
void store(Array<N>& array, Int index, Real value) {
  array.stores.push_back({.cell = 0, .index = index.id, .value = value.id});
}
template <std::size_t N>
void fill(Array<N>& array, Real value) {
  array.stores.push_back({.cell = 0, .index = no_value, .value = value.id});
}

}  // namespace hysteron::trace

namespace hysteron {

template <>
struct ScalarTypes<trace::Real> {
  using Bool = trace::Bool;
  using Int = trace::Int;
  using Word = trace::Word;
  template <std::size_t N>
  using Array = trace::Array<N>;
};

}  // namespace hysteron
