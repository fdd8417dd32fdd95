// Definitions: what each FUNCTION_BLOCK of a file declares, checked and ready to be instantiated.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "codegen/language/syntax.hpp"
#include "support/name_index.hpp"

namespace hysteron {

/// What a declared name is.
struct Declared {
  enum class Kind : std::uint8_t { Input, Parameter, Output, Local, Constant, LibraryBlock, UserBlock, Unknown };
  Kind kind = Kind::Local;
  Field field{};                     ///< name, type, unit, range, default of an elementary variable
  bool has_preset = false;           ///< a default or initial value was written
  const BlockType* block = nullptr;  ///< LibraryBlock
  std::uint32_t definition = 0;      ///< UserBlock: which definition
  Rate rate{};                       ///< of an instance: (* @every 4 *)
  const language::Variable* variable = nullptr;
  std::string port{};  ///< of a sequential body: what the body calls it, in upper case
};

struct Definition {
  const language::FunctionBlock* block = nullptr;
  std::vector<Declared> variables{};
  NameIndex by_name{};  ///< variables
  std::int64_t sample_time_ns = 0;
  language::Span sample_time_span{};      ///< where @ts states it; the name where nothing does
  std::string effect{};                   ///< (* @effect creep *): joins the candidates of a diagnosis
  std::string family{};                   ///< (* @family slow_memory *), of that effect
  std::vector<std::uint32_t> in_place{};  ///< of a sequential body: the definitions that it executes in place
  std::vector<bool> late{};               ///< by variable: an output that depends on an input within the same step
  bool usable = true;                     ///< FALSE where an error makes instances pointless
};

struct Definitions {
  std::shared_ptr<const language::SourceFile> source{};
  std::vector<Definition> list{};              ///< in the order of the text
  std::vector<std::uint32_t> callees_first{};  ///< every definition after those that it instantiates
  NameIndex by_name{};
  std::deque<std::string> names{};  ///< that the text does not have: of what a VAR_IN_OUT becomes
};

/// Collects and checks the declarations of a file: names, types, annotations, recursion.
Definitions define(std::shared_ptr<const language::SourceFile> source, Diagnostics& diagnostics);

/// The value of an expression without names: a literal, an operation on literals. False where it is not constant.
bool constant_value(const language::SourceFile& source, language::ExpressionId id, double& value, Type& type);

}  // namespace hysteron
