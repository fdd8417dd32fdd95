// The batch target: thousands of instances of one step, eight in the lanes of a vector at a time.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

/// Instances that are computed at once. A processor with narrower registers takes two or four of its own for them.
inline constexpr std::size_t batch_width = 8;

/// What a batch is to be compiled with besides `cpp_numeric_flags`: roots that a vector can hold.
inline constexpr std::string_view batch_flags = "-O2 -fno-math-errno -Wno-psabi";

/// NAME_batch.hpp: structures of vectors, and reset and step over packs of eight instances. It needs C++17 and GCC;
/// Clang takes registers of two numbers. Each lane has the bits of `hysteron run`. With HYSTERON_BATCH_FAST defined,
/// exp, log, pow and the like are those of libmvec where there is one, within 4 units in the last place. The text
/// depends on the program alone, to the byte. Throws InputError (HY404) where the diagram states no sample time.
GeneratedFile generate_batch(const Program& program);

/// What the header calls things.
struct BatchNames {
  std::string space{};                    ///< the namespace
  std::vector<std::string> parameters{};  ///< of Params, by parameter of the graph: inv.c1
  std::vector<std::string> inputs{};
  std::vector<std::string> outputs{};
};
BatchNames batch_names(const Program& program);

/// C++ that makes of a number what a lane of a type holds, and the other way round: TRUE is -1 in a lane.
std::string lane_of_number(Type type, std::string_view number);
std::string number_of_lane(Type type, std::string_view lane);

}  // namespace hysteron
