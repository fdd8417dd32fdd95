// A member of a structure in C++, with its unit and meaning beside it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/c_family/printer.hpp"
#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/shared/layout.hpp"

namespace hysteron {

/// With the values that it begins with; none for a member of the state, which reset gives its value. `literal(value)` is
/// a value as text; where it is one in braces, an array of them needs a second pair round it.
template <class Literal>
void append_cpp_member(std::string& text, std::string_view type, const Field& field, const Member& member,
                       const std::vector<double>* values, bool in_braces, Literal literal) {
  append(text, member.group.empty() ? "  " : "    ");
  if (field.length > 1) {
    append(text, "std::array<", type, ", ", std::to_string(field.length), "> ");
  } else {
    append(text, type, " ");
  }
  append(text, member.name);
  if (values == nullptr) {
    append(text, "{}");
  } else if (field.length > 1) {
    for (std::size_t i = 0; i < values->size(); ++i) {
      append(text, i > 0 ? ", " : (in_braces ? "{{" : "{"), literal((*values)[i]));
    }
    append(text, in_braces ? "}}" : "}");
  } else {
    append(text, " = ", literal(values->front()));
  }
  append(text, ";");
  append_comment(text, "  // ", field.unit, field.meaning, "");
  append(text, "\n");
}

}  // namespace hysteron
