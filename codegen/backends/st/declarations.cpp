#include "codegen/backends/st/declarations.hpp"

#include <fmt/format.h>

#include <string_view>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/comment.hpp"

namespace hysteron {
namespace {

constexpr std::size_t widest_line = 110;

/// The elements of a long array stand in lines of their own: some editors cut a line that is too long.
std::string value_text(const StVariable& variable) {
  if (variable.length == 1) {
    return variable.values.front();
  }
  std::string text = "[";
  std::size_t line = 0;  // where the present one begins
  for (std::size_t i = 0; i < variable.values.size(); ++i) {
    text += i == 0 ? "" : ",";
    if (text.size() - line + variable.values[i].size() > widest_line) {
      line = text.size() + 1;
      text += "\n      ";
    } else {
      text += i == 0 ? "" : " ";
    }
    text += variable.values[i];
  }
  return text + "]";
}

void append_declaration(std::string& text, std::string_view names, const StVariable& variable) {
  append(text, "    ", names, " : ",
         !variable.array_type.empty() ? variable.array_type
         : variable.length > 1        ? fmt::format("ARRAY[0..{}] OF {}", variable.length - 1, variable.type)
                                      : variable.type);
  if (!variable.values.empty()) {
    append(text, " := ", value_text(variable));
  }
  text += ';';
  if (!variable.remark.empty()) {
    append(text, "  (* ", st_comment(variable.remark), " *)");
  }
  text += '\n';
}

void append_names(std::string& text, const std::vector<StVariable>& variables) {
  std::string line;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const StVariable& one = variables[i];
    append(line, line.empty() ? "" : ", ", one.name);
    const bool last = i + 1 == variables.size() || variables[i + 1].type != one.type ||
                      variables[i + 1].length != one.length || !one.remark.empty() || !variables[i + 1].remark.empty();
    if (last || line.size() + variables[i + 1].name.size() > widest_line) {
      append_declaration(text, line, one);
      line.clear();
    }
  }
}

}  // namespace

std::string st_array_type(std::uint16_t length) {
  return fmt::format("HY_ARRAY_{}", length);
}

std::string st_declarations(const std::vector<StSection>& sections) {
  std::string text;
  for (const StSection& section : sections) {
    append(text, "  ", section.keyword);
    if (!section.remark.empty()) {
      append(text, "  (* ", section.remark, " *)");
    }
    text += '\n';
    if (section.names_share_lines) {
      append_names(text, section.variables);
    } else {
      for (const StVariable& one : section.variables) {
        append_declaration(text, one.name, one);
      }
    }
    text += "  END_VAR\n";
  }
  return text;
}

}  // namespace hysteron
