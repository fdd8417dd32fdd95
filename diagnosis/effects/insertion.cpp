#include "diagnosis/effects/insertion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <variant>

#include "codegen/language/lexer.hpp"

namespace hysteron::diagnosis {
namespace {

using language::Span;

/// One replacement of a stretch of text.
struct Edit {
  Span span{};
  std::string text{};
};

std::string edited(std::string text, std::vector<Edit> edits) {
  std::ranges::stable_sort(edits, [](const Edit& a, const Edit& b) { return a.span.offset > b.span.offset; });
  for (const Edit& edit : edits) {
    text.replace(edit.span.offset, edit.span.length, edit.text);
  }
  return text;
}

/// Where the last section of declarations of a block ends, and where the block itself does.
struct Ends {
  std::uint32_t last_section = 0;  ///< offset of its VAR
  std::uint32_t declarations = 0;  ///< offset of its END_VAR
  std::uint32_t behind = 0;        ///< behind that END_VAR
  std::uint32_t block = 0;         ///< offset of END_FUNCTION_BLOCK
};

Ends ends_of(const language::SourceFile& source, const language::FunctionBlock& block) {
  Ends ends;
  language::Lexer lexer(*source.text, language::Comments::All, nullptr);
  for (language::Token token = lexer.next(); token.symbol != language::Symbol::End; token = lexer.next()) {
    if (token.offset < block.span.offset) {
      continue;
    }
    switch (token.keyword) {
      case language::Keyword::Var:
      case language::Keyword::VarInput:
      case language::Keyword::VarOutput:
        ends.last_section = token.offset;
        break;
      case language::Keyword::EndVar:
        ends.declarations = token.offset;
        ends.behind = token.offset + token.length;
        break;
      case language::Keyword::EndFunctionBlock:
        ends.block = token.offset;
        return ends;
      default:
        break;
    }
  }
  return ends;
}

Edit declaration(const language::FunctionBlock& block, const Ends& ends, std::string_view text) {
  const bool local = !block.variables.empty() && block.variables.back().section == language::Section::Local;
  return local ? Edit{.span = {ends.declarations, 0}, .text = fmt::format("  {}\n  ", text)}
               : Edit{.span = {ends.behind, 0}, .text = fmt::format("\n  VAR\n    {}\n  END_VAR", text)};
}

/// The places where an expression reads a pin of an instance, each with whether it is all that stands there.
struct Reading {
  Span span{};
  bool whole = false;
};

class Readings {
 public:
  Readings(const language::SourceFile& source, std::string_view instance, std::string_view pin)
      : source_(source), instance_(instance), pin_(pin) {}

  std::vector<Reading> of(const language::FunctionBlock& block) {
    for (const language::Statement& statement : block.statements) {
      if (const auto* call = std::get_if<language::Call>(&statement)) {
        for (const language::Argument& argument : call->arguments) {
          collect(argument.value, true);
        }
      } else {
        collect(std::get<language::Assignment>(statement).value, true);
      }
    }
    return std::move(found_);
  }

 private:
  void collect(language::ExpressionId id, bool whole) {
    const language::Expression& expression = source_.expressions[id];
    if (const auto* reference = std::get_if<language::Reference>(&expression.node)) {
      if (language::same_name(reference->name.text, instance_) && language::same_name(reference->pin.text, pin_)) {
        const auto is_here = [&](const auto& one) { return one.span.offset == expression.span.offset; };
        if (std::ranges::none_of(found_, is_here)) {  // one value that stands for each element of a vector
          found_.push_back({.span = expression.span, .whole = whole});
        }
      }
    } else if (const auto* unary = std::get_if<language::Unary>(&expression.node)) {
      collect(unary->operand, false);
    } else if (const auto* binary = std::get_if<language::Binary>(&expression.node)) {
      collect(binary->left, false);
      collect(binary->right, false);
    } else if (const auto* function = std::get_if<language::FunctionCall>(&expression.node)) {
      for (const language::FunctionArgument& argument : function->arguments) {
        collect(argument.value, true);
      }
    }
  }

  const language::SourceFile& source_;
  std::string_view instance_;
  std::string_view pin_;
  std::vector<Reading> found_{};
};

}  // namespace

std::string with_effect(const language::SourceFile& source, const Edge& edge, const Insertion& insertion) {
  const language::FunctionBlock& block = source.blocks[edge.definition];
  const Ends ends = ends_of(source, block);
  std::vector<Edit> edits{declaration(block, ends, fmt::format("{} : {};", insertion.instance, insertion.block))};
  for (const Helper& helper : insertion.helpers) {
    edits.push_back(declaration(block, ends, fmt::format("{} : {};", helper.instance, helper.block)));
    edits.push_back(
        {.span = {ends.block, 0}, .text = fmt::format("  {}(XIN := {});\n", helper.instance, helper.signal)});
  }
  if (!insertion.new_input.empty()) {
    edits.push_back({.span = {ends.behind, 0},
                     .text = fmt::format("\n  VAR_INPUT\n    {} : LREAL := 0.0;\n  END_VAR", insertion.new_input)});
  }
  for (const Span& read : edge.reads) {
    edits.push_back({.span = read, .text = fmt::format("{}.{}", insertion.instance, insertion.output)});
  }
  std::string call = fmt::format("  {}({} := {}", insertion.instance, insertion.input, edge.source);
  for (const auto& [pin, driver] : insertion.wires) {
    call += fmt::format(", {} := {}", pin, driver);
  }
  edits.push_back({.span = {ends.block, 0}, .text = call + ");\n"});
  return edited(*source.text, std::move(edits));
}

std::string with_output(const language::SourceFile& source, const Edge& edge, std::string_view name) {
  const Ends ends = ends_of(source, source.blocks[edge.definition]);
  return edited(*source.text,
                {{.span = {ends.behind, 0}, .text = fmt::format("\n  VAR_OUTPUT\n    {} : LREAL;\n  END_VAR", name)},
                 {.span = {ends.block, 0}, .text = fmt::format("  {} := {};\n", name, edge.source)}});
}

std::string with_sum_outside(const language::SourceFile& source, std::uint32_t definition, std::string_view instance) {
  const language::FunctionBlock& block = source.blocks[definition];
  std::vector<Edit> edits;
  std::string input;
  for (const language::Statement& statement : block.statements) {
    const auto* const call = std::get_if<language::Call>(&statement);
    if (call == nullptr || !language::same_name(call->instance.text, instance)) {
      continue;
    }
    for (const language::Argument& argument : call->arguments) {
      if (language::same_name(argument.pin.text, "XIN")) {
        const Span span = source.expressions[argument.value].span;
        input = source.text_of(span);
        edits.push_back({.span = span, .text = "0.0"});
      }
    }
  }
  if (input.empty()) {
    return *source.text;
  }
  for (const Reading& reading : Readings(source, instance, "XOUT").of(block)) {
    const std::string sum = fmt::format("{} + {}.XOUT", input, instance);
    edits.push_back({.span = reading.span, .text = reading.whole ? sum : "(" + sum + ")"});
  }
  return edited(*source.text, std::move(edits));
}

std::string with_block(const language::SourceFile& source, const language::Variable& instance, std::string_view block) {
  return edited(*source.text, {{.span = instance.type.span, .text = std::string(block)}});
}

std::string free_name(const language::FunctionBlock& block, std::string_view wish) {
  std::string name(wish);
  const auto taken = [&] {
    return std::ranges::any_of(block.variables, [&](const language::Variable& variable) {
      return language::same_name(variable.name.text, name);
    });
  };
  for (int number = 2; taken(); ++number) {
    name = fmt::format("{}{}", wish, number);
  }
  return name;
}

}  // namespace hysteron::diagnosis
