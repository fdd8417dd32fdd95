#include "lsp/insight.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "codegen/graph/names.hpp"
#include "codegen/language/lexer.hpp"

namespace hysteron::lsp {
namespace {

using language::Symbol;
using language::Token;
using nlohmann::json;

// CompletionItemKind of LSP 3.17.
constexpr int kind_field = 5;
constexpr int kind_variable = 6;
constexpr int kind_class = 7;

struct Tokens {
  std::vector<Token> list;
  std::vector<language::Comment> comments;
};

/// The tokens of a text that may be broken; what the lexer refuses is left out.
Tokens tokens_of(std::string_view text) {
  language::Reporter refused;
  language::Lexer lexer(text, language::Comments::All, &refused);
  Tokens tokens;
  for (Token one = lexer.next(); one.symbol != Symbol::End; one = lexer.next()) {
    tokens.list.push_back(one);
  }
  tokens.comments = lexer.comments();
  return tokens;
}

std::string_view word(std::string_view text, const Token& token) {
  return text.substr(token.offset, token.length);
}

/// Whether an offset lies in a stretch of the text, or at one of its ends.
bool touches(const language::Span& span, std::size_t offset) {
  return span.offset <= offset && offset <= span.offset + span.length;
}

/// The variable of a name that is nearest to an offset: of the block around it, else of any block of the file.
const language::Variable* variable_in(const language::SourceFile& tree, std::string_view name, std::size_t offset) {
  const language::Variable* found = nullptr;
  for (const auto& block : tree.blocks) {
    const bool around = touches(block.span, offset);
    for (const auto& one : block.variables) {
      if (language::same_name(one.name.text, name) && (around || found == nullptr)) {
        found = &one;
      }
    }
  }
  return found;
}

const language::Variable* variable_of(const Insight& insight, std::string_view name, std::size_t offset) {
  const auto* const now = variable_in(insight.tree, name, offset);
  return now != nullptr || insight.known == nullptr ? now : variable_in(*insight.known, name, offset);
}

const BlockType* type_of(const Insight& insight, std::string_view instance, std::size_t offset) {
  const auto* const variable = variable_of(insight, instance, offset);
  return variable == nullptr ? nullptr : find_block_type(variable->type.text);
}

std::string signature(const Field& field, std::string_view direction) {
  const auto array = field.length > 1 ? fmt::format("ARRAY [0..{}] OF ", field.length - 1) : std::string();
  return fmt::format("{} : {}{}{}{}", direction, array, type_name(field.type), field.unit.empty() ? "" : ", ",
                     field.unit);
}

/// All pins of a block with their direction.
template <class Visit>
void each_pin(const BlockType& block, Visit visit) {
  const auto visit_all = [&](std::span<const Field> fields, std::string_view direction) {
    for (const Field& field : fields) {
      visit(field, direction);
    }
  };
  visit_all(block.inputs, "input");
  visit_all(block.params, "parameter");
  visit_all(block.outputs, "output");
}

std::string pin_text(const BlockType& block, std::string_view name) {
  std::string text;
  each_pin(block, [&](const Field& field, std::string_view direction) {
    if (language::same_name(field.name, name)) {
      text = fmt::format("{}.{}, {}\n{}\n", block.about.name, field.name, signature(field, direction), field.meaning);
    }
  });
  return text;
}

/// The call or the declaration within whose parentheses a token stands: the name before them, none where there is none.
std::string_view called_name(std::string_view text, const std::vector<Token>& tokens, std::size_t before) {
  int depth = 0;
  for (std::size_t i = before; i-- > 0;) {
    const auto symbol = tokens[i].symbol;
    if (symbol == Symbol::Semicolon) {
      return {};
    }
    depth += symbol == Symbol::RightParenthesis ? 1 : symbol == Symbol::LeftParenthesis ? -1 : 0;
    if (depth < 0) {
      const auto name = i > 1 && tokens[i - 1].symbol == Symbol::Assign ? i - 2 : i - 1;
      return i > 0 && tokens[name].symbol == Symbol::Identifier ? word(text, tokens[name]) : std::string_view();
    }
  }
  return {};
}

/// The block of what is called: of an instance, or the type itself in `X : HY_LAG := (…)`.
const BlockType* called_type(const Insight& insight, std::string_view name, std::size_t offset) {
  const auto* const own = find_block_type(name);
  return own != nullptr || name.empty() ? own : type_of(insight, name, offset);
}

}  // namespace

std::string hover(const Insight& insight, std::size_t offset, const Card& card) {
  const auto tokens = tokens_of(insight.text).list;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Token& token = tokens[i];
    if (token.symbol != Symbol::Identifier || offset < token.offset || offset > token.end()) {
      continue;
    }
    const auto name = word(insight.text, token);
    if (i > 1 && tokens[i - 1].symbol == Symbol::Dot) {
      const auto* const block = type_of(insight, word(insight.text, tokens[i - 2]), offset);
      return block == nullptr ? std::string() : pin_text(*block, name);
    }
    if (i + 1 < tokens.size() && tokens[i + 1].symbol == Symbol::Assign) {
      if (const auto* const block = called_type(insight, called_name(insight.text, tokens, i), offset)) {
        return pin_text(*block, name);
      }
    }
    if (const auto* const block = called_type(insight, name, offset)) {
      return card(*block);
    }
    if (const auto* const variable = variable_of(insight, name, offset)) {
      auto text = fmt::format("{} : {}\n", variable->name.text, variable->type.text);
      for (const auto& one : variable->annotations) {
        text += fmt::format("@{} {}\n", one.key, one.value);
      }
      return text;
    }
    return {};
  }
  return {};
}

json completion(const Insight& insight, std::size_t offset) {
  auto items = json::array();
  const auto add = [&](std::string_view label, int kind, const std::string& detail) {
    items.push_back({{"label", label}, {"kind", kind}, {"detail", detail}});
  };
  const auto tokens = tokens_of(insight.text);
  for (const auto& comment : tokens.comments) {
    if (offset > comment.span.offset && offset < comment.span.offset + comment.span.length) {
      return items;
    }
  }
  // The word that is being typed is no context: what stands before it is.
  std::size_t before = 0;
  while (before < tokens.list.size() && tokens.list[before].end() <= offset &&
         !(tokens.list[before].end() == offset && tokens.list[before].symbol <= Symbol::Keyword)) {
    ++before;
  }
  const auto symbol = before > 0 ? tokens.list[before - 1].symbol : Symbol::Semicolon;
  if (symbol == Symbol::Dot) {
    const auto* const block =
        before > 1 ? type_of(insight, word(insight.text, tokens.list[before - 2]), offset) : nullptr;
    if (block != nullptr) {
      for (const Field& field : block->outputs) {
        add(field.name, kind_field, signature(field, "output"));
      }
    }
    return items;
  }
  if (symbol == Symbol::Colon) {
    for (const BlockType& block : block_types()) {
      add(block.about.name, kind_class, std::string(block.about.title));
    }
    for (const auto& block : insight.tree.blocks) {
      add(block.name.text, kind_class, "FUNCTION_BLOCK of this file");
    }
    return items;
  }
  if (symbol == Symbol::LeftParenthesis || symbol == Symbol::Comma) {
    const auto name = called_name(insight.text, tokens.list, before);
    if (const auto* const block = called_type(insight, name, offset)) {
      // An instance is given its inputs in a call and its parameters where it is declared; a call may give both.
      each_pin(*block, [&](const Field& field, std::string_view direction) {
        if (direction != "output") {
          add(field.name, kind_field, signature(field, direction));
        }
      });
      return items;
    }
  }
  const auto& tree = insight.tree.valid || insight.known == nullptr ? insight.tree : *insight.known;
  for (const auto& block : tree.blocks) {
    if (tree.blocks.size() > 1 && !touches(block.span, offset)) {
      continue;
    }
    for (const auto& one : block.variables) {
      add(one.name.text, kind_variable, std::string(one.type.text));
    }
  }
  return items;
}

}  // namespace hysteron::lsp
