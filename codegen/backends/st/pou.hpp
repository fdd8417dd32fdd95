// A FUNCTION_BLOCK in Structured Text in its parts: its head, what it declares, its body. A text shows them one behind
// the other, an XML file each in its own element.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codegen/backends/shared/calls.hpp"
#include "codegen/backends/st/dialect.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

/// The blocks of a diagram that stay blocks.
struct StCalls {
  struct BlockName {
    std::string type{};        ///< what the block is called in the text
    bool sample_time = false;  ///< it has an input TS
  };
  CallRoutine made{};
  std::vector<BlockName> blocks{};  ///< by instance
};

struct StOptions {
  StDialect dialect{};
  bool float32 = false;               ///< REAL in place of LREAL
  std::vector<bool> outputs_ahead{};  ///< see RoutineOptions
  /// A block of the library: the sample time is an input, and a call with RESET makes no step.
  bool library = false;
  bool keeps_pins = false;         ///< of a block of the library: see st_pin_name
  const StCalls* calls = nullptr;  ///< the blocks of the diagram stay blocks
};

/// One declared name.
struct StVariable {
  std::string name{};
  std::string type{};                 ///< of an element, where it is an array
  std::uint32_t length = 1;           ///< above 1: ARRAY[0..length - 1]
  std::string array_type{};           ///< the name of its array type, where it has one
  std::vector<std::string> values{};  ///< the initial value: none, one, or those of the elements
  std::string remark{};               ///< unit, range and meaning, not yet a comment
};

struct StSection {
  std::string keyword{};  ///< VAR_INPUT, VAR CONSTANT, …
  std::string remark{};
  std::vector<StVariable> variables{};
  bool names_share_lines = false;  ///< variables of one type that follow each other are declared together
};

struct StPou {
  std::string name{};
  std::string head{};  ///< a comment
  std::vector<StSection> sections{};
  std::string body{};
};

/// What a caller of the block names, by index.
struct StInterface {
  std::vector<std::string> inputs{};
  std::vector<std::string> outputs{};
  std::vector<std::string> parameters{};  ///< inputs, too
  std::string reset{};                    ///< an input: the memory begins anew
};

/// A program, and what is called around it.
struct StBlockAndCaller {
  StPou block{};
  StInterface interface {};
  StPou caller{};  ///< a PROGRAM that calls one instance in each cycle
};

/// Throws InputError: HY404 where the diagram states no sample time, HY732 where a name is longer than the dialect
/// allows.
StBlockAndCaller make_st_pou(const Program& program, const StOptions& options);

}  // namespace hysteron
