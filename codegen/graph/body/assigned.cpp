#include "codegen/graph/body/assigned.hpp"

#include <algorithm>
#include <utility>

namespace hysteron::bodies {

namespace syntax = language::body;
using language::upper;

namespace {

class Walk {
 public:
  explicit Walk(const syntax::Library& library) : library_(library) {}

  void statements(const syntax::Statements& list) {
    for (const syntax::Statement& one : list) {
      if (const auto* assign = std::get_if<syntax::Assign>(&one.node)) {
        names.insert(upper(assign->target.name.text));
        assigned.insert(upper(assign->target.name.text));
        indexes(assign->target);
        expression(assign->value);
      } else if (const auto* call = std::get_if<syntax::Invoke>(&one.node)) {
        const std::string name = upper(call->instance.name.text);
        names.insert(name);
        functions.insert(name);
        assigned.insert(name);
        read.insert(name);
        if (!called_.insert(name).second || loops_ > 0) {
          called_again.insert(name);
        }
        arguments(call->arguments, name);
      } else if (const auto* choice = std::get_if<syntax::If>(&one.node)) {
        for (const syntax::Branch& branch : choice->branches) {
          expression(branch.condition);
          statements(branch.statements);
        }
        statements(choice->otherwise);
      } else if (const auto* cases = std::get_if<syntax::Case>(&one.node)) {
        expression(cases->selector);
        for (const syntax::Arm& arm : cases->arms) {
          statements(arm.statements);
        }
        statements(cases->otherwise);
      } else if (const auto* loop = std::get_if<syntax::For>(&one.node)) {
        names.insert(upper(loop->variable.text));
        assigned.insert(upper(loop->variable.text));
        expression(loop->from);
        expression(loop->to);
        expression(loop->by);
        round(loop->statements);
      } else if (const auto* turns = std::get_if<syntax::Loop>(&one.node)) {
        expression(turns->condition);
        round(turns->statements);
      }
    }
  }

  std::set<std::string> names{};
  std::set<std::string> called_again{};
  std::set<std::string> read{};
  std::set<std::string> assigned{};
  std::set<std::string> functions{};

 private:
  void round(const syntax::Statements& list) {
    ++loops_;
    statements(list);
    --loops_;
  }

  void arguments(const std::vector<syntax::Argument>& list, const std::string& callee) {
    for (const syntax::Argument& one : list) {
      if (const auto* access = std::get_if<syntax::Access>(&library_.expressions[one.value].node)) {
        names.insert(upper(access->name.text));  // it may be a VAR_IN_OUT
        if (one.output || may_be_in_out(one.formal.text, callee)) {
          assigned.insert(upper(access->name.text));
        }
      }
      expression(one.value);
    }
  }

  /// Of an argument without a name, that of a FUNCTION, any.
  [[nodiscard]] bool may_be_in_out(std::string_view formal, const std::string& callee) const {
    return std::ranges::any_of(library_.units, [&](const syntax::Unit& unit) {
      return (!formal.empty() || language::same_name(unit.name.text, callee)) &&
             std::ranges::any_of(unit.declarations, [&](const syntax::Declaration& one) {
               return one.role == syntax::Role::InOut && (formal.empty() || language::same_name(one.name.text, formal));
             });
    });
  }

  void indexes(const syntax::Access& access) {
    for (const syntax::Step& step : access.steps) {
      std::ranges::for_each(step.indexes, [this](language::ExpressionId id) { expression(id); });
    }
  }

  void expression(language::ExpressionId id) {
    if (id == language::no_expression) {
      return;
    }
    const auto& node = library_.expressions[id].node;
    if (const auto* unary = std::get_if<syntax::Unary>(&node)) {
      expression(unary->operand);
    } else if (const auto* binary = std::get_if<syntax::Binary>(&node)) {
      expression(binary->left);
      expression(binary->right);
    } else if (const auto* call = std::get_if<syntax::Call>(&node)) {
      functions.insert(upper(call->function.text));
      arguments(call->arguments, upper(call->function.text));
    } else if (const auto* access = std::get_if<syntax::Access>(&node)) {
      read.insert(upper(access->name.text));
      indexes(*access);
    }
  }

  const syntax::Library& library_;
  std::set<std::string> called_{};
  int loops_ = 0;
};

}  // namespace

Written written_by(const Source& source) {
  Walk walk(*source.library);
  walk.statements(source.unit->statements);
  return {.names = std::move(walk.names),
          .called_again = std::move(walk.called_again),
          .read = std::move(walk.read),
          .assigned = std::move(walk.assigned),
          .called = std::move(walk.functions)};
}

}  // namespace hysteron::bodies
