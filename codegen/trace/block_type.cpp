#include "codegen/trace/block_type.hpp"

#include <string>
#include <unordered_map>

#include "blocks/catalogue.hpp"
#include "codegen/trace/traced.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

template <class B, template <class> class Role>
inline constexpr auto descriptions = fields_of<Role<B>>();

template <class B>
using InOf = typename B::template In<double>;
template <class B>
using OutOf = typename B::template Out<double>;
template <class B>
using ParamsOf = typename B::template Params<double>;
template <class B>
using StateOf = typename B::template State<double>;

template <class T>
constexpr Type type_of = Type::Real;
template <>
constexpr Type type_of<trace::Int> = Type::Int;
template <>
constexpr Type type_of<trace::Bool> = Type::Bool;
template <>
[[maybe_unused]] constexpr Type type_of<trace::Word> = Type::Word;

template <class T>
void set_leaf(T& member, Op op, std::uint32_t index) {
  member = T::of(trace::Recording::tape().leaf(op, type_of<T>, index));
}
template <std::size_t N>
void set_leaf(trace::Array<N>& member, Op op, std::uint32_t index) {
  member.id = trace::Recording::tape().leaf(op, Type::Real, index);
}

/// A structure whose members are leaves, numbered from `first`.
template <class Struct>
Struct leaves(Op op, std::uint32_t first) {
  Struct result{};
  Struct::fields().apply([&](const auto&... field) { (set_leaf(result.*(field.member), op, first++), ...); });
  return result;
}

template <class T>
ValueId id_of(const T& member) {
  return member.id;
}
template <std::size_t N>
ValueId id_of(const trace::Array<N>& /*member*/) {
  return no_value;
}
template <class Struct>
std::vector<ValueId> ids(const Struct& structure) {
  return Struct::fields().apply(
      [&](const auto&... field) { return std::vector<ValueId>{id_of(structure.*(field.member))...}; });
}

template <class T>
void collect_stores(const T& /*member*/, std::uint32_t /*cell*/, std::vector<Store>& /*stores*/) {}
template <std::size_t N>
void collect_stores(const trace::Array<N>& member, std::uint32_t cell, std::vector<Store>& stores) {
  for (Store one : member.stores) {
    one.cell = cell;
    stores.push_back(one);
  }
}
template <class Struct>
std::vector<Store> stores_of(const Struct& structure) {
  std::vector<Store> stores;
  std::uint32_t cell = 0;
  Struct::fields().apply(
      [&](const auto&... field) { (collect_stores(structure.*(field.member), cell++, stores), ...); });
  return stores;
}

/// The pins that each value of a tape depends on.
std::vector<PinSet> reached_pins(const Tape& tape) {
  std::vector<PinSet> reached(tape.size());
  for (ValueId id = 0; id < tape.size(); ++id) {
    if (tape[id].op == Op::Pin) {
      reached[id].insert(tape[id].index);
    }
    for (const ValueId arg : tape[id].args) {
      if (arg != no_value) {
        reached[id] |= reached[arg];
      }
    }
  }
  return reached;
}

template <class B>
BlockTrace trace_block() {
  using S = trace::Real;
  using State = typename B::template State<S>;
  BlockTrace result;
  const trace::Recording recording(result.tape);
  const auto in = leaves<typename B::template In<S>>(Op::Pin, 0);
  const auto params = leaves<typename B::template Params<S>>(
      Op::Pin, static_cast<std::uint32_t>(decltype(B::template In<S>::fields())::size));
  const auto ts = S::of(result.tape.leaf(Op::SampleTime, Type::Real, 0));
  auto state = leaves<State>(Op::Cell, 0);

  const auto out = B::output(params, state, in, ts);
  result.outputs = ids(out);
  if constexpr (HasMemory<B>) {
    const State start = B::initial(params);
    result.initial = ids(start);
    result.initial_stores = stores_of(start);
    B::update(params, state, in, out, ts);
    result.next = ids(state);
    result.stores = stores_of(state);
  }

  derive_reach(result);
  return result;
}

template <class B>
BlockType describe_block() {
  static_assert(descriptions<B, InOf>.size() + descriptions<B, ParamsOf>.size() <= 64, "a block has at most 64 pins");
  return {.about = B::about,
          .inputs = descriptions<B, InOf>,
          .params = descriptions<B, ParamsOf>,
          .outputs = descriptions<B, OutOf>,
          .states = descriptions<B, StateOf>,
          .trace = trace_block<B>()};
}

}  // namespace

void derive_reach(BlockTrace& trace) {
  const auto reached = reached_pins(trace.tape);
  for (const ValueId output : trace.outputs) {
    trace.feedthrough.push_back(reached[output]);
  }
  for (const ValueId next : trace.next) {
    if (next != no_value) {
      trace.update_pins |= reached[next];
    }
  }
  for (const Store& one : trace.stores) {
    trace.update_pins |= reached[one.value];
    if (one.index != no_value) {
      trace.update_pins |= reached[one.index];
    }
  }
}

std::span<const BlockType> block_types() {
  static const std::vector<BlockType> types = [] {
    std::vector<BlockType> list;
    list.reserve(Catalogue::size);
    Catalogue::for_each([&]<class B> { list.push_back(describe_block<B>()); });
    return list;
  }();
  return types;
}

const BlockType* find_block_type(std::string_view name) {
  static const std::unordered_map<std::string, const BlockType*> by_name = [] {
    std::unordered_map<std::string, const BlockType*> map;
    for (const BlockType& type : block_types()) {
      map.emplace(type.about.name, &type);
    }
    return map;
  }();
  const auto found = by_name.find(in_capitals(name));
  return found == by_name.end() ? nullptr : found->second;
}

}  // namespace hysteron
