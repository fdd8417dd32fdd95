// Expressions in the spelling of C++, with the brackets that keep the order of rounding.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codegen/backends/routine.hpp"

namespace hysteron {

/// Prints the values of a routine's tape. A value that has a name is its name.
class CppExpressions {
 public:
  CppExpressions(const Routine& routine, bool float32) : tape_(routine.tape), float32_(float32), names_(tape_.size()) {}

  void name(ValueId id, std::string text) { names_[id] = std::move(text); }
  [[nodiscard]] bool is_named(ValueId id) const { return !names_[id].empty(); }
  /// The text of a leaf: a parameter, cell or input by its index.
  std::vector<std::string> parameters{};
  std::vector<std::string> cells{};
  std::vector<std::string> inputs{};
  std::int64_t base_ns = 0;  ///< sample time of the diagram

  [[nodiscard]] std::string text(ValueId id) const;
  [[nodiscard]] std::string literal(Type type, double value) const;

 private:
  void print(ValueId id, int outer, std::string& out) const;
  void binary(const Value& value, std::string_view spelled, int strength, int outer, std::string& out) const;
  void call(const Value& value, std::string_view function, std::size_t arity, std::string& out) const;

  const Tape& tape_;
  bool float32_;
  std::vector<std::string> names_;
};

std::string_view cpp_type(Type type);

}  // namespace hysteron
