// Blocks whose pins are vectors, as data: for given sizes such a block is a BlockType like any other, with a pin for
// each element and a trace for that size. An instance says its sizes by the lists of its parameters.
#pragma once

#include <array>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "blocks/sized.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron {

/// A block of the catalogue before it has sizes.
struct SizedKind {
  About about{};
  std::span<const SizedField> inputs{};
  std::span<const SizedField> params{};
  std::span<const SizedField> outputs{};
  std::span<const SizedField> states{};
  std::string_view example{};  ///< the settings of an instance
  Sizes example_sizes{};
  SizeRule size_rule = SizeRule::Matrix;
  /// What an instance says beside its parameters: ROWS, or the coefficients that become them.
  std::span<const std::string_view> settings{};
  bool is_discretised = false;  ///< whether settings become parameters at the sample time
};

/// All kinds, in the order of the catalogue.
std::span<const SizedKind> sized_kinds();
/// The kind of a name, without regard to case; null where there is none.
const SizedKind* find_sized_kind(std::string_view name);

/// A kind with sizes.
struct SizedBlock {
  const SizedKind* kind = nullptr;
  Sizes sizes{};
  std::array<std::uint16_t, 8> first_input{};  ///< by field: its first pin
  std::array<std::uint16_t, 8> first_param{};  ///< counted through all pins
  std::deque<std::string> names{};
  std::vector<Field> inputs{};
  std::vector<Field> params{};
  std::vector<Field> outputs{};
  std::vector<Field> states{};
  BlockType type{};
};

/// The block of a kind for its sizes. It lives as long as the process.
const BlockType& sized_block(const SizedKind& kind, const Sizes& sizes);

/// All blocks of the library, those with sizes as the instance of their example.
std::vector<const BlockType*> documented_blocks();

/// The block of a name, of one with sizes the instance of its example; null where there is none.
const BlockType* find_documented_block(std::string_view name);

/// As a type of the text: HY_STATE_SPACE[2,1,1]. Null for any other text.
std::string sized_type_text(const SizedKind& kind, const Sizes& sizes);
const BlockType* find_sized_block(std::string_view type_text);

/// How many numbers at the beginning of a parameter only scale the others, so that a fit cannot tell them.
std::size_t scaling_numbers(const BlockType& block, std::size_t param);

/// What an instance gives: numbers, by the name of a parameter or a setting.
struct GivenNumbers {
  std::string_view name{};
  std::vector<double> numbers{};
};
struct SizeProblem {
  std::string_view name{};  ///< of what was given; empty: something is missing
  std::string cause{};
  std::string mend{};
};
/// The sizes that the numbers say, or what is wrong with them.
std::variant<Sizes, SizeProblem> sizes_of(const SizedKind& kind, std::span<const GivenNumbers> given);

}  // namespace hysteron
