// Which names of a file are vectors, and of what length: variables, pins of blocks of one's own, pins of blocks of the
// library whose sizes the instance says.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/language/syntax.hpp"

namespace hysteron {

struct PinShape {
  std::uint32_t length = 0;  ///< 0: one value
  std::int64_t low = 0;      ///< the index of the first element; other than 0 at the border of a sequential body
  bool list = false;         ///< a parameter that takes its numbers as a list
};

class VectorPins {
 public:
  using Report = std::function<void(int, language::Span, std::string, std::string)>;

  /// The borders of sequential bodies are read at once.
  VectorPins(const language::SourceFile& source, Report report);

  void declare(const language::FunctionBlock& block, const language::Variable& variable, std::uint32_t length);
  /// Finds the sizes of the block's instances of the library. Reports HY224.
  void declare_sized(const language::FunctionBlock& block);

  /// One value for a name that is not known.
  [[nodiscard]] PinShape variable(const language::FunctionBlock& block, std::string_view name) const;
  /// Of an input, a parameter or an output of an instance; none where the block is known and the pin is not.
  [[nodiscard]] std::optional<PinShape> pin(const language::FunctionBlock& block, const language::Variable& instance,
                                            std::string_view pin) const;
  /// The type of an instance with its sizes, HY_STATE_SPACE[2,1,1,0]; empty for other variables.
  [[nodiscard]] std::string_view sized_type(const language::FunctionBlock& block, std::string_view name) const;
  /// Whether an argument says a size and is no pin.
  [[nodiscard]] static bool is_setting(const language::Variable& instance, std::string_view pin);

 private:
  using Shapes = std::map<std::string, PinShape>;  ///< by name in upper case
  void read_border(const language::FunctionBlock& block);
  [[nodiscard]] std::optional<std::vector<double>> numbers_of(language::ExpressionId id) const;

  const language::SourceFile& source_;
  Report report_;
  std::map<std::string, Shapes> shapes_{};  ///< by block
  std::map<std::pair<std::string, std::string>, std::string> sized_{};
};

}  // namespace hysteron
