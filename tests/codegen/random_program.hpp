// Random diagrams: instances of any block, wired at random, with feedback through delays.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/graph/definition.hpp"
#include "codegen/graph/elaborate.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::testing {

/// What a diagram has beside blocks of one rate over X1 to X3, B1, B2 and N1.
struct RandomWords {
  bool rates = false;      ///< parts that run in every n-th step, between HY_SAMPLE and HY_HOLD
  bool types = false;      ///< an input W1 and an output W of WORD, and DINT at the ends of its range
  bool functions = false;  ///< all functions of the language
  bool vectors = false;    ///< vectors, also as inputs XV, BV and outputs YV, YW; and blocks whose pins are vectors
};

class RandomDiagram {
 public:
  RandomDiagram(std::uint64_t seed, std::string name, int instances, const RandomWords& words = {})
      : engine_(seed), name_(std::move(name)), words_(words) {
    write(instances);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

  /// The program, without a check of units (random wires do not care).
  [[nodiscard]] Program program() const {
    Diagnostics diagnostics;
    const auto source = std::make_shared<const language::SourceFile>(language::parse(name_, text_, diagnostics));
    const Definitions definitions = define(source, diagnostics);
    Program result;
    result.graph = elaborate(definitions, 0, diagnostics);
    result.schedule = schedule(result.graph, diagnostics);
    if (diagnostics.has_errors()) {
      throw InputError(diagnostics);
    }
    return result;
  }

 private:
  std::size_t pick(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  std::string literal(Type type) {
    switch (type) {
      case Type::Real:
        return fmt::format("({:.6f})", 4.0 * unit() - 2.0);
      case Type::Int:
        return fmt::format("{}", pick(7));
      case Type::Bool:
        return pick(2) != 0 ? "TRUE" : "FALSE";
      default:
        return fmt::format("WORD#{}", pick(65536));
    }
  }

  std::string source(Type type, int depth = 0) {
    const auto& list = sources_[static_cast<std::size_t>(type)];
    if (depth < 2 && pick(4) == 0) {
      const auto real = [&] { return source(Type::Real, depth + 1); };
      const auto truth = [&] { return source(Type::Bool, depth + 1); };
      const auto integer = [&] { return source(Type::Int, depth + 1); };
      const auto word = [&] { return source(Type::Word, depth + 1); };
      if (words_.types && words_.functions && pick(4) == 0) {
        if (type == Type::Bool) {
          return fmt::format("({} {} {})", word(), pick(2) != 0 ? "=" : "<>", word());
        }
        if (type == Type::Int) {
          return fmt::format("WORD_TO_DINT({})", word());
        }
      }
      switch (type) {
        case Type::Real: {
          if (words_.functions && pick(3) == 0) {
            return function(real, truth, integer);
          }
          const std::vector<std::string> forms{fmt::format("({} + {})", real(), real()),
                                               fmt::format("({} - {} * {})", real(), real(), real()),
                                               fmt::format("({} / ({} - {}))", real(), real(), real()),
                                               fmt::format("(-({}))", real()),
                                               fmt::format("SEL({}, {}, {})", truth(), real(), real()),
                                               fmt::format("MIN({}, {})", real(), real()),
                                               fmt::format("LIMIT(-1.0, {}, 1.0)", real()),
                                               fmt::format("ABS({})", real()),
                                               fmt::format("SIN({})", real()),
                                               fmt::format("EXP(-(ABS({})))", real()),
                                               fmt::format("(ABS({}) ** ({}))", real(), real()),
                                               fmt::format("DINT_TO_LREAL({})", integer()),
                                               fmt::format("({} - ({} - {}))", real(), real(), real()),
                                               fmt::format("({} / {} / {})", real(), real(), real())};
          return forms[pick(forms.size())];
        }
        case Type::Bool: {
          const std::vector<std::string> forms{fmt::format("({} < {})", real(), real()),
                                               fmt::format("({} AND {} OR {})", truth(), truth(), truth()),
                                               fmt::format("({} XOR {})", truth(), truth()),
                                               fmt::format("(NOT {})", truth()),
                                               fmt::format("({} >= {})", integer(), integer()),
                                               fmt::format("({} = {})", truth(), truth())};
          return forms[pick(forms.size())];
        }
        case Type::Int: {
          const std::vector<std::string> forms{fmt::format("({} + {})", integer(), integer()),
                                               fmt::format("({} * {} - {})", integer(), integer(), integer()),
                                               fmt::format("({} MOD {})", integer(), integer()),
                                               fmt::format("({} / {})", integer(), integer()),
                                               fmt::format("LREAL_TO_DINT({})", real()),
                                               fmt::format("TRUNC({})", real())};
          if (words_.functions && pick(3) == 0) {
            const std::vector<std::string> more{fmt::format("ABS({})", integer()),
                                                fmt::format("MIN({}, {}, {})", integer(), integer(), integer()),
                                                fmt::format("LIMIT(-2, {}, 5)", integer()),
                                                fmt::format("SEL({}, {}, {})", truth(), integer(), integer()),
                                                fmt::format("BOOL_TO_DINT({})", truth())};
            return more[pick(more.size())];
          }
          return forms[pick(forms.size())];
        }
        default:
          if (words_.types && words_.functions) {
            const std::vector<std::string> forms{fmt::format("({} AND {})", word(), word()),
                                                 fmt::format("({} OR {})", word(), word()),
                                                 fmt::format("({} XOR 16#{:X})", word(), pick(65536)),
                                                 fmt::format("(NOT {})", word()),
                                                 fmt::format("SHL({}, {})", word(), pick(17)),
                                                 fmt::format("SHR({}, {})", word(), pick(17)),
                                                 fmt::format("DINT_TO_WORD({})", integer()),
                                                 fmt::format("SEL({}, {}, {})", truth(), word(), word())};
            return forms[pick(forms.size())];
          }
      }
    }
    return list.empty() || pick(8) == 0 ? literal(type) : list[pick(list.size())];
  }

  template <class Real, class Truth, class Integer>
  std::string function(Real real, Truth truth, Integer integer) {
    switch (pick(12)) {
      case 0:
        return fmt::format("SQRT({})", real());
      case 1:
        return fmt::format("LN({})", real());
      case 2:
        return fmt::format("LOG(ABS({}))", real());
      case 3:
        return fmt::format("(COS({}) * TAN({}))", real(), real());
      case 4:
        return fmt::format("ASIN({})", real());
      case 5:
        return fmt::format("ACOS({} / 4.0)", real());
      case 6:
        return fmt::format("ATAN2({}, {})", real(), real());
      case 7:
        return fmt::format("MUX({}, {}, {}, {})", integer(), real(), real(), real());
      case 8:
        return fmt::format("EXPT({}, {})", real(), std::vector{"2", "0.5", "-1", "3.0", "1", "-0.5"}[pick(6)]);
      case 9:
        return fmt::format("MAX({}, {}, {})", real(), real(), real());
      case 10:
        return fmt::format("ATAN({})", real());
      default:
        return fmt::format("DINT_TO_LREAL(SEL({}, {}, {}))", truth(), integer(), integer());
    }
  }

  std::string setting(const Field& field) {
    const double low = std::isfinite(field.minimum) ? field.minimum + (field.above_minimum ? 0.01 : 0.0)
                       : field.name == "MX"         ? 1.0  // not below MN
                                                    : -2.0;
    const double high = std::isfinite(field.maximum) ? field.maximum
                        : field.name == "DEAD_TIME"  ? 1.0  // within 1024 samples
                                                     : low + 3.0;
    if (field.type == Type::Int) {
      return fmt::format("{}", static_cast<int>(low + std::floor(unit() * (std::min(high, low + 5.0) - low + 1.0))));
    }
    return field.type == Type::Bool || field.type == Type::Word ? literal(field.type)
                                                                : fmt::format("{:.6f}", low + unit() * (high - low));
  }

  std::string settings_of(const BlockType& type) {
    std::vector<std::string> settings;
    for (const Field& param : type.params) {
      if (param.length > 1) {
        settings.push_back(fmt::format("{} := [-2.0, -0.5, 0.25, 3.0]", param.name));
      } else if (param.name == "COUNT") {
        settings.emplace_back("COUNT := 4");
      } else if (param.required || pick(2) == 0) {
        settings.push_back(fmt::format("{} := {}", param.name, setting(param)));
      }
    }
    return settings.empty() ? "" : fmt::format(" := ({})", fmt::join(settings, ", "));
  }

  /// A block that runs in every n-th step, with a sample of the signals before it and a hold of its result behind it.
  void write_slow(const std::string& name, const BlockType& type, std::string& declarations, std::string& statements) {
    const std::size_t every = 2 + pick(4);
    const std::string rate = fmt::format("(* @every {} @phase {} *)", every, pick(every));
    declarations += fmt::format("    S{0} : HY_SAMPLE;  {1}\n    {0} : {2}{3};  {1}\n", name, rate, type.about.name,
                                settings_of(type));
    statements += fmt::format("  S{}(XIN := {});\n", name, source(Type::Real));
    std::vector<std::string> arguments;
    for (const Field& input : type.inputs) {
      if (input.required || pick(2) != 0) {
        const std::string real =
            pick(2) == 0 ? fmt::format("S{}.XOUT", name) : fmt::format("(S{}.XOUT * 0.5 + 1.0)", name);
        arguments.push_back(fmt::format("{} := {}", input.name,
                                        input.type == Type::Real   ? real
                                        : input.type == Type::Bool ? fmt::format("(S{}.XOUT > 0.5)", name)
                                                                   : literal(input.type)));
      }
    }
    statements += fmt::format("  {}({});\n", name, fmt::join(arguments, ", "));
    for (const Field& output : type.outputs) {
      if (output.type == Type::Real) {
        declarations += fmt::format("    H{} : HY_HOLD;\n", name);
        statements += fmt::format("  H{0}(XIN := {0}.{1});\n", name, output.name);
        sources_[static_cast<std::size_t>(Type::Real)].push_back(fmt::format("H{}.XOUT", name));
        return;
      }
    }
  }

  /// A vector of a length: a list, one that is there, or an operation.
  std::string vector(std::size_t length, int depth = 0) {
    const auto& known = vectors_[length];
    if (depth < 2 && pick(2) == 0) {
      const auto other = [&] { return vector(length, depth + 1); };
      const auto one = [&] { return source(Type::Real, 2); };
      const std::vector<std::string> forms{fmt::format("({} + {})", other(), other()),
                                           fmt::format("({} - {} * {})", other(), one(), other()),
                                           fmt::format("({} / {})", other(), one()),
                                           fmt::format("(-({}))", other()),
                                           fmt::format("ABS({})", other()),
                                           fmt::format("MAX({}, {})", one(), other()),
                                           fmt::format("SEL({}, {}, {})", source(Type::Bool, 2), other(), other()),
                                           fmt::format("({} * {})", other(), other())};
      return forms[pick(forms.size())];
    }
    if (!known.empty() && pick(3) != 0) {
      return known[pick(known.size())];
    }
    std::vector<std::string> elements;
    for (std::size_t i = 0; i < length; ++i) {
      elements.push_back(source(Type::Real, 2));
    }
    return fmt::format("[{}]", fmt::join(elements, ", "));
  }

  std::string numbers(std::size_t count, double size) {
    std::vector<std::string> list;
    for (std::size_t i = 0; i < count; ++i) {
      list.push_back(fmt::format("{:.6f}", size * (2.0 * unit() - 1.0)));
    }
    return fmt::format("[{}]", fmt::join(list, ", "));
  }

  /// What a vector offers to others: itself, its elements, its sums.
  void offer(const std::string& name, std::size_t length) {
    auto& reals = sources_[static_cast<std::size_t>(Type::Real)];
    if (length == 1) {
      reals.push_back(name);
      return;
    }
    vectors_[length].push_back(name);
    reals.push_back(fmt::format("{}[{}]", name, pick(length)));
    reals.push_back(fmt::format("SUM({})", name));
    reals.push_back(fmt::format("DOT({}, {})", name, vector(length)));
    reals.push_back(fmt::format("NORM({})", name));
  }

  void write_vectors(std::string& declarations, std::string& statements) {
    for (std::size_t i = 0; i < 1 + pick(3); ++i) {
      const std::size_t length = length_from(2);
      declarations += fmt::format("    V{} : ARRAY[0..{}] OF LREAL;\n", i, length - 1);
      statements += fmt::format("  V{} := {};\n", i, vector(length));
      offer(fmt::format("V{}", i), length);
    }
    for (std::size_t i = 0; i < pick(4); ++i) {
      write_sized(fmt::format("G{}", i), declarations, statements);
    }
  }

  /// A loop over rows begins at three elements, one over the terms of a sum at nine: sizes below and above both.
  std::size_t length_from(std::size_t least) {
    constexpr std::size_t short_one = 6;
    return pick(5) == 0 ? short_one + 1 + pick(longest_vector - short_one) : least + pick(short_one + 1 - least);
  }

  void write_sized(const std::string& name, std::string& declarations, std::string& statements) {
    const std::size_t n = length_from(1);
    const std::size_t m = length_from(1);
    const std::size_t p = length_from(1);
    const auto input = [&](std::size_t length) { return length == 1 ? source(Type::Real) : vector(length); };
    const std::string reset = pick(2) == 0 ? fmt::format(", R1 := {}", source(Type::Bool)) : "";
    switch (pick(5)) {
      case 0:
        declarations +=
            fmt::format("    {} : HY_MATRIX_GAIN := (K := {}, ROWS := {});\n", name, numbers(p * m, 2.0), p);
        statements += fmt::format("  {}(XIN := {});\n", name, input(m));
        return offer(name + ".XOUT", p);
      case 1:
        declarations +=
            fmt::format("    {} : HY_STATE_SPACE := (A := {}, B := {}, C := {}{}{});\n", name, numbers(n * n, 0.5),
                        numbers(n * m, 1.0), numbers(p * n, 1.0), pick(2) == 0 ? ", D := " + numbers(p * m, 1.0) : "",
                        pick(2) == 0 ? ", X0 := " + numbers(n, 1.0) : "");
        statements += fmt::format("  {}(U := {}{});\n", name, input(m), reset);
        offer(name + ".X", n);
        return offer(name + ".Y", p);
      default: {
        const std::string_view kind = std::vector{"", "_S", "_ZOH"}[pick(3)];
        std::string den = "[1.0";
        for (std::size_t i = 0; i < n; ++i) {
          den += fmt::format(", {:.6f}", kind.empty() ? 0.5 * unit() - 0.25 : 10.0 * unit());
        }
        declarations += fmt::format("    {} : HY_TRANSFER_FUNCTION{} := (NUM := {}, DEN := {}]);\n", name, kind,
                                    numbers(1 + pick(n + 1), 2.0), den);
        statements += fmt::format("  {}(XIN := {}{});\n", name, source(Type::Real), reset);
        return offer(name + ".XOUT", 1);
      }
    }
  }

  void write(int instances) {
    const auto types = block_types();
    std::string declarations;
    std::string statements;
    std::string late;
    sources_[static_cast<std::size_t>(Type::Real)] = {"X1", "X2", "X3"};
    sources_[static_cast<std::size_t>(Type::Bool)] = {"B1", "B2"};
    sources_[static_cast<std::size_t>(Type::Int)] = {"N1"};
    if (words_.types) {
      sources_[static_cast<std::size_t>(Type::Word)] = {"W1"};
    }
    for (int i = 0; i < 3; ++i) {  // feedback
      declarations += fmt::format("    Z{} : HY_DELAY;\n", i);
      sources_[static_cast<std::size_t>(Type::Real)].push_back(fmt::format("Z{}.XOUT", i));
    }
    for (int i = 0; i < instances; ++i) {
      const BlockType& type = types[pick(types.size())];
      if (words_.rates && !type.about.rate_transition && pick(6) == 0) {
        write_slow(fmt::format("I{}", i), type, declarations, statements);
        continue;
      }
      declarations += fmt::format("    I{} : {}{};\n", i, type.about.name, settings_of(type));
      std::vector<std::string> arguments;
      for (const Field& input : type.inputs) {
        if (input.required || pick(3) != 0) {
          arguments.push_back(fmt::format("{} := {}", input.name, source(input.type)));
        }
      }
      statements += fmt::format("  I{}({});\n", i, fmt::join(arguments, ", "));
      for (const Field& output : type.outputs) {
        if (output.type != Type::Word || words_.types) {
          sources_[static_cast<std::size_t>(output.type)].push_back(fmt::format("I{}.{}", i, output.name));
        }
      }
    }
    if (words_.vectors) {
      offer("XV", 3);
      for (const std::string_view element : {"BV[0]", "BV[1]"}) {
        sources_[static_cast<std::size_t>(Type::Bool)].emplace_back(element);
      }
      write_vectors(declarations, statements);
      late += fmt::format("  YV := {};\n  YW := {};\n", vector(3), vector(2));
    }
    for (int i = 0; i < 3; ++i) {
      // Bounded, so that feedback does not run away to infinity at once.
      late += fmt::format("  Z{}(XIN := LIMIT(-10.0, {}, 10.0));\n", i, source(Type::Real));
    }
    std::string outputs;
    for (int i = 0; i < 4; ++i) {
      outputs += fmt::format("    Y{} : LREAL;\n", i);
      late += fmt::format("  Y{} := {};\n", i, source(Type::Real));
    }
    const std::string truth = source(Type::Bool);
    const std::string integer = source(Type::Int);
    text_ = fmt::format(
        "FUNCTION_BLOCK {} (* @ts 1ms *)\n  VAR_INPUT\n    X1, X2, X3 : LREAL;\n    B1, B2 : BOOL;\n    N1 : DINT;\n  "
        "{}{}END_VAR\n  VAR_OUTPUT\n{}    Q : BOOL;\n    N : DINT;\n{}{}  END_VAR\n  VAR\n{}  END_VAR\n{}{}  Q := "
        "{};\n  N "
        ":= {};\n{}END_FUNCTION_BLOCK\n",
        name_, words_.types ? "  W1 : WORD;\n  " : "",
        words_.vectors ? "  XV : ARRAY[0..2] OF LREAL;\n    BV : ARRAY[0..1] OF BOOL;\n  " : "", outputs,
        words_.types ? "    W : WORD;\n" : "",
        words_.vectors ? "    YV : ARRAY[0..2] OF LREAL;\n    YW : ARRAY[0..1] OF LREAL;\n" : "", declarations,
        statements, late, truth, integer, words_.types ? fmt::format("  W := {};\n", source(Type::Word)) : "");
  }

  std::mt19937_64 engine_;
  std::string name_;
  RandomWords words_;
  std::string text_;
  std::array<std::vector<std::string>, 4> sources_;
  static constexpr std::size_t longest_vector = 13;
  std::array<std::vector<std::string>, longest_vector + 1> vectors_;  ///< by length
};

}  // namespace hysteron::testing
