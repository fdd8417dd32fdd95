// The values of expressions over vectors: one expression, or one for each element. Inside of vectors.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/vector_pins.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron {

/// A value: one expression, or one for each element.
struct Elements {
  std::vector<language::ExpressionId> elements{};
  bool vector = false;
  bool unknown = false;  ///< a name in it is not declared: it goes everywhere, and who looks for the name says so
  [[nodiscard]] language::ExpressionId at(std::size_t i) const { return vector ? elements[i] : elements.front(); }
};

class VectorValues {
 public:
  using Report = VectorPins::Report;

  /// New expressions and names are put into the file, which is a copy of what was written.
  VectorValues(const language::SourceFile& written, language::SourceFile& file, const VectorPins& pins, Report report)
      : written_(written), file_(file), pins_(pins), error_(std::move(report)) {}

  /// Names mean those of this block from now on.
  void enter(const language::FunctionBlock& block) { block_ = &block; }
  [[nodiscard]] const language::FunctionBlock& block() const { return *block_; }

  /// The value for a place of a shape; none where an error was reported.
  [[nodiscard]] std::optional<Elements> fitting(language::ExpressionId id, const PinShape& shape,
                                                const std::string& target);
  /// The place of an element within its vector, from 0; none where an error was reported. `named` may have a dot.
  [[nodiscard]] std::optional<std::uint32_t> index(language::ExpressionId id, const PinShape& shape,
                                                   std::string_view named);
  /// A constant that may name the constants of the block.
  [[nodiscard]] bool whole_constant(language::ExpressionId id, std::int64_t& value);

  [[nodiscard]] std::string_view keep(std::string text) { return file_.names->emplace_back(std::move(text)); }
  [[nodiscard]] language::Name element(const language::Name& vector, std::size_t index);
  /// The variable of the block by its name; null where none is declared.
  [[nodiscard]] const language::Variable* find_variable(std::string_view name) const;
  [[nodiscard]] language::Span span_of(language::ExpressionId id) const { return file_.expressions[id].span; }

 private:
  using Binary = language::Binary;
  using ExpressionId = language::ExpressionId;
  using Span = language::Span;

  std::optional<Elements> value(ExpressionId id);
  std::optional<Elements> value_of(const language::Reference& reference, ExpressionId id);
  std::optional<Elements> value_of(const Binary& binary, Span span, ExpressionId id);
  std::optional<Elements> value_of(const language::FunctionCall& call, Span span, ExpressionId id);
  std::optional<Elements> reduced(const std::string& name, const language::FunctionCall& call,
                                  const std::vector<Elements>& values, Span span);
  std::optional<Elements> sizes_differ(std::size_t a, std::size_t b, Span span);
  template <class Make>
  std::optional<Elements> each(const std::vector<Elements>& operands, Span span, ExpressionId id, Make make_one);
  ExpressionId make(language::Expression expression);

  const language::SourceFile& written_;
  language::SourceFile& file_;
  const VectorPins& pins_;
  Report error_;
  const language::FunctionBlock* block_ = nullptr;
};

}  // namespace hysteron
