#include "lsp/insight.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "codegen/graph/names.hpp"
#include "codegen/trace/sized_block.hpp"
#include "lsp/annotations.hpp"
#include "lsp/words.hpp"
#include "support/element_name.hpp"

namespace hysteron::lsp {
namespace {

using language::Symbol;
using language::Token;
using nlohmann::json;

// CompletionItemKind of LSP 3.17.
constexpr int kind_field = 5;
constexpr int kind_variable = 6;
constexpr int kind_class = 7;
constexpr int kind_keyword = 14;

/// What a statement or a section may begin with.
constexpr std::array<std::string_view, 9> statement_words{
    "FUNCTION_BLOCK", "END_FUNCTION_BLOCK", "VAR_INPUT", "VAR_OUTPUT", "VAR", "VAR CONSTANT", "END_VAR", "IF",
    "END_IF"};

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
  return variable == nullptr ? nullptr : find_documented_block(variable->type.text);
}

/// The block of the file of a name; where the text is broken, of the last text that was not.
const language::FunctionBlock* own_block(const Insight& insight, std::string_view name) {
  for (const auto* const tree : {&insight.tree, insight.known}) {
    if (tree != nullptr) {
      for (const auto& block : tree->blocks) {
        if (language::same_name(block.name.text, name)) {
          return &block;
        }
      }
    }
  }
  return nullptr;
}

/// The block of the file that is called: of an instance, or the type itself.
const language::FunctionBlock* own_type(const Insight& insight, std::string_view name, std::size_t offset) {
  const auto* const variable = variable_of(insight, name, offset);
  return own_block(insight, variable == nullptr ? name : variable->type.text);
}

/// A variable as it was declared, with what its annotations say.
std::string declaration_text(const language::Variable& variable) {
  auto text =
      fmt::format("{} : {}{}\n", variable.name.text, variable.is_vector() ? "ARRAY OF " : "", variable.type.text);
  for (const auto& one : variable.annotations) {
    text += fmt::format("@{} {}\n", one.key, one.value);
  }
  return text;
}

std::string own_pin_text(const language::FunctionBlock* block, std::string_view name) {
  if (block != nullptr) {
    for (const auto& one : block->variables) {
      if (language::same_name(one.name.text, name)) {
        return fmt::format("{}.{}", block->name.text, declaration_text(one));
      }
    }
  }
  return {};
}

std::string signature(const Field& field, std::string_view direction) {
  const auto array = field.length > 1 ? fmt::format("ARRAY [0..{}] OF ", field.length - 1) : std::string();
  return fmt::format("{} : {}{}{}{}", direction, array, type_name(field.type), field.unit.empty() ? "" : ", ",
                     field.unit);
}

/// All pins of a block with their direction; a vector, which has a pin for each element, once.
template <class Visit>
void each_pin(const BlockType& block, Visit visit) {
  const auto visit_all = [&](std::span<const Field> fields, std::string_view direction) {
    for (Field field : fields) {
      if (const auto element = element_of(field.name)) {
        if (element->index > 0) {
          continue;
        }
        field.name = element->vector;
      }
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

/// The block of what is called: of an instance, or the type itself in `X : HY_LAG := (…)`.
const BlockType* called_type(const Insight& insight, std::string_view name, std::size_t offset) {
  const auto* const own = find_documented_block(name);
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
      return block != nullptr ? pin_text(*block, name)
                              : own_pin_text(own_type(insight, word(insight.text, tokens[i - 2]), offset), name);
    }
    if (i + 1 < tokens.size() && tokens[i + 1].symbol == Symbol::Assign) {
      const auto called = called_name(insight.text, tokens, i);
      if (const auto* const block = called_type(insight, called, offset)) {
        return pin_text(*block, name);
      }
      if (const auto* const own = called.empty() ? nullptr : own_type(insight, called, offset)) {
        return own_pin_text(own, name);
      }
    }
    if (const auto* const block = called_type(insight, name, offset)) {
      return card(*block);
    }
    if (const auto* const variable = variable_of(insight, name, offset)) {
      return declaration_text(*variable);
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
  const auto add_own = [&](const language::FunctionBlock* block, language::Section section) {
    if (block != nullptr) {
      for (const auto& one : block->variables) {
        if (one.section == section) {
          add(one.name.text, kind_field, std::string(one.type.text));
        }
      }
    }
  };
  const auto tokens = tokens_of(insight.text);
  for (const auto& comment : tokens.comments) {
    if (offset > comment.span.offset && offset < comment.span.offset + comment.span.length) {
      return annotation_completion(insight.text, insight.known == nullptr ? insight.tree : *insight.known, comment.span,
                                   offset);
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
    } else if (before > 1) {
      add_own(own_type(insight, word(insight.text, tokens.list[before - 2]), offset), language::Section::Output);
    }
    return items;
  }
  if (symbol == Symbol::Colon) {
    for (const BlockType* const block : documented_blocks()) {
      add(block->about.name, kind_class, std::string(block->about.title));
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
    if (const auto* const own = name.empty() ? nullptr : own_type(insight, name, offset)) {
      add_own(own, language::Section::Input);
      return items;
    }
  }
  if (symbol == Symbol::Semicolon || symbol == Symbol::Keyword) {
    for (const std::string_view keyword : statement_words) {
      add(keyword, kind_keyword, "a keyword");
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
