// What a word of a diagram names, and all the places that name it: go to definition, references, rename, outline.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codegen/language/syntax.hpp"

namespace hysteron::lsp {

/// What a file declares: a block, or a variable of one. Blocks of the library are declared nowhere in a file.
struct Declared {
  const language::FunctionBlock* block = nullptr;
  const language::Variable* variable = nullptr;  ///< null: the block itself
  friend bool operator==(const Declared&, const Declared&) = default;
  [[nodiscard]] const language::Name& name() const { return variable == nullptr ? block->name : variable->name; }
};

/// What the word at an offset names; no block where it is none of the file's.
[[nodiscard]] Declared declared_at(const language::SourceFile& tree, std::size_t offset);

/// Every place that names it, the declaration among them, in the order of the text. The pins of a block are its
/// variables: `INNER.Y` and `INNER(X := 1.0)` name variables of the block that INNER is of.
[[nodiscard]] std::vector<language::Span> places_of(const language::SourceFile& tree, const Declared& what);

/// Why a thing cannot have another name; empty where it can. A new name is a name of the language, no keyword, no word
/// that the portable subset keeps, and stands for nothing else: the text with it has no error that it had not before.
[[nodiscard]] std::string refused_name(const language::SourceFile& tree, const Declared& what,
                                       std::string_view new_name);

/// The text with another name at all of these places.
[[nodiscard]] std::string renamed(std::string_view text, const std::vector<language::Span>& places,
                                  std::string_view new_name);

}  // namespace hysteron::lsp
