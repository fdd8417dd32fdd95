#include "codegen/backends/shared/expression_printer.hpp"

namespace hysteron {

void ExpressionPrinter::print_infix(const Value& value, const Spelling& spelled, int outer, std::string& out) const {
  const bool compares = spelled.strength == Strength::Equality || spelled.strength == Strength::Relation;
  if (looks_for_equal_sides && compares) {
    std::string left;
    std::string right;
    print(value.args[0], Strength::Primary, left);
    print(value.args[1], Strength::Primary, right);
    if (left == right && print_equal_sides(value, left, out)) {
      return;
    }
  }
  // The left side may bind as strongly (a - b - c is (a - b) - c); the right side must bind more strongly, or the
  // order of rounding would change. `and` inside `or` is bracketed for the reader's sake.
  const int strength = spelled.strength;
  const bool brackets = strength < outer || (strength == Strength::LogicalAnd && outer == Strength::LogicalOr) ||
                        (strength == Strength::Equality && outer == Strength::Equality);
  if (brackets) {
    out += '(';
  }
  const auto side = [&](ValueId id, int needed) {
    // Brackets that the language does not need, but its readers do.
    const Op inner = tape_[id].op;
    const bool mixed =
        !is_named(id) &&
        ((value.op == Op::Or && inner == Op::And) ||
         ((strength == Strength::LogicalXor || (brackets_mixed_operators && table_[inner].text != spelled.text)) &&
          !is_leaf(inner) && table_[inner].form == Spelling::Form::Infix) ||
         (strength == Strength::Equality && inner >= Op::Less && inner <= Op::IntNotEqual));
    print(id, mixed ? Strength::Primary : needed, out);
  };
  side(value.args[0], strength == Strength::Equality || strength == Strength::Relation ? strength + 1 : strength);
  out += ' ';
  out += spelled.text;
  out += ' ';
  side(value.args[1], strength + 1);
  if (brackets) {
    out += ')';
  }
}

void ExpressionPrinter::print_arguments(const Value& value, std::string& out) const {
  out += '(';
  for (std::size_t i = 0; i < info(value.op).arity; ++i) {
    if (i > 0) {
      out += ", ";
    }
    print(value.args[i], Strength::Loosest, out);
  }
  out += ')';
}

void ExpressionPrinter::print_added(ValueId id, std::string& out) const {
  const Op inner = tape_[id].op;
  const bool mixed = brackets_mixed_operators && !is_named(id) && !is_leaf(inner) &&
                     table_[inner].form == Spelling::Form::Infix && table_[inner].text != table_[Op::Add].text;
  print(id, mixed ? Strength::Primary : Strength::Additive + 1, out);
}

void ExpressionPrinter::print(ValueId id, int outer, std::string& out) const {
  if (is_named(id)) {
    return print_name(names_[name_of_[id] - 1], out);
  }
  const Value& value = tape_[id];
  if (is_leaf(value.op)) {
    return print_leaf(value, outer, out);
  }
  const Spelling& spelled = table_[value.op];
  switch (spelled.form) {
    case Spelling::Form::Special:
      return print_special(value, outer, out);
    case Spelling::Form::Infix:
      return print_infix(value, spelled, outer, out);
    case Spelling::Form::Sign: {
      const bool brackets = sign_needs_brackets(outer);
      out += brackets ? "(" : "";
      out += spelled.text;
      print(value.args[0], Strength::Primary, out);
      out += brackets ? ")" : "";
      return;
    }
    case Spelling::Form::Not:
      if (const Value& inner = tape_[value.args[0]]; inner.op == Op::Not && !is_named(value.args[0])) {
        return print(inner.args[0], outer, out);
      }
      out += spelled.text;
      print(value.args[0], Strength::Primary, out);
      return;
    case Spelling::Form::Call:
      out += spelled.text;
      return print_arguments(value, out);
  }
}

}  // namespace hysteron
