// Loops: unrolled, with each round under the condition that it is reached.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::Operator;

namespace {

constexpr double most_rounds = 10'000.0;
constexpr int most_turns = 1'000;

/// The comparison that holds where this one does not.
Operator opposite(Operator op) {
  switch (op) {
    case Operator::Less:
      return Operator::GreaterEqual;
    case Operator::LessEqual:
      return Operator::Greater;
    case Operator::Greater:
      return Operator::LessEqual;
    case Operator::GreaterEqual:
      return Operator::Less;
    case Operator::Equal:
      return Operator::NotEqual;
    default:
      return Operator::Equal;
  }
}

/// The comparison with its sides exchanged.
Operator mirrored(Operator op) {
  switch (op) {
    case Operator::Less:
      return Operator::Greater;
    case Operator::LessEqual:
      return Operator::GreaterEqual;
    case Operator::Greater:
      return Operator::Less;
    case Operator::GreaterEqual:
      return Operator::LessEqual;
    default:
      return op;
  }
}

}  // namespace

/// A FOR: its counter is a constant in each round. Where a bound is not known, a round is reached or not.
struct Body::Counting {
  struct Bound {
    Value value{};
    double least = 0.0;
    double greatest = 0.0;
    [[nodiscard]] bool known() const { return least == greatest; }
  };
  const syntax::For* node = nullptr;
  std::uint32_t leaf = 0;
  Bound from{};
  Bound to{};
  double by = 1.0;
  [[nodiscard]] bool known() const { return from.known() && to.known(); }
  [[nodiscard]] double first() const { return by > 0.0 ? from.least : from.greatest; }
  [[nodiscard]] double last() const { return by > 0.0 ? to.greatest : to.least; }
};

std::optional<Body::Counting> Body::counting(const syntax::For& node, language::Span span) {
  Counting count{.node = &node};
  const syntax::Access counter{.name = node.variable, .span = node.variable.span};
  Place* const place = find(counter);
  if (place == nullptr || place->leaf == Place::no_leaf || !is_integer(leaves_[place->leaf].type)) {
    if (place != nullptr) {
      refuse(error::type_mismatch, node.variable.span, fmt::format("'{}' cannot count", node.variable.text),
             "Declare it as INT or DINT.");
    }
    return std::nullopt;
  }
  count.leaf = place->leaf;
  for (const auto& [id, bound] : {std::pair{node.from, &count.from}, {node.to, &count.to}}) {
    bound->value = value(id);
    const Value& given = bound->value;
    if (!given.valid()) {
      return std::nullopt;
    }
    if (!is_integer(given.type)) {
      refuse(error::type_mismatch, expression(id).span, "a bound of this FOR is no whole number",
             "Give it an INT or a DINT.");
      return std::nullopt;
    }
    if (computer_.constant(given, bound->least)) {
      bound->greatest = bound->least;
    } else {
      const bool unknown = given.beyond_dint();
      bound->least = unknown ? 0.0 : static_cast<double>(given.low);
      bound->greatest = static_cast<double>(unknown ? highest(given.type) : given.high);
    }
  }
  if (node.by != language::no_expression) {
    const Value step = value(node.by);
    if (!step.valid()) {
      return std::nullopt;
    }
    if (!is_integer(step.type)) {
      refuse(error::type_mismatch, expression(node.by).span, "the step of this FOR is no whole number",
             "Write a whole number behind BY, as in BY 2.");
      return std::nullopt;
    }
    if (!computer_.constant(step, count.by)) {
      refuse(error::refused_in_body, expression(node.by).span, "the step of this FOR is not known before it runs",
             "Write a constant behind BY.");
      return std::nullopt;
    }
  }
  if (!count.from.known() && std::abs(count.by) != 1.0) {
    refuse(error::refused_in_body, expression(node.from).span,
           fmt::format("where this FOR begins is not known before it runs, and it counts by {}", count.by),
           "Begin at a constant, or count by 1.");
    return std::nullopt;
  }
  const auto named = [&](language::ExpressionId id) {
    const auto* access = std::get_if<syntax::Access>(&expression(id).node);
    return access != nullptr && access->steps.empty() ? std::string(access->name.text) : std::string("N");
  };
  const double most = count.by == 0.0 ? 0.0 : std::floor((count.last() - count.first()) / count.by) + 1.0;
  if (count.by == 0.0 || most > most_rounds) {
    refuse(error::refused_in_body, span,
           count.by == 0.0 ? std::string("this FOR never ends")
                           : fmt::format("this FOR {} {} rounds, more than {}", count.known() ? "has" : "may have",
                                         most, most_rounds),
           count.known() ? "A loop is unrolled: give it fewer rounds."
           : count.to.known()
               ? fmt::format("Bound where it begins by what there can be: FOR {} := LIMIT(1, {}, 32) TO … DO.",
                             node.variable.text, named(node.from))
               : fmt::format("Bound it by what there can be: FOR {} := … TO LIMIT(0, {}, 32) DO.", node.variable.text,
                             named(node.to)));
    return std::nullopt;
  }
  return most < 1.0 || holds(count) ? std::optional(count) : std::nullopt;
}

/// Whether the counter's type holds where it begins and how far it goes; false is told. In a PLC it would go on from
/// the other end of its range, and the loop without an end.
bool Body::holds(const Counting& count) {
  const Plain type = leaves_[count.leaf].type;
  const auto low = static_cast<double>(lowest(type));
  const auto high = static_cast<double>(highest(type));
  const auto refuse_bound = [&](language::ExpressionId id, const Counting::Bound& bound, double beyond) {
    refuse(error::type_mismatch, expression(id).span,
           fmt::format("'{}' is {}, and does not hold {:.0f}, which this bound of the FOR {}",
                       count.node->variable.text, info(type).name, beyond, bound.known() ? "is" : "may be"),
           fmt::format("Count by a DINT, or keep the bound within {:.0f} … {:.0f}.", low, high));
    return false;
  };
  if (count.from.least < low || count.from.greatest > high) {
    return refuse_bound(count.node->from, count.from, count.from.least < low ? count.from.least : count.from.greatest);
  }
  if (count.by > 0.0 ? count.last() > high : count.last() < low) {
    return refuse_bound(count.node->to, count.to, count.last());
  }
  const double rounds = std::floor((count.last() - count.first()) / count.by) + 1.0;
  const double behind = count.first() + rounds * count.by;
  if (behind >= low && behind <= high) {
    return true;
  }
  const double end = count.by > 0.0 ? high : low;
  const bool is_dint = info(type).width == 32;
  const std::string mend = fmt::format("{} at {:.0f} at the {}.", is_dint ? "End it" : "Count by a DINT, or end it",
                                       end - count.by, count.by > 0.0 ? "latest" : "lowest");
  const std::string what = fmt::format(
      "where a {} ends at {:.0f}, a PLC goes on from the other end, and this FOR never "
      "ends",
      info(type).name, end);
  if (count.to.known()) {
    refuse(error::type_mismatch, expression(count.node->to).span,
           fmt::format("'{}' is {}, and does not hold {:.0f}, which stands behind the last round: {}",
                       count.node->variable.text, info(type).name, behind, what),
           mend);
    return false;
  }
  refuse(error::other_meaning_elsewhere, expression(count.node->to).span,
         fmt::format("this FOR may count '{}' to {:.0f}: {}", count.node->variable.text, count.last(), what), mend);
  return true;
}

/// An EXIT and a CONTINUE within are those of this loop.
void Body::unrolled(const std::function<void()>& all_rounds) {
  const Value outer_exit = std::exchange(state_.exited, computer_.truth(false));
  const Value outer_continue = std::exchange(state_.continued, computer_.truth(false));
  all_rounds();
  state_.exited = outer_exit;
  state_.continued = outer_continue;
}

/// Whether no further round is reached.
Value Body::left() {
  return computer_.binary(Operator::Or, state_.exited, state_.returned);
}

/// One round, at a value of the counter; false where it assigns the counter, which is told.
bool Body::round(const Counting& count, double at) {
  const Plain type = leaves_[count.leaf].type;
  const Value here = computer_.literal(type, at);
  write(count.leaf, here);
  execute(count.node->statements);
  double counted = 0.0;
  if (!state_.values[count.leaf] || !computer_.constant(*state_.values[count.leaf], counted) || counted != at) {
    refuse(error::refused_in_body, count.node->variable.span,
           fmt::format("'{}' counts this FOR, and is assigned inside of it", count.node->variable.text),
           "Leave the loop by EXIT, or assign another variable.");
    return false;
  }
  state_.continued = computer_.truth(false);
  if (!count.known()) {
    const Value over = left();
    const Value next = computer_.fit(computer_.literal(Plain::Dint, at + count.by), type);
    write(count.leaf, computer_.select(over, here, next));
  }
  return true;
}

void Body::rounds(const Counting& count, double at) {
  const bool up = count.by > 0.0;
  for (; up ? at <= count.last() : at >= count.last(); at += count.by) {
    const Value here = computer_.literal(Plain::Dint, at, true);
    const auto reached = [&](const Counting::Bound& bound, Operator op) {
      return bound.known() ? computer_.truth(true) : computer_.binary(op, bound.value, here);
    };
    bool right = true;
    choose(
        computer_.binary(Operator::And, reached(count.from, up ? Operator::LessEqual : Operator::GreaterEqual),
                         reached(count.to, up ? Operator::GreaterEqual : Operator::LessEqual)),
        [&] { right = round(count, at); }, [] {});
    const Value over = left();
    if (!right || computer_.is_true(over) || executed_ > most_statements) {
      return;
    }
    if (!computer_.is_false(over)) {  // the rounds that follow hold where none ended it
      State before = state_;
      ++conditions_;
      rounds(count, at + count.by);
      --conditions_;
      state_ = merged(over, std::move(before), std::move(state_));
      return;
    }
  }
  if (count.known()) {
    write(count.leaf, computer_.fit(computer_.literal(Plain::Dint, at), leaves_[count.leaf].type));
  }
}

void Body::loop(const syntax::For& node, language::Span span) {
  const auto count = counting(node, span);
  if (!count) {
    return;
  }
  if (!count->known()) {  // what the counter is where no round is reached
    write(count->leaf, computer_.convert(count->from.value, leaves_[count->leaf].type));
  }
  unrolled([&] { rounds(*count, count->first()); });
}

void Body::loop(const syntax::Loop& node, language::Span span) {
  unrolled([&] { again(node, span, 0); });
}

/// One turn, and within it, under its condition, those that follow: the ranges of their numbers are narrower.
void Body::again(const syntax::Loop& node, language::Span span, int turn) {
  if (endless_.contains(&node)) {
    return;
  }
  if (turn == most_turns) {
    endless_.insert(&node);
    refuse(error::refused_in_body, span,
           fmt::format("nothing shows that this {} ends within {} rounds", node.tested_first ? "WHILE" : "REPEAT",
                       most_turns),
           "Write FOR I := 1 TO 100 DO with the most rounds there can be, and EXIT where it may end.");
    return;
  }
  const auto body = [&] {
    if (turn > 0 || node.tested_first) {
      narrow(node.condition, node.tested_first);
    }
    execute(node.statements);
    state_.continued = computer_.truth(false);
    if (executed_ <= most_statements) {
      choose(
          left(), [] {}, [&] { again(node, span, turn + 1); });
    }
  };
  if (turn == 0 && !node.tested_first) {
    body();
    return;
  }
  const Value tested = condition(node.condition);
  if (tested.valid() && node.tested_first) {
    choose(tested, body, [] {});
  } else if (tested.valid()) {
    choose(
        tested, [] {}, body);
  }
}

/// A literal, a name, or the negative of such a one.
bool Body::is_plain(language::ExpressionId id) const {
  const auto& node = expression(id).node;
  if (const auto* unary = std::get_if<syntax::Unary>(&node)) {
    return is_plain(unary->operand);
  }
  const auto* access = std::get_if<syntax::Access>(&node);
  return std::holds_alternative<syntax::Literal>(node) || (access != nullptr && access->steps.empty());
}

/// Where a condition holds, or does not, an integer that it compares with a constant lies on one side of that.
void Body::narrow(language::ExpressionId id, bool holds) {
  const auto* unary = std::get_if<syntax::Unary>(&expression(id).node);
  if (unary != nullptr && unary->op == Operator::Not) {
    narrow(unary->operand, !holds);
    return;
  }
  const auto* test = std::get_if<syntax::Binary>(&expression(id).node);
  if (test == nullptr) {
    return;
  }
  if (test->op == (holds ? Operator::And : Operator::Or)) {
    narrow(test->left, holds);
    narrow(test->right, holds);
    return;
  }
  if (test->op < Operator::Less || test->op > Operator::NotEqual) {
    return;
  }
  for (const bool first : {true, false}) {
    const auto* access = std::get_if<syntax::Access>(&expression(first ? test->left : test->right).node);
    if (access == nullptr || !access->steps.empty() || !access->type.empty()) {
      continue;
    }
    if (!is_plain(first ? test->right : test->left)) {
      continue;  // it would be computed a second time
    }
    const Place* const place = scope_->find(language::upper(access->name.text));
    if (place == nullptr || place->leaf == Place::no_leaf) {
      continue;
    }
    if (around_.memory != nullptr && !state_.values[place->leaf]) {
      state_.values[place->leaf] = leaves_[place->leaf].cell;
    }
    if (!state_.values[place->leaf]) {
      continue;
    }
    const Value other = value(first ? test->right : test->left);
    Value& kept = *state_.values[place->leaf];
    double number = 0.0;
    const bool compared = is_integer(kept.type) && other.valid() && is_integer(other.type) &&
                          computer_.constant(other, number) && !kept.beyond_dint();
    if (!compared) {
      continue;
    }
    const auto bound = static_cast<std::int64_t>(number);
    const Operator op = holds ? test->op : opposite(test->op);
    std::int64_t low = kept.low;
    std::int64_t high = kept.high;
    switch (first ? op : mirrored(op)) {
      case Operator::Less:
        high = std::min(high, bound - 1);
        break;
      case Operator::LessEqual:
        high = std::min(high, bound);
        break;
      case Operator::Greater:
        low = std::max(low, bound + 1);
        break;
      case Operator::GreaterEqual:
        low = std::max(low, bound);
        break;
      case Operator::Equal:
        low = std::max(low, bound);
        high = std::min(high, bound);
        break;
      default:
        break;
    }
    if (low <= high) {
      kept.low = low;
      kept.high = high;
    }
  }
}

}  // namespace hysteron::bodies
