// The functions of the language, each as the operations that it is made of.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "codegen/graph/lowering.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

struct Function {
  std::string_view name;
  Op op;
};
constexpr std::array unary_functions{
    Function{"ABS", Op::Abs},   Function{"SQRT", Op::Sqrt}, Function{"LN", Op::Log},     Function{"EXP", Op::Exp},
    Function{"SIN", Op::Sin},   Function{"COS", Op::Cos},   Function{"TAN", Op::Tan},    Function{"ASIN", Op::Asin},
    Function{"ACOS", Op::Acos}, Function{"ATAN", Op::Atan}, Function{"TRUNC", Op::ToInt}};

struct Formal {
  std::string_view function;
  std::array<std::string_view, 9> names;
};
constexpr std::array formal_names{Formal{"EXPT", {"IN1", "IN2"}},
                                  Formal{"MIN", {"IN1", "IN2", "IN3", "IN4", "IN5", "IN6", "IN7", "IN8"}},
                                  Formal{"MAX", {"IN1", "IN2", "IN3", "IN4", "IN5", "IN6", "IN7", "IN8"}},
                                  Formal{"LIMIT", {"MN", "IN", "MX"}},
                                  Formal{"SEL", {"G", "IN0", "IN1"}},
                                  Formal{"SHL", {"IN", "N"}},
                                  Formal{"SHR", {"IN", "N"}},
                                  Formal{"MUX", {"K", "IN0", "IN1", "IN2", "IN3", "IN4", "IN5", "IN6", "IN7"}}};
constexpr std::array<std::string_view, 1> only_operand{"IN"};

/// What a function of another language is here.
struct Foreign {
  std::string_view name;
  std::string_view here;
};
constexpr std::array foreign_functions{Foreign{"POW", "EXPT(base, exponent), or base ** exponent"},
                                       Foreign{"POWER", "EXPT(base, exponent), or base ** exponent"},
                                       Foreign{"FABS", "ABS"},
                                       Foreign{"LOG10", "LOG"},
                                       Foreign{"SQR", "X * X; a square root is SQRT"},
                                       Foreign{"SGN", "an instance of HY_SIGN"},
                                       Foreign{"SIGN", "an instance of HY_SIGN"},
                                       Foreign{"FLOOR", "DINT_TO_LREAL(TRUNC(X)), towards 0"},
                                       Foreign{"ROUND", "DINT_TO_LREAL(LREAL_TO_DINT(X))"},
                                       Foreign{"MOD", "A MOD B, of whole numbers"},
                                       Foreign{"FMOD", "A MOD B, of whole numbers"},
                                       Foreign{"SINH", "(EXP(X) - EXP(-X)) / 2.0"},
                                       Foreign{"COSH", "(EXP(X) + EXP(-X)) / 2.0"},
                                       Foreign{"CLAMP", "LIMIT(low, X, high)"},
                                       Foreign{"IF", "SEL(CONDITION, IF_FALSE, IF_TRUE)"}};

/// `Write EXPT(…). `; empty where the name tells nothing.
std::string meant_function(std::string_view name) {
  const auto* const known =
      std::ranges::find_if(foreign_functions, [&](const Foreign& one) { return equal_ignoring_case(one.name, name); });
  return known == foreign_functions.end() ? std::string() : fmt::format("Write {}. ", known->here);
}

Op select_for(Type type) {
  switch (type) {
    case Type::Int:
      return Op::SelectInt;
    case Type::Bool:
      return Op::SelectBool;
    case Type::Word:
      return Op::SelectWord;
    default:
      return Op::Select;
  }
}

}  // namespace

std::span<const std::string_view> formal_arguments(std::string_view function) {
  for (const Formal& one : formal_names) {
    if (one.function == function) {
      return {one.names.begin(), std::ranges::find(one.names, std::string_view())};
    }
  }
  return only_operand;
}

// LREAL_TO_DINT rounds to the nearest, ties to even, as IEC 60559 and the standard say.
Wire Lowering::round_to_int(Wire x, language::Span span) {
  const Wire whole = apply(Op::ToInt, {x}, span);
  const Wire rest = apply(Op::Subtract, {x, apply(Op::ToReal, {whole}, span)}, span);
  const Wire odd = apply(
      Op::IntNotEqual,
      {apply(Op::IntModulo, {whole, builder_.literal(Type::Int, 2)}, span), builder_.literal(Type::Int, 0)}, span);
  const auto beyond = [&](double half) {
    const Wire limit = builder_.literal(Type::Real, half);
    const Wire end = builder_.literal(
        Type::Int, half > 0 ? std::numeric_limits<std::int32_t>::max() : std::numeric_limits<std::int32_t>::min());
    const Wire past = half > 0 ? apply(Op::Less, {limit, rest}, span) : apply(Op::Less, {rest, limit}, span);
    const Wire inside = apply(Op::IntNotEqual, {whole, end}, span);  // at its ends DINT saturates
    const Wire tie = apply(Op::And, {apply(Op::Equal, {rest, limit}, span), odd}, span);
    return apply(Op::And, {apply(Op::Or, {past, tie}, span), inside}, span);
  };
  const Wire one = builder_.literal(Type::Int, 1);
  const Wire up = apply(Op::IntAdd, {whole, one}, span);
  const Wire down = apply(Op::IntSubtract, {whole, one}, span);
  return apply(Op::SelectInt, {beyond(0.5), up, apply(Op::SelectInt, {beyond(-0.5), down, whole}, span)}, span);
}

Wire Lowering::rounded(GraphBuilder& builder, Wire x, const std::string& path, language::Span span) {
  static const language::SourceFile no_text;
  Lowering lowering(
      builder, no_text, [](const auto&, auto) { return Wire{}; }, [](int, auto, auto, auto) {});
  lowering.path_ = path;
  return lowering.round_to_int(x, span);
}

// The angle of a point by one division and one arctangent, the smaller coordinate over the larger: no divisor is 0
// where a PLC would stop, and derivatives are right on the axes. At the origin it is 0.
Wire Lowering::angle_of(Wire y, Wire x, language::Span span) {
  constexpr double pi = 3.141592653589793;
  const Wire zero = builder_.literal(Type::Real, 0.0);
  const auto choose = [&](Wire condition, Wire yes, Wire no) { return apply(Op::Select, {condition, yes, no}, span); };
  const auto signed_by_y = [&](double angle) {
    return choose(apply(Op::Less, {y, zero}, span), builder_.literal(Type::Real, -angle),
                  builder_.literal(Type::Real, angle));
  };
  const Wire steep = apply(Op::Less, {apply(Op::Abs, {x}, span), apply(Op::Abs, {y}, span)}, span);
  const Wire larger = choose(steep, y, x);
  const Wire divisor = choose(apply(Op::Equal, {larger, zero}, span), builder_.literal(Type::Real, 1.0), larger);
  const Wire part = apply(Op::Atan, {apply(Op::Divide, {choose(steep, x, y), divisor}, span)}, span);
  const Wire turn = choose(apply(Op::Less, {x, zero}, span), signed_by_y(pi), zero);
  return choose(steep, apply(Op::Subtract, {signed_by_y(pi / 2.0), part}, span), apply(Op::Add, {part, turn}, span));
}

Wire Lowering::lower_words(language::Operator op, Wire left, Wire right, language::Span span) {
  using language::Operator;
  const auto bits = [&](Op operation) {
    return apply(operation, {apply(Op::WordToInt, {left}, span), apply(Op::WordToInt, {right}, span)}, span);
  };
  switch (op) {
    case Operator::And:
      return apply(Op::IntToWord, {bits(Op::IntAnd)}, span);
    case Operator::Or:
      return apply(Op::IntToWord, {bits(Op::IntOr)}, span);
    case Operator::Xor:
      return apply(Op::IntToWord, {bits(Op::IntXor)}, span);
    case Operator::Equal:
      return bits(Op::IntEqual);
    case Operator::NotEqual:
      return bits(Op::IntNotEqual);
    default:
      return {};
  }
}

std::optional<Wire> Lowering::lower_word_call(std::string_view name, const std::vector<Wire>& args,
                                              language::Span span) {
  const auto wrong = [&](std::string form) {
    report_(error::unknown_function, span, fmt::format("{} does not take these arguments", name),
            fmt::format("Write {}.", form));
    return Wire{};
  };
  if (name == "WORD_TO_DINT") {
    return args.size() == 1 && args[0].type == Type::Word ? apply(Op::WordToInt, {args[0]}, span)
                                                          : wrong("WORD_TO_DINT(W) with a WORD");
  }
  if (name == "DINT_TO_WORD") {
    return args.size() == 1 && args[0].type == Type::Int ? apply(Op::IntToWord, {args[0]}, span)
                                                         : wrong("DINT_TO_WORD(N) with a DINT");
  }
  if (name != "SHL" && name != "SHR") {
    return std::nullopt;
  }
  constexpr double bits_of_word = 16.0;
  if (args.size() != 2 || args[0].type != Type::Word || args[1].type != Type::Int ||
      !GraphBuilder::is_literal(args[1]) || builder_.value(args[1]) < 0.0 || builder_.value(args[1]) > bits_of_word) {
    return wrong(fmt::format("{}(W, 4) with a WORD and a number of places from 0 to 16", name));
  }
  if (builder_.value(args[1]) == 0.0) {
    return args[0];
  }
  if (builder_.value(args[1]) == bits_of_word) {
    return apply(Op::IntToWord,
                 {apply(Op::IntAnd, {apply(Op::WordToInt, {args[0]}, span), builder_.literal(Type::Int, 0)}, span)},
                 span);
  }
  return apply(Op::IntToWord,
               {apply(name == "SHL" ? Op::IntShiftLeft : Op::IntShiftRight,
                      {apply(Op::WordToInt, {args[0]}, span), args[1]}, span)},
               span);
}

Wire Lowering::lower_call(const language::FunctionCall& call, language::Span span) {
  const std::string name = language::upper(call.function.text);
  std::vector<Wire> args;
  for (const auto& argument : call.arguments) {
    args.push_back(expression(argument.value));
    if (args.back().from == Wire::From::Nothing) {
      return {};
    }
  }
  const auto wrong = [&](std::string_view form) {
    report_(error::unknown_function, span, fmt::format("{} does not take these arguments", name),
            fmt::format("Write {}.", form));
    return Wire{};
  };
  const auto all = [&](Type type, std::size_t count) {
    bool good = args.size() == count;
    for (const Wire& arg : args) {
      good = good && arg.type == type;
    }
    return good;
  };
  // Formal arguments are put in the order of the standard.
  const auto formal = [&] {
    const auto order = formal_arguments(name);
    std::vector<Wire> sorted(args.size());
    bool named = !call.arguments.empty() && !call.arguments.front().formal.text.empty();
    if (!named) {
      return true;
    }
    std::vector<bool> taken(args.size(), false);
    for (std::size_t i = 0; i < args.size(); ++i) {
      std::size_t place = 0;
      bool found = false;
      for (const auto wanted : order) {
        if (language::same_name(call.arguments[i].formal.text, wanted) && place < sorted.size() && !taken[place]) {
          sorted[place] = args[i];
          taken[place] = found = true;
        }
        ++place;
      }
      if (!found) {
        return false;
      }
    }
    args = sorted;
    return true;
  };

  for (const Function& function : unary_functions) {
    if (name == function.name) {
      if (!formal() || args.size() != 1) {
        return wrong(fmt::format("{}(X) with an LREAL", name));
      }
      if (name == "ABS" && all(Type::Int, 1)) {
        return apply(Op::IntMax, {args[0], apply(Op::IntNegate, {args[0]}, span)}, span);
      }
      return all(Type::Real, 1) ? apply(function.op, {args[0]}, span) : wrong(fmt::format("{}(X) with an LREAL", name));
    }
  }
  if (name == "LOG") {
    return formal() && all(Type::Real, 1)
               ? apply(Op::Divide, {apply(Op::Log, {args[0]}, span), builder_.literal(Type::Real, 2.302585092994046)},
                       span)
               : wrong("LOG(X) with an LREAL");
  }
  if (name == "EXPT") {
    if (!formal()) {
      return wrong("EXPT(BASE, EXPONENT) with LREALs");
    }
    if (args.size() == 2 && args[1].type == Type::Int) {
      args[1] = GraphBuilder::is_literal(args[1]) ? builder_.literal(Type::Real, builder_.value(args[1]))
                                                  : apply(Op::ToReal, {args[1]}, span);
    }
    return all(Type::Real, 2) ? apply(Op::Power, {args[0], args[1]}, span) : wrong("EXPT(BASE, EXPONENT) with LREALs");
  }
  if (name == "ATAN2") {
    return formal() && all(Type::Real, 2) ? angle_of(args[0], args[1], span) : wrong("ATAN2(Y, X) with two LREALs");
  }
  if (name == "MIN" || name == "MAX") {
    if (!formal() || args.size() < 2 || !(all(Type::Real, args.size()) || all(Type::Int, args.size()))) {
      return wrong(fmt::format("{}(A, B, …) with two or more LREALs or DINTs", name));
    }
    const bool real = args[0].type == Type::Real;
    const Op op = name == "MIN" ? (real ? Op::Min : Op::IntMin) : (real ? Op::Max : Op::IntMax);
    Wire result = args[0];
    for (std::size_t i = 1; i < args.size(); ++i) {
      result = apply(op, {result, args[i]}, span);
    }
    return result;
  }
  if (name == "LIMIT") {
    if (!formal() || !(all(Type::Real, 3) || all(Type::Int, 3))) {
      return wrong("LIMIT(MN, IN, MX) with three LREALs or three DINTs");
    }
    const bool real = args[0].type == Type::Real;
    return apply(real ? Op::Min : Op::IntMin, {apply(real ? Op::Max : Op::IntMax, {args[1], args[0]}, span), args[2]},
                 span);
  }
  if (name == "SEL") {
    if (!formal() || args.size() != 3 || args[0].type != Type::Bool || args[1].type != args[2].type) {
      return wrong("SEL(G, IN0, IN1) with a BOOL and two values of one type: IN1 where G is TRUE");
    }
    return apply(select_for(args[1].type), {args[0], args[2], args[1]}, span);
  }
  if (name == "MUX") {
    bool good = args.size() >= 3 && args[0].type == Type::Int && formal();
    for (std::size_t i = 2; good && i < args.size(); ++i) {
      good = args[i].type == args[1].type;
    }
    if (!good) {
      return wrong("MUX(K, IN0, IN1, …) with a DINT and values of one type");
    }
    Wire result = args.back();  // a K outside selects the nearest end
    for (std::size_t i = args.size() - 1; i-- > 1;) {
      const Wire past =
          apply(Op::IntLessEqual, {args[0], builder_.literal(Type::Int, static_cast<double>(i - 1))}, span);
      result = apply(select_for(args[1].type), {past, args[i], result}, span);
    }
    return result;
  }
  if (name == "DINT_TO_LREAL") {
    return all(Type::Int, 1) ? apply(Op::ToReal, {args[0]}, span) : wrong("DINT_TO_LREAL(N) with a DINT");
  }
  if (name == "LREAL_TO_DINT") {
    return all(Type::Real, 1) ? round_to_int(args[0], span) : wrong("LREAL_TO_DINT(X) with an LREAL");
  }
  if (name == "BOOL_TO_DINT") {
    return all(Type::Bool, 1)
               ? apply(Op::SelectInt, {args[0], builder_.literal(Type::Int, 1), builder_.literal(Type::Int, 0)}, span)
               : wrong("BOOL_TO_DINT(B) with a BOOL");
  }
  if (!call.arguments.empty() && formal()) {
    if (const auto result = lower_word_call(name, args, span)) {
      return *result;
    }
  }
  report_(error::unknown_function, call.function.span, fmt::format("there is no function '{}'", call.function.text),
          meant_function(call.function.text) +
              "Known: ABS SQRT LN LOG EXP EXPT SIN COS TAN ASIN ACOS ATAN ATAN2 TRUNC MIN MAX LIMIT SEL MUX SHL SHR "
              "DINT_TO_LREAL LREAL_TO_DINT BOOL_TO_DINT WORD_TO_DINT DINT_TO_WORD.");
  return {};
}

}  // namespace hysteron
