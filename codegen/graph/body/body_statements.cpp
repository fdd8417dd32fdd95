#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::Operator;

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
    const std::size_t leaves = leaves_.size();
    const std::size_t wholes = wholes_.size();
    execute(list[i]);
    forget(leaves, wholes);
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
      a->low = std::min(a->low, b->low);  // a condition may have narrowed either
      a->high = std::max(a->high, b->high);
      result.values[leaf] = a;
      continue;
    }
    if (!a && !b) {
      continue;
    }
    if (!a || !b) {  // a condition has narrowed what the cell holds on one side
      const auto& one_side = a ? a : b;
      if (leaves_[leaf].cell && one_side->wire == leaves_[leaf].cell->wire) {
        continue;
      }
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
  leaves_.resize(state_.values.size());  // what one side has kept for its calls is not the other's
  no();
  --conditions_;
  computer_.at(span);
  state_ = merged(condition, std::move(after_yes), std::move(state_));
  leaves_.resize(state_.values.size());
}

void Body::branches(const std::vector<syntax::Branch>& list, std::size_t at, const syntax::Statements& otherwise) {
  if (at == list.size()) {
    execute(otherwise);
    return;
  }
  const language::ExpressionId test = list[at].condition;
  computer_.at(path_for("CONDITION"), place_of(expression(test).span));
  choose(
      condition(test),
      [&] {
        narrow(test, true);
        execute(list[at].statements);
      },
      [&] {
        narrow(test, false);
        branches(list, at + 1, otherwise);
      });
}

namespace {

/// `3`, `-3` and `A` of an enumeration; none where it is computed.
std::optional<double> known_label(const Source& source, Types& types, language::ExpressionId id) {
  const auto& node = source.library->expressions[id].node;
  double number = 0.0;
  if (const auto* unary = std::get_if<language::Unary>(&node); unary != nullptr && unary->op == Operator::Negate) {
    const auto inner = known_label(source, types, unary->operand);
    return inner ? std::optional(-*inner) : std::nullopt;
  }
  if (const auto* access = std::get_if<syntax::Access>(&node); access != nullptr && access->steps.empty()) {
    return types.enumerator(access->type, access->name.text, number) ? std::optional(number) : std::nullopt;
  }
  const auto* literal = std::get_if<syntax::Literal>(&node);
  const bool whole = literal != nullptr && literal->kind == syntax::Literal::Kind::Whole;
  return whole && literal->value <= static_cast<double>(highest(Plain::Udint)) ? std::optional(literal->value)
                                                                               : std::nullopt;
}

}  // namespace

/// A value that an arm before has, an empty range, and a value that the selector cannot have.
void Body::check_labels(const syntax::Case& node, const Value& selector) {
  std::vector<std::pair<double, double>> before;
  for (const syntax::Arm& arm : node.arms) {
    for (const syntax::Label& label : arm.labels) {
      const bool range = label.high != language::no_expression;
      const auto low = known_label(source_, types_, label.low);
      const auto high = range ? known_label(source_, types_, label.high) : low;
      const language::Span span = expression(label.low).span;
      if (!low || !high || !is_integer(selector.type)) {
        continue;
      }
      if (*high < *low) {
        refuse(error::refused_in_body, span, fmt::format("the range {}..{} is empty", *low, *high),
               fmt::format("Write the lower one first: {}..{}.", *high, *low));
        continue;
      }
      const auto taken =
          std::ranges::find_if(before, [&](const auto& one) { return one.first <= *high && *low <= one.second; });
      if (taken != before.end()) {
        const double both = std::max(*low, taken->first);
        refuse(error::refused_in_body, span, fmt::format("the value {} of this CASE stands here a second time", both),
               "The first arm takes it: leave it out of one of the two.");
      }
      before.emplace_back(*low, *high);
      const Plain type = selector.type;
      if (*low < static_cast<double>(lowest(type)) || *high > static_cast<double>(highest(type))) {
        refuse(error::number_out_of_range, span,
               fmt::format("the selector is {}, which never is {}", info(type).name,
                           *low < static_cast<double>(lowest(type)) ? *low : *high),
               fmt::format("Write values from {} to {}.", lowest(type), highest(type)));
      }
    }
  }
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

void Body::execute(const syntax::Statement& statement) {
  computer_.at(path_for("VALUE"), place_of(statement.span));
  if (const auto* assign_node = std::get_if<syntax::Assign>(&statement.node)) {
    const auto& target = assign_node->target;
    computer_.at(path_for(std::string(target.name.text)), place_of(statement.span));
    if (is_whole(assign_node->value)) {
      assign_whole(target, assign_node->value, statement.span);
      return;
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
      if (cases_.insert(case_node).second) {
        check_labels(*case_node, selector);
      }
      arms(*case_node, selector, 0);
    }
  } else if (const auto* for_node = std::get_if<syntax::For>(&statement.node)) {
    loop(*for_node, statement.span);
  } else if (const auto* loop_node = std::get_if<syntax::Loop>(&statement.node)) {
    loop(*loop_node, statement.span);
  } else {
    const auto jump = std::get<syntax::Jump>(statement.node);
    (jump == syntax::Jump::Return ? state_.returned
     : jump == syntax::Jump::Exit ? state_.exited
                                  : state_.continued) = computer_.truth(true);
  }
}

bool Body::refuse_constant(const syntax::Access& access) {
  const auto member = std::ranges::find(scope_->members, language::upper(access.name.text), &Member::name);
  const bool constant = member != scope_->members.end() && member->role == syntax::Role::Constant;
  if (constant) {
    refuse(error::double_drive, access.name.span, fmt::format("'{}' cannot be assigned to", access.name.text),
           "It is a constant: declare it between VAR and END_VAR.");
  }
  return constant;
}

/// A value as a variable takes it: an enumeration, any whole number.
Value Body::taken_by(const Place& place, const Value& value, const std::string& name) {
  const Plain type = leaves_[place.leaf].type;
  const bool whole = place.type != nullptr && place.type->is_enumeration && value.valid() && is_integer(value.type);
  return whole && !value.loose ? computer_.convert(value, type) : computer_.assignable(value, type, name);
}

void Body::assign(const syntax::Access& access, const Value& value, language::Span span) {
  const auto list = choices(access);
  if (list.empty() || !value.valid()) {
    return;
  }
  if (refuse_constant(access)) {
    return;
  }
  for (const Choice& one : list) {
    if (one.place->leaf == Place::no_leaf) {
      refuse(error::type_mismatch, span, fmt::format("'{}' is no single value", access.name.text),
             "Assign to one of its members or elements.");
      return;
    }
    const Plain type = leaves_[one.place->leaf].type;
    Value kept;
    if (one.bit >= 0) {
      const auto mask = static_cast<double>(std::int64_t{1} << one.bit);
      const Value old = read(one.place->leaf);
      const Value all = computer_.literal(type, static_cast<double>((std::int64_t{1} << info(type).width) - 1) - mask);
      const Value cleared = computer_.binary(Operator::And, old, all);
      const Value set = computer_.binary(Operator::Or, cleared, computer_.literal(type, mask));
      const Value truth = computer_.assignable(value, Plain::Bool, "a bit");
      kept = truth.valid() ? computer_.fit(computer_.select(truth, set, cleared), type) : Value{};
    } else {
      kept = taken_by(*one.place, value, std::string(access.name.text));
      check_subrange(*one.place, kept, span);
    }
    if (!kept.valid()) {
      return;
    }
    write(one.place->leaf, one.condition ? computer_.select(*one.condition, kept, read(one.place->leaf)) : kept);
  }
}

}  // namespace hysteron::bodies
