// Annotations: what comments say of declarations, and which declaration a comment speaks of.
//
// A comment belongs to the declaration that it stands in, or that ended last before it on the same line. Behind
// `FUNCTION_BLOCK NAME` it belongs to the block, on the same line or on the next ones. An annotation anywhere else
// would be lost silently, and is an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "codegen/language/lexer.hpp"
#include "codegen/language/reporter.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron::language {

/// The stretch of one declaration, or of the head of a block, and what it declares. A declaration that was not
/// understood owns its comments too, but has no variables.
struct Declaration {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::size_t block = 0;
  std::size_t first_variable = 0;
  std::size_t variable_count = 0;
  bool is_head = false;
};

/// A key of ours, and what it says.
struct AnnotationKey {
  std::string_view name;
  std::string_view meaning;
  bool of_diagrams = false;  ///< it stands beside what a sequential body cannot have
};
std::span<const AnnotationKey> annotation_keys();

/// The annotations of a comment. A value ends at the next key, at the end of its line, or of the comment.
std::vector<Annotation> annotations_of(std::string_view text, Span comment);

/// Gives each annotation to its declaration. Declarations stand in the order of the text.
void attach_annotations(SourceFile& file, const std::vector<Comment>& comments,
                        const std::vector<Declaration>& declarations, Reporter& reporter);

/// The value of @ts in whole nanoseconds: `50us`, `1 ms`, `0.5s`; false where it is none.
bool duration_of(std::string_view text, std::int64_t& nanoseconds);

/// Whether a comment of a PLC program, in which @ may mean anything, holds none of the keys that are ours.
bool has_no_key_of_ours(std::string_view text, Span comment);

}  // namespace hysteron::language
