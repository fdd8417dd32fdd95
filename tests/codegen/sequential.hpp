// A second reading of a diagram's text: as an IEC compiler executes it, from top to bottom, with variables and outputs
// that keep their values between calls. It knows a handful of blocks, each written out here, and shares nothing with
// elaboration, scheduling and the interpreter but the syntax tree.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "codegen/language/syntax.hpp"

namespace hysteron::testing {

class Sequential {
 public:
  /// The block of a name. `source` must outlive it and be without errors.
  Sequential(const language::SourceFile& source, std::string_view block) : source_(source) {
    for (const auto& one : source.blocks) {
      if (language::same_name(one.name.text, block)) {
        block_ = &one;
      }
    }
    if (block_ == nullptr) {
      throw std::invalid_argument("no such block");
    }
    for (const auto& variable : block_->variables) {
      const std::string name = language::upper(variable.name.text);
      const std::string type = language::upper(variable.type.text);
      if (type.starts_with("HY_")) {
        Library library{.type = type};
        for (const auto& setting : variable.settings) {
          library.values[language::upper(setting.pin.text)] = evaluate(setting.value);
        }
        library.values["XOUT"] = library.values["X0"];  // what a delay hands out before its first call
        library.memory = library.values["X0"];
        libraries_.emplace(name, std::move(library));
      } else if (type == "LREAL" || type == "BOOL" || type == "DINT") {
        values_[name] = variable.initial == language::no_expression ? 0.0 : evaluate(variable.initial);
      } else {
        inner_.emplace(name, std::make_unique<Sequential>(source, type));
      }
    }
  }

  void set(const std::string& name, double value) { values_[name] = value; }
  [[nodiscard]] double get(const std::string& name) const { return values_.at(name); }

  void step() {
    for (const auto& statement : block_->statements) {
      if (const auto* assignment = std::get_if<language::Assignment>(&statement)) {
        values_.at(language::upper(assignment->target.text)) = evaluate(assignment->value);
        continue;
      }
      const auto& call = std::get<language::Call>(statement);
      const std::string name = language::upper(call.instance.text);
      std::map<std::string, double> arguments;
      for (const auto& argument : call.arguments) {
        arguments[language::upper(argument.pin.text)] = evaluate(argument.value);
      }
      if (const auto found = inner_.find(name); found != inner_.end()) {
        for (const auto& [pin, value] : arguments) {
          found->second->set(pin, value);
        }
        found->second->step();
      } else {
        libraries_.at(name).call(arguments);
      }
    }
  }

 private:
  struct Library {
    std::string type{};
    std::map<std::string, double> values{};
    double memory = 0.0;

    /// By the convention of docs/explanation/semantics.md: a call leaves outputs that memory alone decides as those of
    /// the memory as it has been moved on.
    void call(const std::map<std::string, double>& arguments) {
      for (const auto& [pin, value] : arguments) {
        values[pin] = value;
      }
      if (type.starts_with("HY_DELAY")) {
        memory = values["XIN"];
        values["XOUT"] = memory;
      } else if (type == "HY_GAIN") {
        values["XOUT"] = values["K"] * values["XIN"];
      } else if (type == "HY_SUM") {
        values["XOUT"] = values["IN1"] + values["IN2"];
      } else {
        throw std::invalid_argument(type);
      }
    }
  };

  double evaluate(language::ExpressionId id) const {
    const auto& node = source_.expressions[id].node;
    if (const auto* real = std::get_if<language::RealLiteral>(&node)) {
      return real->value;
    }
    if (const auto* integer = std::get_if<language::IntLiteral>(&node)) {
      return static_cast<double>(integer->value);
    }
    if (const auto* truth = std::get_if<language::BoolLiteral>(&node)) {
      return truth->value ? 1.0 : 0.0;
    }
    if (const auto* reference = std::get_if<language::Reference>(&node)) {
      const std::string name = language::upper(reference->name.text);
      const std::string pin = language::upper(reference->pin.text);
      if (pin.empty()) {
        return values_.at(name);
      }
      const auto inner = inner_.find(name);
      return inner != inner_.end() ? inner->second->get(pin) : libraries_.at(name).values.at(pin);
    }
    if (const auto* unary = std::get_if<language::Unary>(&node)) {
      const double operand = evaluate(unary->operand);
      return unary->op == language::Operator::Not ? (operand == 0.0 ? 1.0 : 0.0) : -operand;
    }
    if (const auto* binary = std::get_if<language::Binary>(&node)) {
      return evaluate(*binary);
    }
    const auto& call = std::get<language::FunctionCall>(node);
    const auto argument = [&](std::size_t i) { return evaluate(call.arguments[i].value); };
    if (language::same_name(call.function.text, "SEL")) {
      return argument(0) != 0.0 ? argument(2) : argument(1);
    }
    throw std::invalid_argument(std::string(call.function.text));
  }

  /// Whether an expression is a DINT, which wraps at its ends.
  bool is_whole(language::ExpressionId id) const {
    const auto& node = source_.expressions[id].node;
    if (const auto* reference = std::get_if<language::Reference>(&node)) {
      for (const auto& variable : block_->variables) {
        if (language::same_name(variable.name.text, reference->name.text)) {
          return language::same_name(variable.type.text, "DINT") ||
                 language::same_name(variable.type.text, "HY_DELAY_DINT");
        }
      }
    }
    if (const auto* unary = std::get_if<language::Unary>(&node)) {
      return is_whole(unary->operand);
    }
    if (const auto* binary = std::get_if<language::Binary>(&node)) {
      return is_whole(binary->left);
    }
    if (const auto* call = std::get_if<language::FunctionCall>(&node)) {
      return is_whole(call->arguments.back().value);
    }
    return std::holds_alternative<language::IntLiteral>(node);
  }

  double evaluate(const language::Binary& binary) const {
    using enum language::Operator;
    const double left = evaluate(binary.left);
    const double right = evaluate(binary.right);
    const bool whole = is_whole(binary.left);
    const auto wrapped = [&](double value) {
      return whole ? static_cast<double>(static_cast<std::int32_t>(static_cast<std::int64_t>(value))) : value;
    };
    switch (binary.op) {
      case Add:
        return wrapped(left + right);
      case Subtract:
        return wrapped(left - right);
      case Less:
        return left < right ? 1.0 : 0.0;
      case Greater:
        return left > right ? 1.0 : 0.0;
      case And:
        return left != 0.0 && right != 0.0 ? 1.0 : 0.0;
      case Or:
        return left != 0.0 || right != 0.0 ? 1.0 : 0.0;
      case Xor:
        return (left != 0.0) != (right != 0.0) ? 1.0 : 0.0;
      default:
        throw std::invalid_argument("an operator that this reading does not know");
    }
  }

  const language::SourceFile& source_;
  const language::FunctionBlock* block_ = nullptr;
  std::map<std::string, double> values_{};
  std::map<std::string, Library> libraries_{};
  std::map<std::string, std::unique_ptr<Sequential>> inner_{};
};

}  // namespace hysteron::testing
