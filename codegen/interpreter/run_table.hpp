// The functions that the steps of a machine call, to be included by the source in which they are compiled for a scalar.
//
// That source may be compiled for a processor that not every machine has. It then must not contain an inline function
// that others share, whatever their scalar: the linker keeps one of them for all (tests/house/wide_code_test.cpp).
#pragma once

#include "codegen/interpreter/sized_code.hpp"
#include "codegen/trace/evaluate.hpp"

namespace hysteron {
namespace detail {

/// An operation of an expression, as an instruction: operands behind pins, the result in out.
template <Op op, class S>
void run_operation(const Instruction<S>& at) {
  constexpr OperationInfo about = info(op);
  const auto real = [&](std::size_t i) -> const S& { return *static_cast<const S*>(at.pins[i]); };
  const auto integer = [&](std::size_t i) -> const Int<S>& { return *static_cast<const Int<S>*>(at.pins[i]); };
  const auto truth = [&](std::size_t i) -> const Bool<S>& { return *static_cast<const Bool<S>*>(at.pins[i]); };
  const auto word = [&](std::size_t i) -> const Word<S>& { return *static_cast<const Word<S>*>(at.pins[i]); };
  const auto give = [&](const auto& value) { *static_cast<std::remove_cvref_t<decltype(value)>*>(at.out) = value; };
  if constexpr (op == Op::Select) {
    give(select(truth(0), real(1), real(2)));
  } else if constexpr (op == Op::SelectInt) {
    give(select(truth(0), integer(1), integer(2)));
  } else if constexpr (op == Op::SelectBool) {
    give(select(truth(0), truth(1), truth(2)));
  } else if constexpr (op == Op::SelectWord) {
    give(select(truth(0), word(1), word(2)));
  } else if constexpr (op == Op::ToInt) {
    give(to_int(real(0)));
  } else if constexpr (op == Op::ToReal) {
    give(to_real<S>(integer(0)));
  } else if constexpr (op == Op::WordToInt) {
    give(word_to_int(word(0)));
  } else if constexpr (op == Op::IntToWord) {
    give(int_to_word(integer(0)));
  } else if constexpr (about.operand == Type::Real && about.result == Type::Real && about.arity > 0) {
    give(real_operation(op, real(0), real(about.arity - 1)));
  } else if constexpr (about.operand == Type::Real && about.result == Type::Bool) {
    give(comparison(op, real(0), real(1)));
  } else if constexpr (about.operand == Type::Int && about.result == Type::Bool) {
    give(comparison(op, integer(0), integer(1)));
  } else if constexpr (about.operand == Type::Int && about.arity > 0) {
    give(int_operation(op, integer(0), integer(about.arity - 1)));
  } else if constexpr (about.operand == Type::Bool && about.arity > 0) {
    give(bool_operation(op, truth(0), truth(about.arity - 1)));
  }
}

template <class S, std::size_t... I>
constexpr auto operation_table(std::index_sequence<I...> /*ops*/) {
  return std::array<typename BlockRuns<S>::Run, sizeof...(I)>{&run_operation<static_cast<Op>(I), S>...};
}

template <class S>
void write_constant(void* target, double value) {
  *static_cast<S*>(target) = static_cast<S>(value);
}

template <class S, class... Blocks>
constexpr auto block_table(BlockList<Blocks...> /*catalogue*/) {
  return std::array{Code<Blocks, S>::runs()...};
}
template <class S, class... Blocks>
constexpr auto sized_table(SizedBlockList<Blocks...> /*catalogue*/) {
  return std::array{SizedCode<Blocks, S>::runs()...};
}

}  // namespace detail

template <class S>
const RunTable<S>& run_table() {
  static constexpr RunTable<S> table{
      .blocks = detail::block_table<S>(Catalogue{}),
      .sized = detail::sized_table<S>(SizedCatalogue{}),
      .operations = detail::operation_table<S>(std::make_index_sequence<static_cast<std::size_t>(Op::At)>{}),
      .constant = &detail::write_constant<S>};
  return table;
}

}  // namespace hysteron
