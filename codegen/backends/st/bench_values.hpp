// What goes into a test and what is expected of it, by step, as statements of a bench.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/st/bench.hpp"
#include "codegen/backends/st/dialect.hpp"
#include "codegen/backends/st/pou.hpp"

namespace hysteron {

/// A variable that an input is set by.
struct BenchTarget {
  std::string target;
  Type type = Type::Real;
  bool float32 = false;
};

class BenchValues {
 public:
  BenchValues(const StDialect& dialect, Identifiers& names) : dialect_(dialect), names_(names) {}

  /// A variable of the block in its body.
  [[nodiscard]] std::string local(std::string_view name) const {
    return std::string(dialect_.local_prefix).append(name);
  }
  [[nodiscard]] std::string real(double value) const;
  [[nodiscard]] std::string value(Type type, double value, bool float32) const;

  /// A variable that is declared, as the body calls it.
  std::string declare(std::string_view name, std::string type, std::uint32_t count, std::string remark,
                      std::vector<std::string> values = {});
  [[nodiscard]] std::vector<StVariable> take_declared() { return std::exchange(declared_, {}); }

  void write_input(const BenchTarget& to, const std::vector<double>& values, std::string_view array, std::string& text);
  void write_expectation(std::size_t slot, const StExpectation& expected, std::size_t steps, std::string_view array,
                         std::string& text);

 private:
  std::string array_of(std::string_view name, Type type, bool float32, const std::vector<double>& values);

  const StDialect& dialect_;
  Identifiers& names_;
  std::vector<StVariable> declared_;
};

}  // namespace hysteron
