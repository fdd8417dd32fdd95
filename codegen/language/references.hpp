// The names that an expression reads.
#pragma once

#include "codegen/language/syntax.hpp"

namespace hysteron::language {

/// Visits every reference below an expression, from left to right.
template <class Visit>
void for_each_reference(const SourceFile& file, ExpressionId id, const Visit& visit) {
  const auto& node = file.expressions[id].node;
  if (const auto* reference = std::get_if<Reference>(&node)) {
    visit(*reference);
  } else if (const auto* unary = std::get_if<Unary>(&node)) {
    for_each_reference(file, unary->operand, visit);
  } else if (const auto* binary = std::get_if<Binary>(&node)) {
    for_each_reference(file, binary->left, visit);
    for_each_reference(file, binary->right, visit);
  } else if (const auto* call = std::get_if<FunctionCall>(&node)) {
    for (const auto& argument : call->arguments) {
      for_each_reference(file, argument.value, visit);
    }
  }
}

}  // namespace hysteron::language
