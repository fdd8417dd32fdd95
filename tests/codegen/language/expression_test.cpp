// Expressions: precedence held against a second implementation (Dijkstra's shunting yard, on the text), and the
// values of literals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "codegen/language/syntax.hpp"
#include "tests/codegen/language/dump.hpp"

namespace hysteron::test {
namespace {

using language::Operator;

language::SourceFile parse_expression(const std::string& text) {
  Diagnostics diagnostics;
  auto file = language::parse("test.st", "FUNCTION_BLOCK F\nY := " + text + ";\nEND_FUNCTION_BLOCK", diagnostics);
  for (const auto& one : diagnostics.all()) {
    ADD_FAILURE() << text << "\n" << one.place.column << ": " << one.cause;
  }
  return file;
}

language::ExpressionId root(const language::SourceFile& file) {
  return std::get<language::Assignment>(file.blocks.at(0).statements.at(0)).value;
}

std::string expression_tree(const std::string& text) {
  const auto file = parse_expression(text);
  return Dump(file).expression(root(file));
}

/// All operators on numbers, so that any mix of them has a value.
double apply(const std::string& sign, double a, double b) {
  const auto truth = [](bool condition) { return condition ? 1.0 : 0.0; };
  static const std::map<std::string, int> codes{{"+", 0},  {"-", 1},   {"*", 2},    {"/", 3},   {"MOD", 4},
                                                {"**", 5}, {"<", 6},   {"<=", 7},   {">", 8},   {">=", 9},
                                                {"=", 10}, {"<>", 11}, {"AND", 12}, {"OR", 13}, {"XOR", 14}};
  switch (codes.at(sign)) {
    case 0:
      return a + b;
    case 1:
      return a - b;
    case 2:
      return a * b;
    case 3:
      return a / b;
    case 4:
      return std::fmod(a, b);
    case 5:
      return std::pow(a, b);
    case 6:
      return truth(a < b);
    case 7:
      return truth(a <= b);
    case 8:
      return truth(a > b);
    case 9:
      return truth(a >= b);
    case 10:
      return truth(a == b);
    case 11:
      return truth(a != b);
    case 12:
      return truth(a != 0.0 && b != 0.0);
    case 13:
      return truth(a != 0.0 || b != 0.0);
    default:
      return truth((a != 0.0) != (b != 0.0));
  }
}

double value_of_tree(const language::SourceFile& file, language::ExpressionId id) {
  const auto& node = file.expressions.at(id).node;
  if (const auto* real = std::get_if<language::RealLiteral>(&node)) {
    return real->value;
  }
  if (const auto* unary = std::get_if<language::Unary>(&node)) {
    const double value = value_of_tree(file, unary->operand);
    return unary->op == Operator::Negate ? -value : (value == 0.0 ? 1.0 : 0.0);
  }
  const auto& binary = std::get<language::Binary>(node);
  return apply(std::string(sign_of(binary.op)), value_of_tree(file, binary.left), value_of_tree(file, binary.right));
}

/// IEC 61131-3:2013, table 71.
int strength(const std::string& sign) {
  static const std::map<std::string, int> table{{"neg", 9}, {"NOT", 9}, {"**", 8},  {"*", 7},   {"/", 7}, {"MOD", 7},
                                                {"+", 6},   {"-", 6},   {"<", 5},   {"<=", 5},  {">", 5}, {">=", 5},
                                                {"=", 4},   {"<>", 4},  {"AND", 3}, {"XOR", 2}, {"OR", 1}};
  return table.at(sign);
}

double value_by_shunting_yard(const std::vector<std::string>& tokens) {
  std::vector<double> values;
  std::vector<std::string> signs;
  const auto reduce = [&] {
    const auto sign = signs.back();
    signs.pop_back();
    const double b = values.back();
    if (sign == "neg" || sign == "NOT") {
      values.back() = sign == "neg" ? -b : (b == 0.0 ? 1.0 : 0.0);
      return;
    }
    values.pop_back();
    values.back() = apply(sign, values.back(), b);
  };
  bool expects_value = true;
  for (const auto& token : tokens) {
    if (token == "(") {
      signs.push_back(token);
    } else if (token == ")") {
      while (signs.back() != "(") {
        reduce();
      }
      signs.pop_back();
    } else if (std::isdigit(static_cast<unsigned char>(token[0])) != 0) {
      values.push_back(std::stod(token));
      expects_value = false;
    } else if (expects_value) {
      signs.push_back(token == "-" ? "neg" : token);
    } else {
      while (!signs.empty() && signs.back() != "(" && strength(signs.back()) >= strength(token)) {
        reduce();
      }
      signs.push_back(token);
      expects_value = true;
    }
  }
  while (!signs.empty()) {
    reduce();
  }
  return values.at(0);
}

class RandomExpression {
 public:
  explicit RandomExpression(std::uint32_t seed) : random_(seed) {}

  std::vector<std::string> next() {
    tokens_.clear();
    chain(3);
    return tokens_;
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

  void chain(int depth) {
    static const std::vector<std::string> signs{
        "+", "-", "*", "/", "MOD", "**", "<", "<=", ">", ">=", "=", "<>", "AND", "OR", "XOR"};
    for (auto left = 1 + below(5); left > 0; --left) {
      const bool is_signed = operand(depth);
      if (left > 1) {
        // -A ** B is refused, so no power behind a sign.
        const std::string& sign = signs[below(static_cast<std::uint32_t>(signs.size()))];
        tokens_.push_back(is_signed && sign == "**" ? "*" : sign);
      }
    }
  }

  bool operand(int depth) {
    const auto kind = below(6);
    if (kind < 2) {
      tokens_.emplace_back(kind == 0 ? "-" : "NOT");
    }
    if (depth > 0 && below(4) == 0) {
      tokens_.emplace_back("(");
      chain(depth - 1);
      tokens_.emplace_back(")");
    } else {
      tokens_.push_back(std::to_string(below(4)) + "." + std::to_string(below(2) * 5));
    }
    return kind < 2;
  }

  std::mt19937 random_;
  std::vector<std::string> tokens_;
};

TEST(Expression, PrecedenceIsThatOfASecondEvaluator) {
  RandomExpression random(1);
  for (int round = 0; round < 5000; ++round) {
    const auto tokens = random.next();
    std::string text;
    for (const auto& token : tokens) {
      text += token == "AND" && round % 2 == 0 ? "& " : token + " ";
    }
    const auto file = parse_expression(text);
    const double ours = value_of_tree(file, root(file));
    const double theirs = value_by_shunting_yard(tokens);
    const bool both_nan = std::isnan(ours) && std::isnan(theirs);
    ASSERT_TRUE(both_nan || std::bit_cast<std::uint64_t>(ours) == std::bit_cast<std::uint64_t>(theirs))
        << text << "\n"
        << ours << " " << theirs;
  }
}

TEST(Expression, TreesOfTheStandard) {
  EXPECT_EQ(expression_tree("A + B * C ** D"), "(A + (B * (C ** D)))");
  EXPECT_EQ(expression_tree("A ** B ** C"), "((A ** B) ** C)");
  EXPECT_EQ(expression_tree("A - B - C"), "((A - B) - C)");
  EXPECT_EQ(expression_tree("A / B * C MOD D"), "(((A / B) * C) MOD D)");
  EXPECT_EQ(expression_tree("-A * B"), "((- A) * B)");
  EXPECT_EQ(expression_tree("A ** -B"), "(A ** (- B))");
  EXPECT_EQ(expression_tree("A - -B"), "(A - (- B))");
  EXPECT_EQ(expression_tree("NOT A = B"), "((NOT A) = B)");
  EXPECT_EQ(expression_tree("A OR B XOR C AND D"), "(A OR (B XOR (C AND D)))");
  EXPECT_EQ(expression_tree("a or b Xor c & d"), "(a OR (b XOR (c AND d)))");
  EXPECT_EQ(expression_tree("A = B < C"), "(A = (B < C))");
  EXPECT_EQ(expression_tree("A + 1.0 >= B AND C <> D"), "(((A + 1r) >= B) AND (C <> D))");
  EXPECT_EQ(expression_tree("(A + B) * C"), "((A + B) * C)");
  EXPECT_EQ(expression_tree("MAX(A, -B.XOUT, SIN(0.5)) + 1.0"), "(MAX(A, (- B.XOUT), SIN(0.5r)) + 1r)");
  EXPECT_EQ(expression_tree("LIMIT(MN := 0.0, IN := A = B, MX := 1.0)"), "LIMIT(MN := 0r, IN := (A = B), MX := 1r)");
  EXPECT_EQ(expression_tree("F()"), "F()");
}

TEST(Expression, Literals) {
  EXPECT_EQ(expression_tree("42"), "42i");
  EXPECT_EQ(expression_tree("1_000"), "1000i");
  EXPECT_EQ(expression_tree("16#Ff"), "255i");
  EXPECT_EQ(expression_tree("16#7FFF_FFFF"), "2147483647i");
  EXPECT_EQ(expression_tree("8#17"), "15i");
  EXPECT_EQ(expression_tree("2#1010_0001"), "161i");
  EXPECT_EQ(expression_tree("2147483647"), "2147483647i");
  EXPECT_EQ(expression_tree("-2147483648"), "-2147483648i");
  EXPECT_EQ(expression_tree("-5"), "(- 5i)");
  EXPECT_EQ(expression_tree("DINT#3"), "3i");
  EXPECT_EQ(expression_tree("dint#-2147483648"), "-2147483648i");
  EXPECT_EQ(expression_tree("DINT#16#FF"), "255i");
  EXPECT_EQ(expression_tree("WORD#16#FFFF"), "65535w");
  EXPECT_EQ(expression_tree("TRUE"), "TRUE");
  EXPECT_EQ(expression_tree("false"), "FALSE");
  EXPECT_EQ(expression_tree("BOOL#TRUE"), "TRUE");
  EXPECT_EQ(expression_tree("bool#0"), "FALSE");
}

double real(const std::string& text) {
  const auto file = parse_expression(text);
  return std::get<language::RealLiteral>(file.expressions.at(root(file)).node).value;
}

TEST(Expression, RealLiteralsAreReadToTheNearestDouble) {
  EXPECT_EQ(real("1.0"), 1.0);
  EXPECT_EQ(real("0.1"), 0.1);
  EXPECT_EQ(real("1.5e-6"), 1.5e-6);
  EXPECT_EQ(real("1.5E+06"), 1.5e6);
  EXPECT_EQ(real("1_000.000_1"), 1000.0001);
  EXPECT_EQ(real("2.45e-11"), 2.45e-11);
  EXPECT_EQ(real("4.9e-324"), 4.9e-324);
  EXPECT_EQ(real("1.7976931348623157e308"), 1.7976931348623157e308);
  EXPECT_EQ(real("LREAL#1.0"), 1.0);
  EXPECT_EQ(real("LREAL#-2"), -2.0);
  EXPECT_EQ(real("LREAL#+2.5e3"), 2500.0);
  EXPECT_EQ(real("9007199254740993.0"), 9007199254740992.0);
}

TEST(Expression, SpansCoverWhatWasWritten) {
  const auto file = parse_expression("A + (B * C)");
  const auto& sum = file.expressions.at(root(file));
  const auto text = [&](language::Span span) { return file.text_of(span); };
  EXPECT_EQ(text(sum.span), "A + (B * C)");
  const auto& binary = std::get<language::Binary>(sum.node);
  EXPECT_EQ(text(file.expressions.at(binary.left).span), "A");
  EXPECT_EQ(text(file.expressions.at(binary.right).span), "(B * C)");
}

}  // namespace
}  // namespace hysteron::test
