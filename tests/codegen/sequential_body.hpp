// A second reading of a sequential body: executed statement by statement, on numbers. It shares nothing with the
// translation into a graph but the syntax tree, and knows what RandomBody writes.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "codegen/language/body.hpp"
#include "codegen/language/syntax.hpp"
#include "support/single.hpp"

namespace hysteron::testing {

namespace tree = language::body;

class SequentialBody {
 public:
  /// A number as a C compiler has it: an integer type of so many bits, float, double or bool.
  struct Number {
    char kind = 'i';  ///< i: signed, u: unsigned, b: truth, f: float, d: double, l: a literal without a type
    int bits = 32;
    double value = 0.0;
  };
  using Memory = std::map<std::string, Number>;

  SequentialBody(const tree::Library& library, const std::string& name) : library_(library), unit_(find(name, false)) {
    declare(unit_, "", memory_);
  }
  void set(const std::string& name, double value) { memory_.at(name).value = value; }
  [[nodiscard]] double get(const std::string& name) const { return memory_.at(name).value; }
  void step() { run_unit(unit_, "", memory_); }

 private:
  enum class Jump { None, Return, Exit, Continue };
  struct Frame {
    const tree::Unit& unit;
    std::string prefix;
    Memory& memory;
    std::map<std::string, std::string> aliases{};  ///< VAR_IN_OUT: the name in the caller's memory
  };

  const tree::Unit& find(const std::string& name, bool function) const {
    for (const auto& unit : library_.units) {
      if (unit.function == function && language::same_name(unit.name.text, name)) {
        return unit;
      }
    }
    throw std::runtime_error("no unit " + name);
  }
  static bool type_of(std::string_view type, Number& number) {
    static const std::map<std::string, Number> types{{"BOOL", {'b', 1}},   {"SINT", {'i', 8}},  {"INT", {'i', 16}},
                                                     {"DINT", {'i', 32}},  {"USINT", {'u', 8}}, {"UINT", {'u', 16}},
                                                     {"UDINT", {'u', 32}}, {"BYTE", {'u', 8}},  {"WORD", {'u', 16}},
                                                     {"DWORD", {'u', 32}}, {"REAL", {'f', 32}}, {"LREAL", {'d', 64}}};
    const auto found = types.find(language::upper(type));
    if (found != types.end()) {
      number = found->second;
    }
    return found != types.end();
  }

  void declare(const tree::Unit& unit, const std::string& prefix, Memory& memory) {
    Frame frame{unit, prefix, memory};
    for (const auto& one : unit.declarations) {
      declare(one.type, prefix + language::upper(one.name.text), one.initial, frame);
    }
    Number result;
    if (unit.function && type_of(unit.result.name.text, result)) {
      memory[prefix + language::upper(unit.name.text)] = result;
    }
  }
  void declare(const tree::TypeSpec& type, const std::string& name, const tree::Initial& initial, Frame& frame) {
    if (!type.dimensions.empty()) {
      tree::TypeSpec element = type;
      element.dimensions.clear();
      const int low = static_cast<int>(value(type.dimensions[0].first, frame).value);
      const int high = static_cast<int>(value(type.dimensions[0].second, frame).value);
      frame.memory[name + ".LOW"] = {'i', 32, static_cast<double>(low)};
      frame.memory[name + ".HIGH"] = {'i', 32, static_cast<double>(high)};
      for (int i = low; i <= high; ++i) {
        const auto at = static_cast<std::size_t>(i - low);
        declare(element, name + "[" + std::to_string(i) + "]",
                at < initial.elements.size() ? initial.elements[at] : tree::Initial{}, frame);
      }
      return;
    }
    Number number;
    if (type_of(type.name.text, number)) {
      frame.memory[name] =
          initial.value != language::no_expression ? kept(value(initial.value, frame), number) : number;
      return;
    }
    for (const auto& one : library_.types) {
      if (language::same_name(one.name.text, type.name.text)) {
        for (const auto& field : one.type.fields) {
          declare(field.type, name + "." + language::upper(field.name.text), field.initial, frame);
        }
        return;
      }
    }
    declare(find(std::string(type.name.text), false), name + ".", frame.memory);
  }

  void run_unit(const tree::Unit& unit, const std::string& prefix, Memory& memory,
                std::map<std::string, std::string> aliases = {}) {
    Frame frame{unit, prefix, memory, std::move(aliases)};
    for (const auto& one : unit.declarations) {
      if (one.role == tree::Role::Temporary) {
        declare(one.type, prefix + language::upper(one.name.text), one.initial, frame);
      }
    }
    run(unit.statements, frame);
  }

  Jump run(const tree::Statements& list, Frame& frame) {
    for (const auto& one : list) {
      if (const Jump jump = run(one, frame); jump != Jump::None) {
        return jump;
      }
    }
    return Jump::None;
  }
  Jump run(const tree::Statement& one, Frame& frame) {
    if (const auto* assign = std::get_if<tree::Assign>(&one.node)) {
      store(assign->target, value(assign->value, frame), frame);
    } else if (const auto* invoke = std::get_if<tree::Invoke>(&one.node)) {
      call(*invoke, frame);
    } else if (const auto* choice = std::get_if<tree::If>(&one.node)) {
      for (const auto& branch : choice->branches) {
        if (value(branch.condition, frame).value != 0.0) {
          return run(branch.statements, frame);
        }
      }
      return run(choice->otherwise, frame);
    } else if (const auto* cases = std::get_if<tree::Case>(&one.node)) {
      const double selector = value(cases->selector, frame).value;
      for (const auto& arm : cases->arms) {
        for (const auto& label : arm.labels) {
          const double low = value(label.low, frame).value;
          const double high = label.high == language::no_expression ? low : value(label.high, frame).value;
          if (selector >= low && selector <= high) {
            return run(arm.statements, frame);
          }
        }
      }
      return run(cases->otherwise, frame);
    } else if (const auto* loop = std::get_if<tree::For>(&one.node)) {
      const double by = loop->by == language::no_expression ? 1.0 : value(loop->by, frame).value;
      const double to = value(loop->to, frame).value;
      Number& counter = frame.memory.at(frame.prefix + language::upper(loop->variable.text));
      for (double at = value(loop->from, frame).value;; at += by) {
        counter.value = at;
        if (by > 0.0 ? at > to : at < to) {
          return Jump::None;
        }
        const Jump jump = run(loop->statements, frame);
        if (jump == Jump::Exit) {
          return Jump::None;
        }
        if (jump == Jump::Return) {
          return jump;
        }
      }
    } else if (const auto* turns = std::get_if<tree::Loop>(&one.node)) {
      const auto holds = [&] { return value(turns->condition, frame).value != 0.0; };
      while (!turns->tested_first || holds()) {
        const Jump jump = run(turns->statements, frame);
        if (jump == Jump::Return) {
          return jump;
        }
        if (jump == Jump::Exit || (!turns->tested_first && holds())) {
          break;
        }
      }
    } else {
      const auto jump = std::get<tree::Jump>(one.node);
      return jump == tree::Jump::Return ? Jump::Return : (jump == tree::Jump::Exit ? Jump::Exit : Jump::Continue);
    }
    return Jump::None;
  }

  void call(const tree::Invoke& invoke, Frame& frame) {
    const std::string instance = language::upper(invoke.instance.name.text);
    const tree::Unit* unit = nullptr;
    for (const auto& one : frame.unit.declarations) {
      if (language::upper(one.name.text) == instance) {
        unit = &find(std::string(one.type.name.text), false);
      }
    }
    const std::string prefix = frame.prefix + instance + ".";
    std::map<std::string, std::string> aliases;
    for (const auto& argument : invoke.arguments) {
      const std::string name = language::upper(argument.formal.text);
      bool in_out = false;
      for (const auto& one : unit->declarations) {
        in_out = in_out || (one.role == tree::Role::InOut && language::upper(one.name.text) == name);
      }
      if (in_out) {
        aliases[name] = place(std::get<tree::Access>(library_.expressions[argument.value].node), frame);
      } else if (!argument.output) {
        Number& pin = frame.memory.at(prefix + name);
        pin = kept(value(argument.value, frame), pin);
      }
    }
    run_unit(*unit, prefix, frame.memory, aliases);
    for (const auto& argument : invoke.arguments) {
      if (argument.output) {
        store(std::get<tree::Access>(library_.expressions[argument.value].node),
              frame.memory.at(prefix + language::upper(argument.formal.text)), frame);
      }
    }
  }

  std::string place(const tree::Access& access, Frame& frame, int* bit = nullptr) {
    const std::string root = language::upper(access.name.text);
    const auto alias = frame.aliases.find(root);
    std::string name = alias == frame.aliases.end() ? frame.prefix + root : alias->second;
    for (const auto& step : access.steps) {
      if (step.bit >= 0) {
        if (bit != nullptr) {
          *bit = step.bit;
        }
      } else if (step.indexes.empty()) {
        name += "." + language::upper(step.member.text);
      } else {
        const double low = frame.memory.at(name + ".LOW").value;
        const double high = frame.memory.at(name + ".HIGH").value;
        const double index = std::min(std::max(value(step.indexes[0], frame).value, low), high);
        name += "[" + std::to_string(static_cast<int>(index)) + "]";
      }
    }
    return name;
  }
  void store(const tree::Access& access, const Number& given, Frame& frame) {
    int bit = -1;
    Number& target = frame.memory.at(place(access, frame, &bit));
    if (bit < 0) {
      target = kept(given, target);
      return;
    }
    const std::uint64_t mask = std::uint64_t{1} << static_cast<unsigned>(bit);
    const auto old = static_cast<std::uint64_t>(target.value);
    target.value = static_cast<double>(given.value != 0.0 ? old | mask : old & ~mask);
  }

  /// As a variable of the type keeps it.
  static Number kept(const Number& given, const Number& type) {
    Number result = type;
    result.value = given.value;
    if (type.kind == 'f') {
      result.value = nearest_single(given.value);
    } else if (type.kind == 'i' || type.kind == 'u') {
      const auto whole = static_cast<std::uint64_t>(static_cast<std::int64_t>(given.value));
      const auto mask = (std::uint64_t{1} << static_cast<unsigned>(type.bits)) - 1;
      auto bits = static_cast<std::int64_t>(whole & mask);
      if (type.kind == 'i' && (bits >> (type.bits - 1)) != 0) {
        bits -= std::int64_t{1} << static_cast<unsigned>(type.bits);
      }
      result.value = static_cast<double>(bits);
    }
    return result;
  }

  static bool is_real(const Number& one) { return one.kind == 'f' || one.kind == 'd'; }
  static bool is_whole(const Number& one) { return one.kind == 'i' || one.kind == 'u' || one.kind == 'l'; }
  static bool is_unsigned_32(const Number& one) { return one.kind == 'u' && one.bits == 32; }

  Number value(language::ExpressionId id, Frame& frame) {
    const auto& node = library_.expressions[id].node;
    if (const auto* literal = std::get_if<tree::Literal>(&node)) {
      Number type;
      if (literal->kind == tree::Literal::Kind::Truth) {
        return {'b', 1, literal->value};
      }
      if (!literal->type.empty() && type_of(literal->type, type)) {
        return kept({'d', 64, literal->value}, type);
      }
      return literal->kind == tree::Literal::Kind::Real ? Number{'d', 64, literal->value}
                                                        : Number{'l', 32, literal->value};
    }
    if (const auto* access = std::get_if<tree::Access>(&node)) {
      int bit = -1;
      const Number found = frame.memory.at(place(*access, frame, &bit));
      if (bit < 0) {
        return found;
      }
      return {'b', 1,
              static_cast<double>((static_cast<std::uint64_t>(found.value) >> static_cast<unsigned>(bit)) & 1U)};
    }
    if (const auto* unary = std::get_if<tree::Unary>(&node)) {
      Number x = value(unary->operand, frame);
      if (unary->op == language::Operator::Negate) {
        x.value = is_real(x) ? -x.value : 0.0 - x.value;
        return x;
      }
      return x.kind == 'b' ? Number{'b', 1, x.value == 0.0 ? 1.0 : 0.0}
                           : kept({'i', 32, static_cast<double>(~static_cast<std::int64_t>(x.value))}, x);
    }
    if (const auto* binary = std::get_if<tree::Binary>(&node)) {
      return binary_value(binary->op, value(binary->left, frame), value(binary->right, frame));
    }
    return function(std::get<tree::Call>(node), frame);
  }

  static Number binary_value(language::Operator op, Number a, Number b) {
    using language::Operator;
    const auto truth = [](bool x) { return Number{'b', 1, x ? 1.0 : 0.0}; };
    if (op >= Operator::Less && op <= Operator::NotEqual) {
      switch (op) {
        case Operator::Less:
          return truth(a.value < b.value);
        case Operator::LessEqual:
          return truth(a.value <= b.value);
        case Operator::Greater:
          return truth(a.value > b.value);
        case Operator::GreaterEqual:
          return truth(a.value >= b.value);
        case Operator::Equal:
          return truth(a.value == b.value);
        default:
          return truth(a.value != b.value);
      }
    }
    if (op >= Operator::And) {
      const auto x = static_cast<std::uint64_t>(static_cast<std::int64_t>(a.value));
      const auto y = static_cast<std::uint64_t>(static_cast<std::int64_t>(b.value));
      const std::uint64_t bits = op == Operator::And ? x & y : (op == Operator::Or ? x | y : x ^ y);
      const Number type = a.kind == 'l' ? b : a;
      return kept({'i', 32, static_cast<double>(static_cast<std::int64_t>(bits))}, type);
    }
    if (is_real(a) || is_real(b)) {
      const bool single = (a.kind == 'f' || !is_real(a)) && (b.kind == 'f' || !is_real(b));
      double x = 0.0;
      switch (op) {
        case Operator::Add:
          x = a.value + b.value;
          break;
        case Operator::Subtract:
          x = a.value - b.value;
          break;
        case Operator::Multiply:
          x = a.value * b.value;
          break;
        default:
          x = a.value / b.value;
      }
      return single ? Number{'f', 32, nearest_single(x)} : Number{'d', 64, x};
    }
    // C: 32 bits, without a sign where one side is so wide and has none.
    const bool without_sign = is_unsigned_32(a) || is_unsigned_32(b);
    const Number type{without_sign ? 'u' : 'i', 32};
    const auto x = static_cast<std::int64_t>(kept(a, type).value);
    const auto y = static_cast<std::int64_t>(kept(b, type).value);
    std::int64_t result = 0;
    switch (op) {
      case Operator::Add:
        result = x + y;
        break;
      case Operator::Subtract:
        result = x - y;
        break;
      case Operator::Multiply:
        result = static_cast<std::int64_t>(static_cast<std::uint64_t>(x) * static_cast<std::uint64_t>(y));
        break;
      case Operator::Divide:
        result = y == 0 ? 0 : x / y;
        break;
      default:
        result = y == 0 ? 0 : x % y;
    }
    const auto low = static_cast<std::uint32_t>(static_cast<std::uint64_t>(result));
    return {type.kind, 32,
            without_sign ? static_cast<double>(low) : static_cast<double>(static_cast<std::int32_t>(low))};
  }

  Number function(const tree::Call& call, Frame& frame) {
    std::vector<Number> args;
    for (const auto& argument : call.arguments) {
      args.push_back(value(argument.value, frame));
    }
    const std::string name = language::upper(call.function.text);
    if (name == "SEL") {
      Number chosen = args[0].value != 0.0 ? args[2] : args[1];
      const Number& other = args[0].value != 0.0 ? args[1] : args[2];
      return chosen.kind == 'l' || (is_whole(chosen) && is_whole(other) && chosen.bits < other.bits)
                 ? kept(chosen, other.kind == 'l' ? Number{'i', 32} : other)
                 : chosen;
    }
    if (name == "MIN" || name == "MAX") {
      Number a = kept(args[0], args[0].kind == 'l' ? Number{'i', 32} : args[0]);
      Number b = kept(args[1], args[1].kind == 'l' ? Number{'i', 32} : args[1]);
      Number best = (name == "MIN" ? b.value < a.value : b.value > a.value) ? b : a;
      best.bits = 32;
      return best;
    }
    if (name == "LIMIT") {
      const double above = args[0].value > args[1].value ? args[0].value : args[1].value;
      return {'d', 64, args[2].value < above ? args[2].value : above};
    }
    if (name == "ABS") {
      return kept({'d', 64, std::fabs(kept(args[0], args[0]).value)}, args[0]);
    }
    if (name == "SHL" || name == "SHR") {
      const double n = args[1].value;
      const auto bits = static_cast<std::uint32_t>(static_cast<std::uint64_t>(args[0].value));
      const auto places = static_cast<unsigned>(n);
      const std::uint32_t shifted = n < 0.0 || n > 31.0 ? 0U : (name == "SHL" ? bits << places : bits >> places);
      return kept({'u', 32, static_cast<double>(shifted)}, args[0]);
    }
    if (name == "ROL") {
      const auto bits = static_cast<std::uint32_t>(static_cast<std::uint64_t>(args[0].value));
      const auto n = static_cast<unsigned>(args[1].value) % 32U;
      return {'u', 32, static_cast<double>(n == 0 ? bits : (bits << n | bits >> (32U - n)))};
    }
    if (const auto mark = name.find("_TO_"); mark != std::string::npos) {
      Number from;
      Number to;
      type_of(std::string_view(name).substr(0, mark), from);
      type_of(std::string_view(name).substr(mark + 4), to);
      const Number x = kept(args[0], from);
      if (is_real(x) && is_whole(to)) {
        const double near = std::nearbyint(x.value);
        return kept({'i', 32, std::min(std::max(near, -2147483648.0), 2147483647.0)}, to);
      }
      return kept(x, to);
    }
    const tree::Unit& unit = find(name, true);
    Memory memory;
    declare(unit, "", memory);
    std::size_t next = 0;
    for (const auto& one : unit.declarations) {
      if (one.role == tree::Role::Input) {
        Number& target = memory.at(language::upper(one.name.text));
        target = kept(args[next++], target);
      }
    }
    run_unit(unit, "", memory);
    return memory.at(name);
  }

  const tree::Library& library_;
  const tree::Unit& unit_;
  Memory memory_{};
};

}  // namespace hysteron::testing
