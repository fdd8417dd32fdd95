#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::Operator;

namespace {

/// Loops unrolled, calls executed in place: so many statements are a program, not a block.
constexpr std::size_t most_statements = 200'000;
constexpr double most_rounds = 10'000.0;

}  // namespace

Value Body::stopped() {
  const Value jumped = computer_.binary(Operator::Or, state_.exited, state_.continued);
  return computer_.binary(Operator::Or, state_.returned, jumped);
}

void Body::execute(const syntax::Statements& list, std::size_t from) {
  for (std::size_t i = from; i < list.size(); ++i) {
    if (++executed_ > most_statements) {
      if (executed_ == most_statements + 1) {
        refuse(error::refused_in_body, list[i].span,
               fmt::format("this body has more than {} statements when its loops are unrolled", most_statements),
               "Use fewer rounds, or fewer elements.");
      }
      return;
    }
    execute(list[i]);
    const Value stop = stopped();
    if (computer_.is_true(stop)) {
      return;
    }
    if (!computer_.is_false(stop) && i + 1 < list.size()) {  // the rest holds where nothing stopped
      State before = state_;
      ++conditions_;
      execute(list, i + 1);
      --conditions_;
      state_ = merged(stop, std::move(before), std::move(state_));
      return;
    }
  }
}

Body::State Body::merged(const Value& condition, State yes, State no) {
  State result;
  const std::size_t count = std::min(yes.values.size(), no.values.size());
  result.values.resize(count);
  computer_.at(path_for("CHOICE"), computer_.span());
  for (std::uint32_t leaf = 0; leaf < count; ++leaf) {
    auto& a = yes.values[leaf];
    auto& b = no.values[leaf];
    if (a && b && a->wire == b->wire) {
      result.values[leaf] = std::move(a);
      continue;
    }
    if (!a && !b) {
      continue;
    }
    const Value first = a ? *a : cell(leaf);
    const Value second = b ? *b : cell(leaf);
    computer_.at(path_for(leaves_[leaf].path), computer_.span());
    result.values[leaf] = computer_.select(condition, first, second);
  }
  result.returned = computer_.select(condition, yes.returned, no.returned);
  result.exited = computer_.select(condition, yes.exited, no.exited);
  result.continued = computer_.select(condition, yes.continued, no.continued);
  return result;
}

void Body::choose(const Value& condition, const std::function<void()>& yes, const std::function<void()>& no) {
  if (!condition.valid() || computer_.is_true(condition)) {
    yes();
    return;
  }
  if (computer_.is_false(condition)) {
    no();
    return;
  }
  const auto span = computer_.span();
  State before = state_;
  ++conditions_;
  yes();
  State after_yes = std::exchange(state_, std::move(before));
  no();
  --conditions_;
  computer_.at(span);
  state_ = merged(condition, std::move(after_yes), std::move(state_));
}

void Body::branches(const std::vector<syntax::Branch>& list, std::size_t at, const syntax::Statements& otherwise) {
  if (at == list.size()) {
    execute(otherwise);
    return;
  }
  computer_.at(path_for("CONDITION"), place_of(expression(list[at].condition).span));
  choose(
      condition(list[at].condition), [&] { execute(list[at].statements); }, [&] { branches(list, at + 1, otherwise); });
}

Value Body::selected(const syntax::Arm& arm, const Value& selector) {
  Value any = computer_.truth(false);
  for (const syntax::Label& label : arm.labels) {
    const Value low = value(label.low);
    Value one = computer_.binary(label.high == language::no_expression ? Operator::Equal : Operator::GreaterEqual,
                                 selector, low);
    if (label.high != language::no_expression) {
      one = computer_.binary(Operator::And, one, computer_.binary(Operator::LessEqual, selector, value(label.high)));
    }
    any = any.valid() && one.valid() ? computer_.binary(Operator::Or, any, one) : Value{};
  }
  return any;
}

void Body::arms(const syntax::Case& node, const Value& selector, std::size_t at) {
  if (at == node.arms.size()) {
    execute(node.otherwise);
    return;
  }
  computer_.at(path_for("CONDITION"), place_of(expression(node.arms[at].labels.front().low).span));
  choose(
      selected(node.arms[at], selector), [&] { execute(node.arms[at].statements); },
      [&] { arms(node, selector, at + 1); });
}

void Body::rounds(const syntax::For& node, std::uint32_t leaf, double at, double to, double by) {
  for (; by > 0.0 ? at <= to : at >= to; at += by) {
    write(leaf, computer_.literal(leaves_[leaf].type, at));
    execute(node.statements);
    double counted = 0.0;
    if (!state_.values[leaf] || !computer_.constant(*state_.values[leaf], counted) || counted != at) {
      refuse(error::refused_in_body, node.variable.span,
             fmt::format("'{}' counts this FOR, and is assigned inside of it", node.variable.text),
             "Leave the loop by EXIT, or assign another variable.");
      return;
    }
    state_.continued = computer_.truth(false);
    const Value over = computer_.binary(Operator::Or, state_.exited, state_.returned);
    if (computer_.is_true(over) || executed_ > most_statements) {
      return;
    }
    if (!computer_.is_false(over)) {  // the rounds that follow hold where none ended it
      State before = state_;
      ++conditions_;
      rounds(node, leaf, at + by, to, by);
      --conditions_;
      state_ = merged(over, std::move(before), std::move(state_));
      return;
    }
  }
  write(leaf, computer_.fit(computer_.literal(Plain::Dint, at), leaves_[leaf].type));
}

void Body::loop(const syntax::For& node, language::Span span) {
  const syntax::Access counter{.name = node.variable, .span = node.variable.span};
  Place* const place = find(counter);
  if (place == nullptr || place->leaf == Place::no_leaf || !is_integer(leaves_[place->leaf].type)) {
    if (place != nullptr) {
      refuse(error::type_mismatch, node.variable.span, fmt::format("'{}' cannot count", node.variable.text),
             "Declare it as INT or DINT.");
    }
    return;
  }
  double from = 0.0;
  double to = 0.0;
  double by = 1.0;
  for (const auto& [id, bound] : {std::pair{node.from, &from}, {node.to, &to}, {node.by, &by}}) {
    if (id == language::no_expression) {
      continue;
    }
    const Value given = value(id);
    if (!given.valid()) {
      return;
    }
    if (!computer_.constant(given, *bound)) {
      refuse(error::refused_in_body, expression(id).span, "the bound of this FOR is not known before it runs",
             "Write the largest bound there can be, and IF … THEN EXIT; END_IF; in the loop.");
      return;
    }
  }
  if (by == 0.0 || (to - from) / by > most_rounds) {
    refuse(
        error::refused_in_body, span,
        by == 0.0 ? std::string("this FOR never ends") : fmt::format("this FOR has more than {} rounds", most_rounds),
        "A loop is unrolled: give it fewer rounds.");
    return;
  }
  const Value outer_exit = std::exchange(state_.exited, computer_.truth(false));
  const Value outer_continue = std::exchange(state_.continued, computer_.truth(false));
  rounds(node, place->leaf, from, to, by);
  state_.exited = outer_exit;
  state_.continued = outer_continue;
}

void Body::execute(const syntax::Statement& statement) {
  computer_.at(path_for("VALUE"), place_of(statement.span));
  if (const auto* assign_node = std::get_if<syntax::Assign>(&statement.node)) {
    const auto& target = assign_node->target;
    computer_.at(path_for(std::string(target.name.text)), place_of(statement.span));
    if (const auto* source = std::get_if<syntax::Access>(&expression(assign_node->value).node)) {
      // A whole array or structure is copied.
      if (auto from = source->type.empty() && !named_constant(*source) ? choices(*source) : std::vector<Choice>{};
          from.size() == 1 && from.front().place->leaf == Place::no_leaf) {
        if (auto to = choices(target); to.size() == 1) {
          copy(*to.front().place, *from.front().place, statement.span);
        }
        return;
      }
    }
    const Value result = value(assign_node->value);
    assign(target, result, statement.span);
  } else if (const auto* call_node = std::get_if<syntax::Invoke>(&statement.node)) {
    invoke(*call_node, statement.span);
  } else if (const auto* if_node = std::get_if<syntax::If>(&statement.node)) {
    branches(if_node->branches, 0, if_node->otherwise);
  } else if (const auto* case_node = std::get_if<syntax::Case>(&statement.node)) {
    const Value selector = value(case_node->selector);
    if (selector.valid()) {
      arms(*case_node, selector, 0);
    }
  } else if (const auto* for_node = std::get_if<syntax::For>(&statement.node)) {
    loop(*for_node, statement.span);
  } else {
    const auto jump = std::get<syntax::Jump>(statement.node);
    (jump == syntax::Jump::Return ? state_.returned
     : jump == syntax::Jump::Exit ? state_.exited
                                  : state_.continued) = computer_.truth(true);
  }
}

}  // namespace hysteron::bodies
