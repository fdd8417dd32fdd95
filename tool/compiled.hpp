// Generated C++, compiled by the system's compiler and run: the other half of "generated equals interpreted".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {

struct GeneratedProgram {
  const Program* program = nullptr;
  bool float32 = false;
};

/// Several diagrams in one executable, so that the compiler is called once. It is kept and
/// not compiled again: see built_program.
class CompiledPrograms {
 public:
  /// Throws InputError: HY725 without a compiler, HY726 where the compiler refuses, HY404 for a diagram without a
  /// sample time.
  explicit CompiledPrograms(const std::vector<GeneratedProgram>& programs);

  /// Runs one of them over inputs; the values of its outputs, each over all steps. Throws InputError HY726.
  [[nodiscard]] std::vector<Signal> run(std::size_t program, const Drive& drive) const;

 private:
  struct Shape {
    std::string name{};
    std::size_t inputs = 0;
    std::size_t outputs = 0;
  };
  std::vector<Shape> shapes_;
  std::filesystem::path executable_;
  std::filesystem::path scratch_;
};

/// Whether two signals have the same bits; all not-a-numbers are one. The first step where they differ, else npos.
inline constexpr std::size_t same_bits = static_cast<std::size_t>(-1);
[[nodiscard]] std::size_t first_difference(const Signal& a, const Signal& b);

}  // namespace hysteron::tool
