// Random inputs and parameters for any block, from its description. Numbers of a structure stand in the order of its
// fields, arrays in full, as double whatever their type is.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "blocks/description.hpp"

namespace hysteron::testing {

/// Random values within the ranges of fields. A given seed gives the same values on every machine.
class RandomIo {
 public:
  /// `ts` scales the times: a field in seconds lies within some 30 samples.
  explicit RandomIo(std::uint64_t seed, double ts) : engine_(seed), ts_(ts) {}

  /// Between 0 and 1, never either.
  double unit() { return (static_cast<double>(engine_() >> 12U) + 0.5) * 0x1p-52; }

  /// A number for every field, in its range. Truth values stand at their preset nine times in ten, so that a reset does
  /// not happen in every other step. Arrays rise.
  std::vector<double> numbers(std::span<const Field> fields) {
    std::vector<double> result;
    for (const Field& field : fields) {
      append(field, result);
    }
    return result;
  }

 private:
  void append(const Field& field, std::vector<double>& result) {
    if (field.length > 1) {
      double value = -1.0;
      for (std::size_t i = 0; i < field.length; ++i) {
        value += 0.01 + unit();
        result.push_back(value);
      }
    } else if (field.type == Type::Bool) {
      const bool usual = field.required ? unit() < 0.5 : field.preset != 0.0;
      result.push_back((unit() < 0.9 ? usual : !usual) ? 1.0 : 0.0);
    } else if (field.type == Type::Real) {
      result.push_back(real(field));
    } else {
      const double low = std::max(field.minimum, field.type == Type::Word ? 0.0 : -10.0);
      const double high = std::max(low, std::min(field.maximum, 50.0));
      result.push_back(std::trunc(low + std::floor(unit() * (high - low + 1.0))));
    }
  }
  double real(const Field& field) {
    const double reach = field.unit == "s" ? 30.0 * ts_ : 10.0;
    const double low = std::isfinite(field.minimum) ? field.minimum : std::min(-reach, field.maximum - reach);
    const double high = std::isfinite(field.maximum) ? field.maximum : std::max(reach, low + reach);
    return low + unit() * (high - low);
  }

  std::mt19937_64 engine_;
  double ts_;
};

/// Every field at its preset.
inline std::vector<double> preset_numbers(std::span<const Field> fields) {
  std::vector<double> result;
  for (const Field& field : fields) {
    result.insert(result.end(), field.length, field.preset);
  }
  return result;
}

/// Where the number of each field stands, or that of its first element; behind the last, how many numbers there are.
inline std::vector<std::size_t> places(std::span<const Field> fields) {
  std::vector<std::size_t> result{0};
  for (const Field& field : fields) {
    result.push_back(result.back() + field.length);
  }
  return result;
}

/// Where the number of a real field of this name stands, if there is such a field.
inline std::optional<std::size_t> real_place(std::span<const Field> fields, std::string_view name) {
  const auto at = places(fields);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == name && fields[i].type == Type::Real && fields[i].length == 1) {
      return at[i];
    }
  }
  return std::nullopt;
}

/// Sets every field that has a neutral setting to it; says how many there are.
inline int neutralise(std::span<const Field> fields, std::vector<double>& numbers) {
  int count = 0;
  const auto at = places(fields);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].length == 1 && fields[i].has_neutral()) {
      numbers[at[i]] = fields[i].neutral;
      ++count;
    }
  }
  return count;
}

/// Equal vectors are equal numbers, to the bit.
inline std::vector<std::uint64_t> bits(std::span<const double> numbers) {
  std::vector<std::uint64_t> result(numbers.size());
  std::ranges::transform(numbers, result.begin(), [](double x) { return std::bit_cast<std::uint64_t>(x); });
  return result;
}

}  // namespace hysteron::testing
