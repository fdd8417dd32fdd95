#include "codegen/backends/st/st.hpp"

#include <fmt/format.h>

#include <set>

#include "codegen/backends/shared/calls.hpp"
#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/st/library_block.hpp"
#include "codegen/backends/st/printer.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "support/sha256.hpp"

namespace hysteron {
namespace {

/// A GUID that is the same for the same name: a project then knows the object that it has.
std::string identity(std::string_view name) {
  const std::string digits = sha256(fmt::format("hysteron {}", name));
  return fmt::format("{}-{}-4{}-8{}-{}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 3),
                     digits.substr(15, 3), digits.substr(18, 12));
}

/// `mark` stands behind the name.
std::string in_shape(const StPou& block, StDialect::Shape shape, std::string_view mark = "") {
  const bool siemens = shape == StDialect::Shape::Source;
  const std::string declaration =
      block.head +
      (siemens ? fmt::format("FUNCTION_BLOCK \"{}\"\n{{ S7_Optimized_Access := 'TRUE' }}\nVERSION : 0.1\n", block.name)
               : fmt::format("FUNCTION_BLOCK {}{}\n", block.name, mark)) +
      st_declarations(block.sections);
  switch (shape) {
    case StDialect::Shape::OneFile:
      return declaration + "\n" + block.body + "END_FUNCTION_BLOCK\n";
    case StDialect::Shape::TwoPanes:
      return declaration + "\n(* ---- above: the declaration; below: the body ---- *)\n\n" + block.body;
    case StDialect::Shape::Source:
      return declaration + "BEGIN\n" + block.body + "END_FUNCTION_BLOCK\n";
    case StDialect::Shape::Object:
      return fmt::format(
          R"(<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1">
  <POU Name="{}" Id="{{{}}}" SpecialFunc="None">
    <Declaration><![CDATA[{}]]></Declaration>
    <Implementation>
      <ST><![CDATA[{}]]></ST>
    </Implementation>
  </POU>
</TcPlcObject>
)",
          block.name, identity(block.name), declaration, block.body);
  }
  return "";
}

/// The types of arrays that blocks are handed, in front of them.
std::string array_types(const LibraryText& library, bool float32) {
  std::set<std::uint16_t> lengths;
  for (const LibraryBlock* one : library.list()) {
    for (const Field& field : one->block->params) {
      if (field.length > 1) {
        lengths.insert(field.length);
      }
    }
  }
  std::string text;
  for (const std::uint16_t length : lengths) {
    text += fmt::format("TYPE\n  {} : ARRAY[0..{}] OF {};\nEND_TYPE\n\n", st_array_type(length), length - 1,
                        st_type(Type::Real, float32));
  }
  return text;
}

/// The mark tells Hysteron's own front end that the order of the statements is meant.
constexpr std::string_view mark_of_bodies = "  (* @body *)";

std::vector<GeneratedFile> together(const LibraryText& library, const StPou* top, const StOptions& options,
                                    const std::string& name, const std::string& mark_of_top) {
  const StDialect& dialect = options.dialect;
  const bool one_file = dialect.shape == StDialect::Shape::OneFile || dialect.shape == StDialect::Shape::Source;
  std::vector<GeneratedFile> files;
  std::string text = dialect.shape == StDialect::Shape::OneFile ? array_types(library, options.float32) : "";
  for (const LibraryBlock* one : library.list()) {
    std::string block = in_shape(one->pou, dialect.shape, mark_of_bodies);
    if (one_file) {
      append(text, block, "\n");
    } else {
      files.push_back({identifier_text({one->name}, LetterCase::Lower) + std::string(dialect.extension), block});
    }
  }
  if (top != nullptr) {
    text += in_shape(*top, dialect.shape, mark_of_top);
  }
  if (one_file || top != nullptr) {
    files.insert(files.begin(), {name, std::move(text)});
  }
  return files;
}

}  // namespace

std::vector<GeneratedFile> generate_st(const Program& program, const StOptions& options) {
  const StBlockAndCaller made = make_st_pou(program, options);
  const StDialect& dialect = options.dialect;
  const std::string stem = identifier_text({program.graph.name}, LetterCase::Lower);
  std::vector<GeneratedFile> files{{stem + std::string(dialect.extension), in_shape(made.block, dialect.shape)}};
  if (dialect.shape == StDialect::Shape::OneFile) {
    files.push_back(
        {stem + "_program.st", fmt::format("{}PROGRAM {}\n{}\n{}END_PROGRAM\n", made.caller.head, made.caller.name,
                                           st_declarations(made.caller.sections), made.caller.body)});
  }
  return files;
}

std::vector<GeneratedFile> generate_st_structured(const Program& program, const StOptions& options) {
  require_generable(program.graph);
  StCalls calls{.made = make_calls(program)};
  LibraryText library(program.graph.sample_time_ns, options);
  for (const BlockInstance& one : calls.made.instances) {
    const LibraryBlock& block = library.block(*program.graph.nodes[one.node].block, one.ahead);
    calls.blocks.push_back({.type = block.name, .sample_time = block.sample_time});
  }
  StOptions own = options;
  own.calls = &calls;
  const StPou top = make_st_pou(program, own).block;
  return together(library, &top, options,
                  identifier_text({program.graph.name}, LetterCase::Lower) + std::string(options.dialect.extension),
                  fmt::format("  (* @body @ts {}ns *)", program.graph.sample_time_ns));
}

std::vector<GeneratedFile> generate_st_library(std::int64_t sample_time_ns, const StOptions& options) {
  LibraryText library(sample_time_ns, options);
  for (const BlockType& type : block_types()) {
    for (const bool open_pins : {true, false}) {
      library.block(type, outputs_of_memory(type, open_pins));
    }
  }
  return together(library, nullptr, options, "hysteron_library" + std::string(options.dialect.extension), "");
}

}  // namespace hysteron
