#include "codegen/backends/st/st.hpp"

#include <fmt/format.h>

#include <set>

#include "codegen/backends/shared/calls.hpp"
#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/st/declarations.hpp"
#include "codegen/backends/st/library_block.hpp"
#include "codegen/backends/st/printer.hpp"
#include "codegen/backends/st/shape.hpp"
#include "codegen/graph/fmu_block.hpp"

namespace hysteron {
namespace {

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
  const bool one_file = holds_several_blocks(dialect.shape);
  std::vector<GeneratedFile> files;
  std::string text = dialect.shape == StDialect::Shape::OneFile ? array_types(library, options.float32) : "";
  for (const LibraryBlock* one : library.list()) {
    std::string block = st_text(one->pou, dialect.shape, mark_of_bodies);
    if (one_file) {
      append(text, block, "\n");
    } else {
      files.push_back({identifier_text({one->name}, LetterCase::Lower) + std::string(dialect.extension), block});
    }
  }
  if (top != nullptr) {
    text += st_text(*top, dialect.shape, mark_of_top);
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
  std::vector<GeneratedFile> files{{stem + std::string(dialect.extension), st_text(made.block, dialect.shape)}};
  if (dialect.shape == StDialect::Shape::OneFile) {
    files.push_back({stem + "_program.st", st_program_text(made.caller)});
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
