// What a program knows of each block of its text: the values of parameters and the first outputs of memory, where they
// are the same in all instances. A network is drawn once for all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/graph/definition.hpp"
#include "codegen/interpreter/machine.hpp"

namespace hysteron::plcopen {

class KnownValues {
 public:
  /// Runs one step of the program with all inputs 0: an output of memory alone then has its first value.
  KnownValues(const Program& program, const Definitions& definitions);

  struct Answer {
    bool known = false;             ///< the program has such a value
    std::optional<double> value{};  ///< none where it differs between instances, and for an array
  };

  /// The parameter of a path below a definition: LAG.T1, or GAIN.
  [[nodiscard]] Answer parameter(std::uint32_t definition, std::string_view path) const;

  /// What an output of an instance of the library is before the first call.
  [[nodiscard]] Answer start(std::uint32_t definition, std::string_view instance, std::size_t output) const;

  /// Whether the top block contains a definition, or is it.
  [[nodiscard]] bool is_used(std::uint32_t definition) const { return !prefixes_[definition].empty(); }

 private:
  void place(const Definitions& definitions, std::uint32_t index, const std::string& prefix);

  const Program& program_;
  Machine<double> machine_;
  std::vector<std::vector<std::string>> prefixes_;  ///< by definition: of its instances; "" at the top, else with a dot
};

}  // namespace hysteron::plcopen
