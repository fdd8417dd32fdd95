// What a PLC must not be asked to compute: a division by zero, the power of a number below zero, an integer beyond its
// range. Both sides of a choice are computed in Structured Text, so a guard stands at the operation itself.
//
// And what it would compute otherwise: a parameter that is infinite is the largest number there, and a division by it
// is to give 0.
#pragma once

#include <cstdint>
#include <vector>

#include "codegen/backends/shared/routine.hpp"
#include "codegen/graph/graph.hpp"

namespace hysteron {

/// How a power is written: what is known of its exponent, and of the sign of its base.
enum class PowerForm : std::uint8_t {
  Base,          ///< exponent 1
  Square,        ///< 2
  Root,          ///< 1/2
  One,           ///< 0
  Plain,         ///< EXPT is safe for any base
  PositivePart,  ///< EXPT of the base where that is positive, of 0 elsewhere
  NonZero,       ///< EXPT where the base is not 0
  Positive,      ///< EXPT where the base is above 0
  Any            ///< the exponent is known at run time only
};

class Guards {
 public:
  Guards(const Graph& graph, const Routine& routine);

  /// By value: those that need statements of their own, and the operands that stand in these more than once.
  [[nodiscard]] const std::vector<bool>& must_be_named() const { return must_be_named_; }

  /// Whether a division by this is a plain one.
  [[nodiscard]] bool is_plain_divisor(ValueId id) const { return never_zero(id, nullptr) && !may_be_infinite(id); }
  /// A parameter that is infinite, here or by default: in Structured Text it is the largest number.
  [[nodiscard]] bool may_be_infinite(ValueId id) const;
  [[nodiscard]] bool never_negative(ValueId id) const;
  [[nodiscard]] PowerForm power_form(const Value& power) const;
  /// Whether an integer may be divided by this one.
  [[nodiscard]] bool is_safe_divisor(ValueId id) const;

 private:
  /// What holds where a value is chosen: the conditions of the choices round it.
  struct Known {
    ValueId condition;
    bool holds;
    const Known* outer;
  };
  [[nodiscard]] bool never_zero(ValueId id, const Known* known) const;
  [[nodiscard]] bool is_same(ValueId a, ValueId b) const;
  [[nodiscard]] bool tells_nonzero(ValueId condition, bool holds, ValueId id) const;
  [[nodiscard]] bool is_positive(ValueId id) const;
  void name_with_operands(ValueId id, std::size_t operands);

  const Graph& graph_;
  const Tape& tape_;
  std::vector<bool> must_be_named_;
};

}  // namespace hysteron
