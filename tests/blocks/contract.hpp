// How the tests of the contract go through the catalogue.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/blocks/any_block.hpp"

namespace hysteron::testing {

inline constexpr int steps = 400;
inline constexpr std::array<double, 3> sample_times{50e-6, 1e-3, 1.0};

/// A block of the catalogue, in the scalars that the contract holds for.
struct ContractBlock : AnyBlock {
  MakeRun<AnyRun<double>> in_float = nullptr;
  MakeRun<AnyRun<double>> in_explicit_double = nullptr;
  bool is_function_block = false;
  bool is_trivially_copyable = false;  ///< its parameters and its state
};

/// The catalogue, in its order.
const std::vector<ContractBlock>& contract_blocks();

/// The block of this name, HY_LAG; a name that is none throws std::out_of_range.
const ContractBlock& contract_block(std::string_view name);

/// Calls visit(block) for every block, with the block's name in every failure.
template <class Visit>
void for_each_block(Visit visit) {
  for (const ContractBlock& block : contract_blocks()) {
    SCOPED_TRACE(std::string(block.about->name));
    visit(block);
  }
}

/// Calls visit(block, seed, ts) for every block with several sample times and seeds.
template <class Visit>
void for_each_run(Visit visit) {
  for_each_block([&](const ContractBlock& block) {
    for (const double ts : sample_times) {
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", TS " + std::to_string(ts));
        visit(block, seed, ts);
      }
    }
  });
}

}  // namespace hysteron::testing
