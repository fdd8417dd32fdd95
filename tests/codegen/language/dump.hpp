// A syntax tree as text, for comparison: every expression in full parentheses, numbers to the last bit.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "codegen/language/syntax.hpp"

namespace hysteron::test {

inline std::string_view sign_of(language::Operator op) {
  using language::Operator;
  switch (op) {
    case Operator::Negate:
    case Operator::Subtract:
      return "-";
    case Operator::Not:
      return "NOT";
    case Operator::Add:
      return "+";
    case Operator::Multiply:
      return "*";
    case Operator::Divide:
      return "/";
    case Operator::Modulo:
      return "MOD";
    case Operator::Power:
      return "**";
    case Operator::Less:
      return "<";
    case Operator::LessEqual:
      return "<=";
    case Operator::Greater:
      return ">";
    case Operator::GreaterEqual:
      return ">=";
    case Operator::Equal:
      return "=";
    case Operator::NotEqual:
      return "<>";
    case Operator::And:
      return "AND";
    case Operator::Or:
      return "OR";
    default:
      return "XOR";
  }
}

class Dump {
 public:
  explicit Dump(const language::SourceFile& file) : file_(file) {}

  [[nodiscard]] std::string expression(language::ExpressionId id) const {
    return std::visit([this](const auto& node) { return this->text(node); }, file_.expressions.at(id).node);
  }

  [[nodiscard]] std::string statement(const language::Statement& statement) const {
    if (const auto* call = std::get_if<language::Call>(&statement)) {
      return fmt::format("{}{}", call->instance.text, arguments(call->arguments));
    }
    const auto& assignment = std::get<language::Assignment>(statement);
    return fmt::format("{} := {}", assignment.target.text, expression(assignment.value));
  }

  [[nodiscard]] std::string variable(const language::Variable& variable) const {
    constexpr std::string_view sections[] = {"input", "output", "local", "constant"};
    auto out = fmt::format("{} {} : {}", sections[static_cast<std::size_t>(variable.section)], variable.name.text,
                           language::upper(variable.type.text));
    if (variable.initial != language::no_expression) {
      out += " := " + expression(variable.initial);
    }
    if (!variable.settings.empty()) {
      out += " := " + arguments(variable.settings);
    }
    return out + annotations(variable.annotations);
  }

  [[nodiscard]] std::string whole() const {
    std::string out;
    for (const auto& block : file_.blocks) {
      out += fmt::format("block {}{}\n", block.name.text, annotations(block.annotations));
      for (const auto& one : block.variables) {
        out += variable(one) + "\n";
      }
      for (const auto& one : block.statements) {
        out += statement(one) + "\n";
      }
    }
    return out;
  }

 private:
  [[nodiscard]] std::string arguments(const std::vector<language::Argument>& list) const {
    std::string out;
    for (const auto& argument : list) {
      out += fmt::format("{}{} := {}", out.empty() ? "" : ", ", argument.pin.text, expression(argument.value));
    }
    return "(" + out + ")";
  }
  [[nodiscard]] static std::string annotations(const std::vector<language::Annotation>& list) {
    std::string out;
    for (const auto& annotation : list) {
      out += fmt::format(" @{}[{}]", annotation.key, annotation.value);
    }
    return out;
  }
  [[nodiscard]] static std::string text(const language::RealLiteral& node) { return fmt::format("{}r", node.value); }
  [[nodiscard]] static std::string text(const language::IntLiteral& node) {
    return fmt::format("{}{}", node.value, node.is_word ? "w" : "i");
  }
  [[nodiscard]] static std::string text(const language::BoolLiteral& node) { return node.value ? "TRUE" : "FALSE"; }
  [[nodiscard]] static std::string text(const language::Reference& node) {
    return node.pin.text.empty() ? std::string(node.name.text) : fmt::format("{}.{}", node.name.text, node.pin.text);
  }
  [[nodiscard]] std::string text(const language::Unary& node) const {
    return fmt::format("({} {})", sign_of(node.op), expression(node.operand));
  }
  [[nodiscard]] std::string text(const language::Binary& node) const {
    return fmt::format("({} {} {})", expression(node.left), sign_of(node.op), expression(node.right));
  }
  [[nodiscard]] std::string text(const language::FunctionCall& node) const {
    std::string out;
    for (const auto& argument : node.arguments) {
      out += out.empty() ? "" : ", ";
      out += argument.formal.text.empty() ? "" : fmt::format("{} := ", argument.formal.text);
      out += expression(argument.value);
    }
    return fmt::format("{}({})", node.function.text, out);
  }
  [[nodiscard]] std::string text(const language::ArrayLiteral& node) const {
    std::string out;
    for (const auto element : node.elements) {
      out += (out.empty() ? "" : ", ") + expression(element);
    }
    return "[" + out + "]";
  }

  const language::SourceFile& file_;
};

}  // namespace hysteron::test
