// The parser: recursive descent over blocks, sections and statements, precedence climbing over expressions.
//
// After an error it goes on behind the next semicolon, or at the next END_… or VAR…, so that one slip is one message
// and every statement is read. What recursion there is is bounded by deepest_expression, which also bounds the
// height of every tree that is handed on: who walks a tree may recurse.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/language/annotation.hpp"
#include "codegen/language/body_blocks.hpp"
#include "codegen/language/lexer.hpp"
#include "codegen/language/literal.hpp"
#include "codegen/language/reporter.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron::language {

inline constexpr std::uint32_t deepest_expression = 256;
inline constexpr int highest_bit = 15;  ///< of a WORD

class Parser {
 public:
  Parser(SourceFile& file, Reporter& reporter);

  void read_file();

 private:
  // Blocks and sections: parser.cpp.
  void outside();
  void function_block();
  /// A part of a file with sequential bodies: it is read as such, and a block that a diagram can say as one, too.
  void part_with_body(const TextPart& part, body::Library& library);
  void section(FunctionBlock& block);
  void declaration(FunctionBlock& block, Section section);
  bool declared_names();
  bool declared_type(Variable& variable);
  bool vector_type(Variable& variable);
  bool initial_value(ExpressionId& initial, std::vector<Argument>& settings);

  // Statements: parse_statement.cpp.
  void statement(FunctionBlock& block);
  bool named_statement(FunctionBlock& block);
  bool call(FunctionBlock& block);
  bool assignment(FunctionBlock& block);
  bool element_assignment(FunctionBlock& block);
  bool assigned_value(FunctionBlock& block, Assignment assignment, std::uint32_t begin);
  bool bit_assignment();
  void refuse_bit_assignment(Span span, std::string_view name, std::string_view digits);
  bool pin_assignment(const FunctionBlock& block);
  void control();
  bool arguments(std::vector<Argument>& list);

  // Expressions: parse_expression.cpp. no_expression says that an error was reported and the rest has no meaning.
  ExpressionId expression() { return binary(0); }
  ExpressionId binary(int weakest);
  ExpressionId operand();
  ExpressionId unary();
  ExpressionId primary(bool behind_minus);
  ExpressionId parenthesized();
  ExpressionId reference();
  [[nodiscard]] bool is_bit() const;
  [[nodiscard]] static int bit_number(std::string_view digits);
  ExpressionId without_bit(ExpressionId value);
  ExpressionId bit_of(ExpressionId word, std::uint32_t begin);
  /// `[2]` behind a name; no_expression where there is none. False where an error was reported.
  bool index(ExpressionId& index);
  ExpressionId function_call();
  ExpressionId literal(bool behind_minus);
  ExpressionId array();
  bool function_argument(std::vector<FunctionArgument>& list);
  ExpressionId make(Expression expression, std::uint32_t height, std::uint32_t chain = 0);
  /// `chain`: of so many operators in a row that there need not be any brackets.
  bool too_deep(std::uint32_t depth, Span span, std::uint32_t chain = 0);

  // Tokens.
  [[nodiscard]] const Token& now() const { return window_[0]; }
  [[nodiscard]] const Token& ahead(std::size_t n) const { return window_[n]; }
  void advance();
  [[nodiscard]] bool is(Symbol symbol) const { return now().symbol == symbol; }
  [[nodiscard]] bool is(Keyword keyword) const { return now().keyword == keyword; }
  bool accept(Symbol symbol);
  bool expect(Symbol symbol, std::string_view wanted);
  bool expect_name(Name& name, std::string_view wanted);
  bool expect_semicolon();
  [[nodiscard]] bool is_decimal_comma();
  void recover();
  [[nodiscard]] bool starts_section() const;
  [[nodiscard]] bool ends_block() const;

  // Messages.
  [[nodiscard]] std::string_view text_of(Span span) const { return text_.substr(span.offset, span.length); }
  [[nodiscard]] static Span span_of(const Token& token) { return {token.offset, token.length}; }
  [[nodiscard]] Span since(std::uint32_t offset) const { return {offset, last_.end() - offset}; }
  [[nodiscard]] Name name_of(const Token& token) const { return {text_of(span_of(token)), span_of(token)}; }
  [[nodiscard]] std::string described(const Token& token) const;
  void unexpected(std::string_view wanted, std::string mend);
  void missing_end(Span opening, std::string cause, std::string mend);
  bool keyword_for_name(std::string_view wanted);
  void error(int number, Span span, std::string cause, std::string mend);

  SourceFile& file_;
  std::string_view text_;
  Reporter& reporter_;
  Lexer lexer_;
  std::array<Token, 3> window_{};
  Token last_{};  ///< the token before now()
  std::uint32_t depth_ = 0;
  std::vector<std::uint16_t> heights_;  ///< of the tree below each expression
  std::vector<Declaration> declarations_;
  std::vector<Name> names_;      ///< of the declaration at hand
  std::vector<TextPart> parts_;  ///< of a file with sequential bodies
  std::vector<Comment> bodies_comments_;
};

}  // namespace hysteron::language
