// The functions of the standard in sequential bodies.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "codegen/graph/body/body.hpp"
#include "codegen/language/refused_types.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::Operator;
using language::upper;

namespace {

struct NumberFunction {
  std::string_view name;
  Op op;
};
constexpr std::array number_functions{
    NumberFunction{"SQRT", Op::Sqrt}, NumberFunction{"LN", Op::Log},    NumberFunction{"EXP", Op::Exp},
    NumberFunction{"SIN", Op::Sin},   NumberFunction{"COS", Op::Cos},   NumberFunction{"TAN", Op::Tan},
    NumberFunction{"ASIN", Op::Asin}, NumberFunction{"ACOS", Op::Acos}, NumberFunction{"ATAN", Op::Atan}};

struct OperatorFunction {
  std::string_view name;
  Operator op;
};
/// The operators under their names as functions.
constexpr std::array operator_functions{
    OperatorFunction{"ADD", Operator::Add},         OperatorFunction{"SUB", Operator::Subtract},
    OperatorFunction{"MUL", Operator::Multiply},    OperatorFunction{"DIV", Operator::Divide},
    OperatorFunction{"MOD", Operator::Modulo},      OperatorFunction{"GT", Operator::Greater},
    OperatorFunction{"GE", Operator::GreaterEqual}, OperatorFunction{"EQ", Operator::Equal},
    OperatorFunction{"LE", Operator::LessEqual},    OperatorFunction{"LT", Operator::Less},
    OperatorFunction{"NE", Operator::NotEqual},     OperatorFunction{"AND", Operator::And},
    OperatorFunction{"OR", Operator::Or},           OperatorFunction{"XOR", Operator::Xor}};

/// Arguments in the order of the standard, where they are named.
std::vector<std::string> formal_names(const std::string& function) {
  std::vector<std::string> names;
  if (function == "SHL" || function == "SHR" || function == "ROL" || function == "ROR") {
    return {"IN", "N"};
  }
  for (const auto one : formal_arguments(function)) {
    names.emplace_back(one);
  }
  return names;
}

}  // namespace

Value Body::call(const syntax::Call& call, language::Span span) {
  const std::string name = upper(call.function.text);
  if (const Source source = types_.find_unit(name, true); source.unit != nullptr) {
    const Result given = call_unit(source, call, span);
    return given.whole == nullptr
               ? given.value
               : refuse(error::refused_in_body, span, fmt::format("{} gives no single value", name),
                        fmt::format("Assign all of it first: X := {}( … ), with X of the same type; then read a member "
                                    "or an element of X.",
                                    name));
  }
  if (scope_ != nullptr && scope_->find(name) != nullptr) {
    return refuse(error::refused_in_body, call.function.span,
                  fmt::format("'{}' is called inside of an expression", call.function.text),
                  "Call the instance as a statement before, and read its output here.");
  }
  std::vector<Value> values(call.arguments.size());
  const auto formals = formal_names(name);
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const syntax::Argument& one = call.arguments[i];
    std::size_t at = i;
    if (!one.formal.text.empty()) {
      at = static_cast<std::size_t>(std::ranges::find(formals, upper(one.formal.text)) - formals.begin());
    }
    const bool taken = at >= values.size() || values[at].valid();
    if (one.output || taken) {
      const std::string which =
          one.formal.text.empty() ? fmt::format("argument {}", i + 1) : fmt::format("'{}'", one.formal.text);
      return refuse(error::unknown_function, span,
                    one.output            ? fmt::format("{} has no output '{}'", name, one.formal.text)
                    : at >= values.size() ? fmt::format("{} has no {} among {} arguments", name, which, values.size())
                                          : fmt::format("{} is given {} twice", name, which),
                    one.output        ? std::string("Assign what the function gives: X := ") + name + "( … );"
                    : formals.empty() ? std::string("Give its arguments without names, in their order.")
                                      : fmt::format("Its arguments are {}.", fmt::join(formals, ", ")));
    }
    values[at] = value(one.value);
    if (!values[at].valid()) {
      return {};
    }
  }
  computer_.at(place_of(span));
  if (values.empty()) {
    if (const auto time = of_time(name, span)) {
      return *time;
    }
  }
  if (name == "TIME" && !values.empty()) {
    return refuse(error::unknown_function, call.function.span, "TIME() takes no argument",
                  "Write TIME(); a number of milliseconds becomes a TIME by DINT_TO_TIME( … ).");
  }
  for (const auto& found :
       {conversion(name, values), of_number(name, values), chosen(name, values), function(name, values)}) {
    if (found) {
      return *found;
    }
  }
  return refuse(error::unknown_function, call.function.span,
                fmt::format("there is no function '{}'", call.function.text),
                "Put its FUNCTION into this file, or use one of the standard.");
}

std::optional<Value> Body::conversion(const std::string& name, const std::vector<Value>& values) {
  const auto mark = name.find("TO_");
  if (mark == std::string::npos || values.size() != 1 || (mark > 0 && name[mark - 1] != '_')) {
    return std::nullopt;
  }
  Plain to = Plain::Bool;
  Plain from = Plain::Bool;
  const std::string_view first = mark == 0 ? std::string_view() : std::string_view(name).substr(0, mark - 1);
  std::string_view second = std::string_view(name).substr(mark + 3);
  for (const std::string_view type : {first, second}) {
    if (const auto mend = language::in_place_of_type(type); !mend.empty()) {
      return computer_.refused(error::refused_type, fmt::format("{}: a body has no {}", name, type), std::string(mend));
    }
  }
  if (!plain_of(second, to) || (!first.empty() && !plain_of(first, from))) {
    return std::nullopt;
  }
  Value given = values[0];
  if (!first.empty()) {
    given = computer_.assignable(given, from, name);
  }
  return given.valid() ? computer_.convert(given, to) : given;
}

std::optional<Value> Body::of_number(const std::string& name, const std::vector<Value>& values) {
  const auto as_number = [&](const Value& value) {
    const Plain type = value.type == Plain::Real ? Plain::Real : Plain::Lreal;
    return is_number(value.type) ? (value.type == Plain::Real ? computer_.fit(value, type) : value)
                                 : computer_.assignable(value, type, name);
  };
  // The C library computes in LREAL; the function of a REAL gives a REAL.
  const auto result = [&](Op op, std::initializer_list<Value> operands, Plain type) {
    Value number = computer_.operation(op, operands, type);
    number.wide = true;
    number.untyped = Untyped({values[0]}).as(type);
    return type == Plain::Real ? computer_.fit(number, type) : number;
  };
  for (const NumberFunction& one : number_functions) {
    if (name == one.name && values.size() == 1) {
      const Value number = as_number(values[0]);
      return number.valid() ? result(one.op, {number}, number.type) : number;
    }
  }
  if (name == "LOG" && values.size() == 1) {
    const Value number = as_number(values[0]);
    if (!number.valid()) {
      return number;
    }
    const Value log = computer_.operation(Op::Log, {number}, Plain::Lreal);
    return result(Op::Divide, {log, computer_.literal(Plain::Lreal, 2.302585092994046)}, number.type);
  }
  if (name == "EXPT" && values.size() == 2) {
    Value power = computer_.binary(Operator::Power, as_number(values[0]), values[1]);
    return power.valid() && power.type == Plain::Real ? computer_.fit(power, Plain::Real) : power;
  }
  if (name == "TRUNC" && values.size() == 1) {
    const Value number = as_number(values[0]);
    return number.valid() ? computer_.truncated(number, Plain::Dint) : number;
  }
  if (name == "ABS" && values.size() == 1) {
    const Value& x = values[0];
    if (is_integer(x.type)) {
      const Value kept = computer_.fit(x, x.type);
      const Value below = computer_.binary(Operator::Less, kept, computer_.literal(x.type, 0.0));
      Value size = computer_.select(below, computer_.negative(kept), kept);
      if (info(x.type).below_zero && kept.low > lowest(Plain::Dint)) {  // whose negative is itself
        size.low = std::max<std::int64_t>({0, kept.low, -kept.high});
        size.high = std::max(kept.high, -kept.low);
      }
      size = computer_.fit(size, x.type);
      size.untyped = x.untyped;
      return size;
    }
    const Value number = as_number(x);
    return number.valid() ? result(Op::Abs, {number}, number.type) : number;
  }
  return std::nullopt;
}

std::optional<Value> Body::chosen(const std::string& name, std::vector<Value>& values) {
  const bool extreme = (name == "MIN" || name == "MAX") && values.size() >= 2;
  const bool limit = name == "LIMIT" && values.size() == 3;
  const bool choice = name == "SEL" && values.size() == 3;
  const bool multiple = name == "MUX" && values.size() >= 3 && is_integer(values[0].type);
  if (!extreme && !limit && !choice && !multiple) {
    return std::nullopt;
  }
  const std::size_t first = choice || multiple ? 1 : 0;
  // Of literals alone, as SEL(G, 0, 255), or with one beyond the others, as MIN(X, 40000) of an INT: it takes the type
  // that it is assigned to.
  const Untyped untyped(std::span<const Value>(values).subspan(first));
  for (std::size_t round = 0; round < 2; ++round) {
    for (std::size_t i = first + 1; i < values.size(); ++i) {
      if (!computer_.meet(values[first], values[i], name)) {
        return Value{};
      }
    }
  }
  std::for_each(values.begin() + static_cast<std::ptrdiff_t>(first), values.end(),
                [&](Value& one) { one = computer_.fit(one, one.type); });
  Value result;
  if (extreme) {
    result = values[0];
    for (std::size_t i = 1; i < values.size(); ++i) {
      result = computer_.extreme(result, values[i], name == "MAX");
    }
  } else if (limit) {
    result = computer_.extreme(computer_.extreme(values[1], values[0], true), values[2], false);
  } else if (choice) {
    const Value which = computer_.assignable(values[0], Plain::Bool, "G of SEL");
    result = which.valid() ? computer_.select(which, values[2], values[1]) : Value{};
  } else {
    result = values.back();
    for (std::size_t i = values.size() - 1; i-- > 1;) {
      const Value here = computer_.binary(Operator::LessEqual, values[0],
                                          computer_.literal(Plain::Dint, static_cast<double>(i - 1), true));
      result = computer_.select(here, values[i], result);
    }
  }
  result.untyped = result.valid() && untyped.as(result.type);
  return result;
}

std::optional<Value> Body::function(const std::string& name, std::vector<Value>& values) {
  for (const OperatorFunction& one : operator_functions) {
    if (name == one.name && values.size() >= 2) {
      Value result = values[0];
      for (std::size_t i = 1; i < values.size(); ++i) {
        result = computer_.binary(one.op, result, values[i]);
      }
      return result;
    }
  }
  if ((name == "NOT" || name == "MOVE") && values.size() == 1) {
    return name == "NOT" ? computer_.inverse(values[0]) : values[0];
  }
  const bool shift = name == "SHL" || name == "SHR";
  const bool rotate = name == "ROL" || name == "ROR";
  if ((shift || rotate) && values.size() == 2) {
    if (!is_integer(values[0].type) || !is_integer(values[1].type)) {
      return computer_.refused(error::type_mismatch,
                               fmt::format("{} takes bits and a number of places, here are {} and {}", name,
                                           info(values[0].type).name, info(values[1].type).name),
                               "Give it a BYTE, a WORD or a DWORD, and an INT.");
    }
    const bool left = name[2] == 'L';
    return shift ? computer_.shifted(values[0], values[1], left) : computer_.rotated(values[0], values[1], left);
  }
  return std::nullopt;
}

}  // namespace hysteron::bodies
