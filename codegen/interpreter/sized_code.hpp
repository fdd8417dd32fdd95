// The functions of a block whose pins are vectors, for one scalar and its sizes: what the interpreter calls.
#pragma once

#include <array>
#include <cstddef>

#include "codegen/interpreter/block_code.hpp"
#include "codegen/trace/sized_block.hpp"

namespace hysteron::detail {

/// A sized block as its functions see it where it runs.
template <class S>
class RunView {
 public:
  using Real = S;
  explicit RunView(const Instruction<S>& at) : at_(at), block_(*at.block->sized) {}

  [[nodiscard]] const S& in(std::size_t field, std::size_t k) const { return real(block_.first_input[field] + k); }
  [[nodiscard]] const Bool<S>& flag(std::size_t field) const {
    return *static_cast<const Bool<S>*>(at_.pins[block_.first_input[field]]);
  }
  [[nodiscard]] const S& param(std::size_t field, std::size_t k) const { return (&real(block_.first_param[field]))[k]; }
  [[nodiscard]] const S& state(std::size_t k) const { return static_cast<const S*>(at_.state)[k]; }
  [[nodiscard]] const S& out(std::size_t k) const { return static_cast<const S*>(at_.out)[k]; }
  [[nodiscard]] const S& ts() const { return *at_.ts; }
  void set_out(std::size_t k, const S& value) { static_cast<S*>(at_.out)[k] = value; }
  void set_state(std::size_t k, const S& value) { next_[k] = value; }
  /// Takes over what was set: until then a state is what it was.
  void move_on() {
    for (std::size_t k = 0; k < block_.states.size(); ++k) {
      static_cast<S*>(at_.state)[k] = next_[k];
    }
  }

 private:
  [[nodiscard]] const S& real(std::size_t pin) const { return *static_cast<const S*>(at_.pins[pin]); }
  const Instruction<S>& at_;
  const SizedBlock& block_;
  std::array<S, most_states> next_{};
};

template <class B, class S>
struct SizedCode {
  static void reset(const Instruction<S>& at) {
    const SizedBlock& block = *at.block->sized;
    for (std::size_t k = 0; k < block.outputs.size(); ++k) {
      new (static_cast<S*>(at.out) + k) S{};
    }
    for (std::size_t k = 0; k < block.states.size(); ++k) {
      new (static_cast<S*>(at.state) + k) S{};
    }
    RunView<S> view(at);
    B::initial(block.sizes, view);
    view.move_on();
  }
  HY_RUN static void output(const Instruction<S>& at) {
    RunView<S> view(at);
    B::output(at.block->sized->sizes, view);
  }
  HY_RUN static void update(const Instruction<S>& at) {
    RunView<S> view(at);
    B::update(at.block->sized->sizes, view);
    view.move_on();
  }
  HY_RUN static void step(const Instruction<S>& at) {
    output(at);
    update(at);
  }
  static constexpr BlockRuns<S> runs() {
    return {.prepare = nullptr, .reset = &reset, .output = &output, .update = &update, .step = &step};
  }
};

template <class S>
BlockCode<S> sized_code(const SizedBlock& block) {
  BlockCode<S> code;
  code.state_size = block.states.size() * sizeof(S);
  code.out_size = block.outputs.size() * sizeof(S);
  code.alignment = alignof(S);
  for (std::size_t k = 0; k < block.states.size(); ++k) {
    code.state_offsets.push_back(k * sizeof(S));
  }
  for (std::size_t k = 0; k < block.outputs.size(); ++k) {
    code.out_offsets.push_back(k * sizeof(S));
  }
  std::size_t place = 0;
  SizedCatalogue::for_each([&]<class B> {
    if (block.kind->about.name == B::about.name) {
      static_cast<BlockRuns<S>&>(code) = run_table<S>().sized[place];
    }
    ++place;
  });
  if (block.states.empty()) {
    code.update = nullptr;
    code.step = code.output;
  }
  return code;
}

}  // namespace hysteron::detail
