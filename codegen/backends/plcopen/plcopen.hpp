// The PLCopen target: a project in TC6 XML, with the step as Structured Text or the diagram as a network.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

enum class PlcopenBody : std::uint8_t {
  Text,    ///< one function block that needs no other, in Structured Text
  Network  ///< the diagram as a network, with the blocks that it calls as POUs of their own
};

struct PlcopenOptions {
  std::string_view dialect = "portable";
  PlcopenBody body = PlcopenBody::Text;
  bool float32 = false;
  /// What `dot -Tplain` makes of a text; asked for a network alone.
  std::function<std::string(const std::string& dot)> place{};
};

/// Whether there is such a dialect, and the names of all.
[[nodiscard]] bool is_plcopen_dialect(std::string_view name);
[[nodiscard]] std::string plcopen_dialect_names();

/// One file. The text depends on the program and on the places alone, to the byte. Throws InputError: HY404 where the
/// diagram states no sample time, HY742 where no network can hold it.
std::vector<GeneratedFile> generate_plcopen(const Program& program, const PlcopenOptions& options);

}  // namespace hysteron
