// The parser of sequential bodies, with the types and functions beside them: recursive descent, its own tokens.
//
// What a body may not have (a pointer, a method, a string) is refused by name where it stands,
// and reading goes on behind it, so that every line that stands in the way is told, each once.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/language/annotation.hpp"
#include "codegen/language/binary_sign.hpp"
#include "codegen/language/body.hpp"
#include "codegen/language/lexer.hpp"
#include "codegen/language/reporter.hpp"

namespace hysteron::language {

class BodyParser {
 public:
  /// Reads the stretch of the file's text from `begin` to `end`.
  BodyParser(const SourceFile& file, body::Library& library, Reporter& reporter, std::uint32_t begin,
             std::uint32_t end);

  void types();
  /// VAR_GLOBAL CONSTANT … END_VAR, beside the blocks.
  void globals();
  body::Unit function();
  /// A FUNCTION_BLOCK; `block` gets its name and variables, `declarations` where each stands.
  body::Unit block(FunctionBlock& block, std::size_t index, std::vector<Declaration>& declarations);
  [[nodiscard]] const std::vector<Comment>& comments() const { return lexer_.comments(); }

 private:
  // Declarations: body_declarations.cpp.
  void sections(body::Unit& unit, FunctionBlock* block, std::size_t index, std::vector<Declaration>* declarations);
  void section(body::Unit& unit, FunctionBlock* block, std::size_t index, std::vector<Declaration>* declarations);
  bool declaration(body::Role role, std::vector<body::Declaration>& list);
  void declaration_or_nothing(body::Role role, std::vector<body::Declaration>& list);
  void end_section();
  bool type(body::TypeSpec& spec);
  bool array_type(body::TypeSpec& spec);
  bool bounds(body::Label& one);
  bool upper_bound(body::Label& one);
  bool enumeration(body::TypeSpec& spec);
  bool structure(body::TypeSpec& spec);
  bool initial(body::Initial& value);
  bool element(body::Initial& list);
  [[nodiscard]] bool starts_section() const;
  [[nodiscard]] bool is_shared_section() const;
  void declared_once(const std::vector<body::Declaration>& list);
  void defined_once(const Name& name);
  void twice(const Name& name);

  // Statements: body_parser.cpp.
  void statements(body::Statements& list);
  void rounds(body::Statements& list);
  void statement(body::Statements& list);
  bool if_statement(body::If& node);
  bool case_statement(body::Case& node);
  bool label(body::Label& one);
  bool starts_label() const;
  bool for_statement(body::For& node);
  bool while_statement(body::Loop& node);
  bool repeat_statement(body::Loop& node);
  bool named(body::Statement& statement);
  void skip_statement();
  void skip_to(std::string_view closing);
  bool end_with(std::string_view closing);
  [[nodiscard]] bool ends_list() const;
  void finish(body::Unit& unit, std::string_view end);

  // Expressions: body_expressions.cpp. no_expression says that an error was reported.
  ExpressionId expression() { return binary(0); }
  ExpressionId binary(int weakest);
  [[nodiscard]] BinarySign sign_of(const Token& token) const;
  ExpressionId unary();
  ExpressionId primary();
  ExpressionId number();
  ExpressionId typed();
  bool access(body::Access& access);
  bool arguments(std::vector<body::Argument>& list);
  ExpressionId make(body::Expression expression);

  // Tokens.
  void advance();
  [[nodiscard]] const Token& now() const { return window_[0]; }
  [[nodiscard]] const Token& ahead(std::size_t n = 1) const { return window_[n]; }
  [[nodiscard]] std::string_view word(const Token& token) const { return text_.substr(token.offset, token.length); }
  [[nodiscard]] bool is(Symbol symbol) const { return now().symbol == symbol; }
  [[nodiscard]] bool is(std::string_view keyword) const;
  bool accept(Symbol symbol);
  bool accept(std::string_view keyword);
  bool expect(Symbol symbol, std::string_view wanted);
  bool expect(std::string_view keyword);
  bool name(Name& name, std::string_view wanted);
  bool end_of_statement();
  [[nodiscard]] static Span span_of(const Token& token) { return {token.offset, token.length}; }
  [[nodiscard]] Span since(std::uint32_t offset) const { return {offset, last_end_ - offset}; }
  bool unexpected(std::string_view wanted);
  bool refuse(Span span, std::string cause, std::string mend);

  std::string_view text_;
  body::Library& library_;
  Reporter& reporter_;
  Lexer lexer_;
  std::uint32_t end_;
  std::array<Token, 5> window_{};
  std::uint32_t last_end_ = 0;
  int depth_ = 0;
  int loops_ = 0;  ///< around the statement that is read
};

}  // namespace hysteron::language
