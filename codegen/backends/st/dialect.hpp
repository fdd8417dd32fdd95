// The dialects of Structured Text: where compilers differ, and how. Each difference has its reason in
// docs/how-to/plc.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace hysteron {

struct StDialect {
  enum class Shape : std::uint8_t {
    OneFile,   ///< FUNCTION_BLOCK … END_FUNCTION_BLOCK
    TwoPanes,  ///< the declaration and the body are pasted one by one, and END_FUNCTION_BLOCK is not written
    Object,    ///< both panes in the XML of a TwinCAT object
    Source     ///< an external source of TIA Portal
  };
  std::string_view name{};
  std::string_view extension{};
  Shape shape = Shape::OneFile;
  std::string_view local_prefix{};  ///< before a variable of the block in its body
  bool named_arguments = false;     ///< functions take their arguments by name
  bool power_operator = false;      ///< X ** Y instead of EXPT(X, Y)
  bool temporary_section = false;   ///< VAR_TEMP for the values within a step
  bool small_literals = false;      ///< a literal of LREAL beyond the range of REAL is refused
  std::size_t longest_name = 0;     ///< of a parameter or a state, so that values within a step fit too; 0: any
};

/// Without regard to case; none where there is no such dialect.
std::optional<StDialect> st_dialect(std::string_view name);

/// Their names, as a list for a message.
std::string_view st_dialect_names();

}  // namespace hysteron
