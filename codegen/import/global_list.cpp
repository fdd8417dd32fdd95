#include "codegen/import/global_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "codegen/language/lexer.hpp"
#include "support/names.hpp"

namespace hysteron {

using language::Symbol;
using language::Token;

const GlobalVariable* GlobalList::find(std::string_view name) const {
  const auto found = std::ranges::find_if(
      variables, [&](const GlobalVariable& one) { return std::ranges::find(one.names, name) != one.names.end(); });
  return found == variables.end() ? nullptr : &*found;
}

GlobalList read_global_list(std::string_view declaration) {
  language::Lexer lexer(declaration, language::Comments::Annotated, nullptr);
  lexer.take_foreign();
  GlobalList list{.qualified_only = declaration.find("qualified_only") != std::string_view::npos};
  const auto word = [&](const Token& one) { return declaration.substr(one.offset, one.length); };
  const auto is = [&](const Token& one, std::string_view name) {
    return one.symbol == Symbol::Keyword && equal_ignoring_case(word(one), name);
  };
  Token one = lexer.next();
  while (one.symbol != Symbol::End) {
    if (!is(one, "VAR_GLOBAL")) {
      one = lexer.next();
      continue;
    }
    std::string head = "VAR_GLOBAL";
    for (one = lexer.next(); one.symbol == Symbol::Keyword && !is(one, "END_VAR"); one = lexer.next()) {
      head += fmt::format(" {}", word(one));  // CONSTANT, RETAIN
    }
    while (one.symbol != Symbol::End && !is(one, "END_VAR")) {
      GlobalVariable variable;
      const std::size_t begin = one.offset;
      std::size_t end = begin;
      bool typed = false;
      for (; one.symbol != Symbol::End && !is(one, "END_VAR"); one = lexer.next()) {
        typed = typed || one.symbol == Symbol::Colon;
        if (!typed && one.symbol == Symbol::Identifier) {
          variable.names.push_back(in_capitals(word(one)));
        }
        end = one.end();
        if (one.symbol == Symbol::Semicolon) {
          one = lexer.next();
          break;
        }
      }
      // A comment behind it on its line is its own.
      const std::string_view rest = declaration.substr(end, one.offset - end);
      end += std::min(rest.find('\n'), rest.size());
      std::string_view text = declaration.substr(begin, end - begin);
      text = text.substr(0, text.find_last_not_of(" \t\r") + 1);
      variable.text = fmt::format("{}\n  {}\nEND_VAR", head, text);
      list.variables.push_back(std::move(variable));
    }
  }
  return list;
}

std::optional<GlobalList> global_list_of(std::string_view file) {
  pugi::xml_document document;
  const auto result = document.load_buffer(file.data(), file.size());
  const pugi::xml_node list = document.child("TcPlcObject").child("GVL");
  return result && list ? std::optional(read_global_list(list.child_value("Declaration"))) : std::nullopt;
}

}  // namespace hysteron
