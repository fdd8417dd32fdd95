// Every block of the catalogue as data: its description, and its trace, from which feedthrough and text are derived.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "blocks/description.hpp"
#include "codegen/trace/tape.hpp"

namespace hysteron {
namespace cosimulation {
class Fmu;
}
struct SizedBlock;

/// A set of a block's pins: its inputs in their order, then its parameters. No block of the library has more than 64;
/// of an FMU, the pins from the 64th on are parameters that no signal drives, and in no set.
class PinSet {
 public:
  static constexpr std::size_t most = 64;
  void insert(std::size_t pin) { bits_ |= pin < most ? std::uint64_t{1} << pin : 0U; }
  [[nodiscard]] bool contains(std::size_t pin) const { return pin < most && ((bits_ >> pin) & 1U) != 0; }
  [[nodiscard]] bool empty() const { return bits_ == 0; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(std::popcount(bits_)); }
  PinSet& operator|=(PinSet other) {
    bits_ |= other.bits_;
    return *this;
  }
  bool operator==(const PinSet&) const = default;

 private:
  std::uint64_t bits_ = 0;
};

/// What a block does, as expressions over its pins (Op::Pin), its state (Op::Cell) and the sample time.
struct BlockTrace {
  Tape tape;
  std::vector<ValueId> initial;       ///< by state; no_value for an array
  std::vector<Store> initial_stores;  ///< arrays at reset
  std::vector<ValueId> outputs;       ///< by output
  std::vector<ValueId> next;          ///< by state; no_value for an array
  std::vector<Store> stores;          ///< arrays at update
  std::vector<PinSet> feedthrough;    ///< by output: the pins that it depends on within the same step
  PinSet update_pins;                 ///< the pins that the update reads, directly or through an output
};

struct BlockType {
  About about;
  std::span<const Field> inputs;
  std::span<const Field> params;
  std::span<const Field> outputs;
  std::span<const Field> states;
  BlockTrace trace;
  const cosimulation::Fmu* fmu = nullptr;  ///< the block is an FMU; null: one of the library
  const SizedBlock* sized = nullptr;       ///< one of the library whose pins are vectors, with its sizes

  [[nodiscard]] std::size_t pin_count() const { return inputs.size() + params.size(); }
  [[nodiscard]] const Field& pin(std::size_t index) const {
    return index < inputs.size() ? inputs[index] : params[index - inputs.size()];
  }
};

/// Fills in feedthrough and update_pins from the rest of a trace.
void derive_reach(BlockTrace& trace);

/// The type of an instance that is an FMU: `PLANT : HY_FMU;  (* @file motor.fmu *)`. Its block is found by the file.
inline constexpr std::string_view fmu_type_name = "HY_FMU";

/// All blocks, in the order of the catalogue.
std::span<const BlockType> block_types();

/// The block of a name, without regard to case; null where there is none.
const BlockType* find_block_type(std::string_view name);

}  // namespace hysteron
