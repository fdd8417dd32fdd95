#include "lsp/symbols.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "codegen/compile.hpp"
#include "codegen/graph/names.hpp"
#include "lsp/words.hpp"

namespace hysteron::lsp {
namespace {

using language::FunctionBlock;
using language::Symbol;
using language::Token;

const FunctionBlock* block_named(const language::SourceFile& tree, std::string_view name) {
  const auto found = std::ranges::find_if(
      tree.blocks, [&](const FunctionBlock& block) { return language::same_name(block.name.text, name); });
  return found == tree.blocks.end() ? nullptr : &*found;
}

const language::Variable* variable_named(const FunctionBlock& block, std::string_view name) {
  const auto found = std::ranges::find_if(block.variables, [&](const language::Variable& variable) {
    return language::same_name(variable.name.text, name);
  });
  return found == block.variables.end() ? nullptr : &*found;
}

/// The words of a file with what they name.
class Words {
 public:
  explicit Words(const language::SourceFile& tree)
      : tree_(tree), text_(*tree.text), tokens_(tokens_of(*tree.text).list) {}

  [[nodiscard]] const std::vector<Token>& tokens() const { return tokens_; }

  /// What a token names.
  [[nodiscard]] Declared declared(std::size_t i) const {
    if (tokens_[i].symbol != Symbol::Identifier) {
      return {};
    }
    const std::string_view name = word(text_, tokens_[i]);
    const FunctionBlock* const around = block_around(tokens_[i].offset);
    if (around == nullptr) {
      return {};
    }
    if (follows(i, Symbol::Dot)) {
      return i > 1 ? pin(type_of(*around, word(text_, tokens_[i - 2])), name) : Declared{};
    }
    if (i + 1 < tokens_.size() && tokens_[i + 1].symbol == Symbol::Assign) {
      if (const std::string_view called = called_name(text_, tokens_, i); !called.empty()) {
        const FunctionBlock* const own = block_named(tree_, called);
        return pin(own != nullptr ? own : type_of(*around, called), name);
      }
    }
    if (follows(i, Symbol::Colon) || (i > 0 && tokens_[i - 1].keyword == language::Keyword::FunctionBlock)) {
      return {.block = block_named(tree_, name)};
    }
    const language::Variable* const variable = variable_named(*around, name);
    return variable == nullptr ? Declared{} : Declared{.block = around, .variable = variable};
  }

 private:
  [[nodiscard]] bool follows(std::size_t i, Symbol symbol) const { return i > 0 && tokens_[i - 1].symbol == symbol; }

  [[nodiscard]] const FunctionBlock* block_around(std::uint32_t offset) const {
    const auto found = std::ranges::find_if(tree_.blocks, [&](const FunctionBlock& block) {
      return block.span.offset <= offset && offset < block.span.offset + block.span.length;
    });
    return found == tree_.blocks.end() ? nullptr : &*found;
  }

  /// The block of this file that an instance is of.
  [[nodiscard]] const FunctionBlock* type_of(const FunctionBlock& around, std::string_view instance) const {
    const language::Variable* const variable = variable_named(around, instance);
    return variable == nullptr ? nullptr : block_named(tree_, variable->type.text);
  }

  [[nodiscard]] static Declared pin(const FunctionBlock* block, std::string_view name) {
    const language::Variable* const variable = block == nullptr ? nullptr : variable_named(*block, name);
    return variable == nullptr ? Declared{} : Declared{.block = block, .variable = variable};
  }

  const language::SourceFile& tree_;
  std::string_view text_;
  std::vector<Token> tokens_;
};

bool is_word(std::string_view name) {
  const std::vector<Token> tokens = tokens_of(name).list;
  return tokens.size() == 1 && tokens.front().symbol == Symbol::Identifier && tokens.front().length == name.size();
}

std::vector<std::string> errors_of(const std::string& path, const std::string& text) {
  Diagnostics found;
  try {
    const auto tree = std::make_shared<const language::SourceFile>(language::parse(path, text, found));
    if (!found.has_errors()) {
      check(tree, found);
    }
  } catch (const InputError& error) {
    found = error.diagnostics();
  }
  std::vector<std::string> result;
  for (const Diagnostic& one : found.all()) {
    if (one.severity == Severity::Error) {
      result.push_back(fmt::format("HY{:03}: {}", one.number, one.cause));
    }
  }
  return result;
}

}  // namespace

Declared declared_at(const language::SourceFile& tree, std::size_t offset) {
  const Words words(tree);
  for (std::size_t i = 0; i < words.tokens().size(); ++i) {
    const Token& token = words.tokens()[i];
    if (token.symbol == Symbol::Identifier && token.offset <= offset && offset <= token.end()) {
      return words.declared(i);
    }
  }
  return {};
}

std::vector<language::Span> places_of(const language::SourceFile& tree, const Declared& what) {
  std::vector<language::Span> result;
  if (what.block == nullptr) {
    return result;
  }
  const Words words(tree);
  for (std::size_t i = 0; i < words.tokens().size(); ++i) {
    if (words.declared(i) == what) {
      result.push_back({.offset = words.tokens()[i].offset, .length = words.tokens()[i].length});
    }
  }
  return result;
}

std::string refused_name(const language::SourceFile& tree, const Declared& what, std::string_view new_name) {
  if (what.block == nullptr) {
    return "This is no name of this file. Names of the library and of the language stay as they are.";
  }
  if (new_name.empty() || !is_word(new_name)) {
    return fmt::format("`{}` is no name. Write letters, digits and single underscores, a letter first.", new_name);
  }
  if (is_reserved(new_name)) {
    return fmt::format("`{}` is a word of the language. Choose another name.", new_name);
  }
  const bool is_taken = what.variable == nullptr ? block_named(tree, new_name) != nullptr
                                                 : variable_named(*what.block, new_name) != nullptr;
  if (is_taken && !language::same_name(what.name().text, new_name)) {
    return fmt::format("`{}` is there already. Choose another name.", new_name);
  }
  const std::vector<std::string> before = errors_of(tree.path, *tree.text);
  const std::vector<std::string> after = errors_of(tree.path, renamed(*tree.text, places_of(tree, what), new_name));
  if (after.size() <= before.size()) {
    return {};
  }
  const auto is_new = [&](const std::string& one) { return std::ranges::find(before, one) == before.end(); };
  const auto shown = std::ranges::find_if(after, is_new);
  return fmt::format("With `{}` the text has an error. {}", new_name, shown == after.end() ? after.front() : *shown);
}

std::string renamed(std::string_view text, const std::vector<language::Span>& places, std::string_view new_name) {
  std::string result;
  std::size_t from = 0;
  for (const language::Span& place : places) {
    result += text.substr(from, place.offset - from);
    result += new_name;
    from = place.offset + place.length;
  }
  return result += text.substr(from);
}

}  // namespace hysteron::lsp
