#include "codegen/trace/tape.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace hysteron {

namespace {

std::size_t hash_of(const Value& value) {
  std::uint64_t hash = static_cast<std::uint64_t>(value.op) * 0x9E3779B97F4A7C15ULL + value.index;
  for (const ValueId arg : value.args) {
    hash = (hash ^ arg) * 0xBF58476D1CE4E5B9ULL;
  }
  hash ^= std::bit_cast<std::uint64_t>(value.literal) * 0x94D049BB133111EBULL;
  return static_cast<std::size_t>(hash ^ (hash >> 31U));
}

// Literals are compared by bits: 0.0 and -0.0 are two values, and a NaN equals itself.
bool same_bits(const Value& a, const Value& b) {
  return a.op == b.op && a.type == b.type && a.args == b.args && a.index == b.index &&
         std::bit_cast<std::uint64_t>(a.literal) == std::bit_cast<std::uint64_t>(b.literal);
}

}  // namespace

ValueId Tape::intern(const Value& value) {
  if (2 * (values_.size() - first_known_) >= places_.size()) {
    grow();
  }
  const std::size_t mask = places_.size() - 1;
  std::size_t at = hash_of(value) & mask;
  for (; is_known(places_[at]); at = (at + 1) & mask) {
    if (same_bits(values_[places_[at]], value)) {
      return places_[at];
    }
  }
  places_[at] = static_cast<ValueId>(values_.size());
  values_.push_back(value);
  return places_[at];
}

void Tape::grow() {
  places_.assign(std::max<std::size_t>(64, 2 * places_.size()), no_value);
  const std::size_t mask = places_.size() - 1;
  for (ValueId id = first_known_; id < values_.size(); ++id) {
    std::size_t at = hash_of(values_[id]) & mask;
    while (is_known(places_[at])) {
      at = (at + 1) & mask;
    }
    places_[at] = id;
  }
}

ValueId Tape::leaf(Op op, Type type, std::uint32_t index) {
  return intern({.op = op, .type = type, .index = index});
}

ValueId Tape::literal(Op op, double value) {
  return intern({.op = op, .type = info(op).result, .literal = value});
}

bool Tape::is_bool(ValueId id, bool value) const {
  return values_[id].op == Op::BoolLiteral && (values_[id].literal != 0.0) == value;
}

ValueId Tape::apply(Op op, ValueId a, ValueId b, ValueId c) {
  if (is_select(op)) {
    if (b == c || is_bool(a, true)) {
      return b;
    }
    if (is_bool(a, false)) {
      return c;
    }
    if (op == Op::SelectBool && is_bool(b, true) && is_bool(c, false)) {
      return a;
    }
  }
  if (op == Op::Not && values_[a].op == Op::BoolLiteral) {
    return literal(Op::BoolLiteral, is_bool(a, false) ? 1.0 : 0.0);
  }
  if (op == Op::And || op == Op::Or) {
    const bool absorbing = op == Op::Or;  // TRUE OR x = TRUE, FALSE AND x = FALSE
    for (const auto& [one, other] : {std::pair{a, b}, std::pair{b, a}}) {
      if (is_bool(one, absorbing)) {
        return one;
      }
      if (is_bool(one, !absorbing)) {
        return other;
      }
    }
  }
  if (op == Op::Xor) {
    for (const auto& [one, other] : {std::pair{a, b}, std::pair{b, a}}) {
      if (is_bool(one, false)) {
        return other;
      }
      if (is_bool(one, true)) {
        return apply(Op::Not, other);
      }
    }
  }
  return intern({.op = op, .type = info(op).result, .args = {a, b, c}});
}

}  // namespace hysteron
