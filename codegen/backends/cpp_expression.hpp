// Expressions in the spelling of C++, with the brackets that keep the order of rounding.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/routine.hpp"

namespace hysteron {

/// A member `group.name` of Params, State or In; of the diagram itself where there is no group. It names identifiers
/// that live elsewhere.
struct CppMember {
  std::string_view group{};
  std::string_view name{};
};

/// Prints the values of a routine's tape. A value that has a name is its name.
class CppExpressions {
 public:
  CppExpressions(const Routine& routine, std::int64_t base_ns, bool float32)
      : tape_(routine.tape), base_ns_(base_ns), float32_(float32), name_of_(tape_.size(), 0) {}

  /// The members that leaves are, by their index.
  std::vector<CppMember> parameters{};
  std::vector<CppMember> cells{};
  std::vector<std::string_view> inputs{};

  void name(ValueId id, std::string_view name) {
    names_.push_back(name);
    name_of_[id] = static_cast<std::uint32_t>(names_.size());
  }
  [[nodiscard]] bool is_named(ValueId id) const { return name_of_[id] != 0; }

  /// Appends a value's text.
  void print(ValueId id, std::string& out) const { print(id, 0, out); }
  static void print_cell(const CppMember& cell, std::string& out);
  [[nodiscard]] std::string literal(Type type, double value) const;

 private:
  void print(ValueId id, int outer, std::string& out) const;
  void binary(const Value& value, std::string_view spelled, int strength, int outer, std::string& out) const;
  void call(const Value& value, std::string_view function, std::size_t arity, std::string& out) const;

  const Tape& tape_;
  std::int64_t base_ns_;  ///< sample time of the diagram
  bool float32_;
  std::vector<std::uint32_t> name_of_;  ///< by value: 0, or one more than its place in names_
  std::vector<std::string_view> names_;
};

std::string_view cpp_type(Type type);

}  // namespace hysteron
