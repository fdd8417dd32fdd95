// The blocks that a bench of tests calls: one for all cases that differ in numbers alone.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "codegen/backends/st/bench.hpp"
#include "codegen/backends/st/pou.hpp"

namespace hysteron {

struct BenchBlock {
  Program program{};
  StBlockAndCaller made{};
  bool float32 = false;
  std::vector<std::size_t> cases{};    ///< their indices
  std::vector<std::size_t> changed{};  ///< parameters that some case sets to another value
};

/// The diagram's own parameters are the defaults of a block. A case of REAL, one that begins with other states or has
/// other arrays, gets a block of its own, with a number behind the name.
[[nodiscard]] std::vector<BenchBlock> blocks_under_test(const StBench& bench, const StDialect& dialect);

/// Throws InputError HY728 with each value of a case that the dialect cannot write.
void refuse_values(const StBench& bench, const StDialect& dialect);

/// The words that no name may be.
[[nodiscard]] bool (*bench_words(const StDialect& dialect))(std::string_view);

}  // namespace hysteron
