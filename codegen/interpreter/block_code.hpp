// The functions of every block for one scalar, behind pointers: what the interpreter calls.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "blocks/catalogue.hpp"
#include "blocks/sized_catalogue.hpp"
#include "codegen/trace/block_type.hpp"
#include "codegen/trace/operation.hpp"

/// What stands before the functions that run a block: a source that compiles this for a scalar of several registers has
/// all that they call inlined, since such a scalar goes through memory to a function.
#ifndef HY_RUN
#define HY_RUN
#endif

namespace hysteron {

/// One action of a step, ready to run: where the pins are read, where state and outputs stand.
template <class S>
struct Instruction {
  void (*run)(const Instruction&) = nullptr;
  const void* const* pins = nullptr;
  void* state = nullptr;
  void* out = nullptr;
  const S* ts = nullptr;
  void* prepared = nullptr;          ///< what follows from parameters that stand still; null: worked out in each step
  const BlockType* block = nullptr;  ///< null: an operation
};

/// The functions of a block for the scalar S.
template <class S>
struct BlockRuns {
  using Run = void (*)(const Instruction<S>&);
  Run prepare = nullptr;  ///< gathers the parameters, and works out what follows from them; null without any
  Run reset = nullptr;    ///< constructs state and outputs, state from the parameters
  Run output = nullptr;
  Run update = nullptr;  ///< null without memory
  Run step = nullptr;    ///< output, then update
};

/// A block for the scalar S: its functions, sizes of its structures, offsets of their members.
template <class S>
struct BlockCode : BlockRuns<S> {
  std::size_t state_size = 0;
  std::size_t out_size = 0;
  std::size_t prepared_size = 0;
  std::size_t alignment = 1;
  std::vector<std::size_t> state_offsets{};
  std::vector<std::size_t> out_offsets{};
};

/// All that the steps of a machine call. It is compiled by itself, in the source that includes run_table.hpp, so that
/// it can be compiled for a processor that not every machine has.
template <class S>
struct RunTable {
  std::array<BlockRuns<S>, Catalogue::size> blocks;      ///< in the order of the catalogue
  std::array<BlockRuns<S>, SizedCatalogue::size> sized;  ///< in the order of theirs; update and step of one with states
  std::array<typename BlockRuns<S>::Run, static_cast<std::size_t>(Op::At)> operations;  ///< by Op
  void (*constant)(void* target, double value);  ///< writes a number as S, as a whole: who reads it waits for no part
};
template <class S>
const RunTable<S>& run_table();

namespace detail {

template <class Struct>
std::vector<std::size_t> member_offsets() {
  static Struct sample{};
  return Struct::fields().apply([](const auto&... field) {
    return std::vector<std::size_t>{static_cast<std::size_t>(reinterpret_cast<const char*>(&(sample.*(field.member))) -
                                                             reinterpret_cast<const char*>(&sample))...};
  });
}

/// A structure whose members are read through pointers.
template <class Struct>
Struct gather(const void* const* pins) {
  constexpr auto fields = Struct::fields();
  Struct result{};
  fields.apply([&](const auto&... field) {
    ((result.*(field.member) = *static_cast<const std::remove_cvref_t<decltype(result.*(field.member))>*>(*pins++)),
     ...);
  });
  return result;
}
/// The coefficients of a block; nothing where it has none.
template <class B, class S>
struct CoefficientsOfBlock {
  struct Type {};
};
template <HasCoefficients B, class S>
struct CoefficientsOfBlock<B, S> {
  using Type = typename B::template Coefficients<S>;
};
template <class B, class S>
using CoefficientsOf = typename CoefficientsOfBlock<B, S>::Type;

template <class Struct>
inline constexpr std::size_t field_count = decltype(Struct::fields())::size;

template <class B, class S>
struct Code {
  using In = typename B::template In<S>;
  using Out = typename B::template Out<S>;
  using Params = typename B::template Params<S>;
  using State = typename B::template State<S>;
  static constexpr std::size_t inputs = field_count<In>;

  static const State& state(const Instruction<S>& at) { return *static_cast<const State*>(at.state); }

  /// The parameters of a block, and what follows from them and TS alone.
  struct Prepared {
    Params params;
    [[no_unique_address]] CoefficientsOf<B, S> coefficients;
  };
  static Prepared prepared(const Instruction<S>& at) {
    const auto params = gather<Params>(at.pins + inputs);
    if constexpr (HasCoefficients<B>) {
      return {.params = params, .coefficients = B::coefficients(params, *at.ts)};
    } else {
      return {.params = params, .coefficients = {}};
    }
  }
  static void prepare(const Instruction<S>& at) { new (at.prepared) Prepared(prepared(at)); }

  /// Calls call(prepared), with what stands ready where the parameters stand still.
  template <class Call>
  static void with_prepared(const Instruction<S>& at, const Call& call) {
    std::optional<Prepared> own;
    call(at.prepared != nullptr ? *static_cast<const Prepared*>(at.prepared) : own.emplace(prepared(at)));
  }

  static void reset(const Instruction<S>& at) {
    new (at.out) Out{};
    if constexpr (HasMemory<B>) {
      new (at.state) State(B::initial(gather<Params>(at.pins + inputs)));
    } else {
      new (at.state) State{};
    }
  }
  HY_RUN static void output(const Instruction<S>& at) {
    with_prepared(at, [&](const Prepared& with) {
      *static_cast<Out*>(at.out) = output_of(with, state(at), gather<In>(at.pins), *at.ts);
    });
  }
  HY_RUN static void update(const Instruction<S>& at) {
    if constexpr (HasMemory<B>) {
      with_prepared(at, [&](const Prepared& with) {
        move_on(with, *static_cast<State*>(at.state), gather<In>(at.pins), *static_cast<const Out*>(at.out), *at.ts);
      });
    }
  }
  HY_RUN static void step(const Instruction<S>& at) {
    with_prepared(at, [&](const Prepared& with) {
      const auto in = gather<In>(at.pins);
      auto& memory = *static_cast<State*>(at.state);
      auto& out = *static_cast<Out*>(at.out);
      if constexpr (StepsAtOnce<B> && HasCoefficients<B>) {
        out = B::template step<S>(with.params, with.coefficients, memory, in, *at.ts);
      } else if constexpr (StepsAtOnce<B>) {
        out = B::template step<S>(with.params, memory, in, *at.ts);
      } else {
        out = output_of(with, memory, in, *at.ts);
        move_on(with, memory, in, out, *at.ts);
      }
    });
  }

  /// Output and update, each with the coefficients where it takes them.
  static Out output_of(const Prepared& with, const State& state, const In& in, const S& ts) {
    if constexpr (requires { B::output(with.params, with.coefficients, state, in, ts); }) {
      return B::output(with.params, with.coefficients, state, in, ts);
    } else {
      return B::output(with.params, state, in, ts);
    }
  }
  static void move_on(const Prepared& with, State& state, const In& in, const Out& out, const S& ts) {
    if constexpr (requires { B::update(with.params, with.coefficients, state, in, out, ts); }) {
      B::update(with.params, with.coefficients, state, in, out, ts);
    } else {
      B::update(with.params, state, in, out, ts);
    }
  }

  /// Without memory a step is an output.
  static constexpr typename BlockRuns<S>::Run whole_step() {
    if constexpr (HasMemory<B> || StepsAtOnce<B>) {
      return &step;
    } else {
      return &output;
    }
  }

  static constexpr BlockRuns<S> runs() {
    return {.prepare = field_count<Params> > 0 ? &prepare : nullptr,
            .reset = &reset,
            .output = &output,
            .update = HasMemory<B> ? &update : nullptr,
            .step = whole_step()};
  }

  static BlockCode<S> with_layout(const BlockRuns<S>& runs) {
    static_assert(std::is_trivially_copyable_v<State> && std::is_trivially_copyable_v<Out>);
    static_assert(std::is_trivially_copyable_v<Prepared>);
    return {runs,
            sizeof(State),
            sizeof(Out),
            sizeof(Prepared),
            std::max({alignof(State), alignof(Out), alignof(Prepared)}),
            member_offsets<State>(),
            member_offsets<Out>()};
  }
};

}  // namespace detail

/// The code of all blocks, in the order of the catalogue.
template <class S>
std::span<const BlockCode<S>> block_codes() {
  static const std::vector<BlockCode<S>> codes = [] {
    std::vector<BlockCode<S>> list;
    list.reserve(Catalogue::size);
    Catalogue::for_each(
        [&]<class B> { list.push_back(detail::Code<B, S>::with_layout(run_table<S>().blocks[list.size()])); });
    return list;
  }();
  return codes;
}

}  // namespace hysteron
