// The layout of a generated step: what its parameters, its state, its inputs and its outputs are called in a target.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/routine.hpp"

namespace hysteron {

/// A variable `group.name`; of the diagram itself where there is no group. It names identifiers that live elsewhere.
struct Member {
  std::string_view group{};
  std::string_view name{};
};

/// By the index that a leaf of the tape has.
struct Layout {
  std::vector<Member> parameters{};
  std::vector<Member> cells{};
  std::vector<std::string_view> inputs{};
  std::vector<std::string_view> outputs{};
  std::vector<std::string_view> instances{};  ///< by node: of a block that stays a block
};

/// What the state takes in memory, without gaps.
std::size_t state_bytes(const Routine& routine, bool float32);

/// The order in which the blocks run, in lines that begin with `comment`; ends in a line break.
std::string schedule_lines(const Program& program, std::string_view comment, std::string_view ellipsis);

}  // namespace hysteron
