#include "codegen/backends/cpp_helpers.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace hysteron {
namespace {

struct Helper {
  std::string_view name;
  std::string_view text;
};
constexpr std::array helpers{
    Helper{"detail::power(", R"(// base^exponent; the common exponents have a path of their own.
inline Real power(Real base, Real exponent) noexcept {
  if (exponent == Real(1)) {
    return base;
  }
  if (exponent == Real(0.5)) {
    return std::sqrt(base);
  }
  if (exponent == Real(2)) {
    return base * base;
  }
  if (exponent == Real(0)) {
    return Real(1);
  }
  return std::pow(base, exponent);
}
)"},
    Helper{"detail::min(", R"(template <class T>
T min(T a, T b) noexcept {
  return b < a ? b : a;
}
)"},
    Helper{"detail::max(", R"(template <class T>
T max(T a, T b) noexcept {
  return b > a ? b : a;
}
)"},
    Helper{"detail::to_int(", R"(// Towards zero; saturates at the ends, 0 for not-a-number.
inline std::int32_t to_int(Real x) noexcept {
  if (!(x > Real(-2147483648.0))) {
    return x != x ? 0 : std::numeric_limits<std::int32_t>::min();
  }
  return x < Real(2147483648.0) ? static_cast<std::int32_t>(x) : std::numeric_limits<std::int32_t>::max();
}
)"},
    Helper{"detail::at(", R"(template <std::size_t N>
const Real& at(const std::array<Real, N>& array, std::int32_t index) noexcept {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  return array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))];
}
)"},
    Helper{"detail::store(", R"(template <std::size_t N>
void store(std::array<Real, N>& array, std::int32_t index, Real value) noexcept {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))] = value;
}
)"},
    Helper{"detail::wrap(", R"(// DINT wraps at its ends; a division by zero gives 0.
inline std::int32_t wrap(std::int64_t x) noexcept { return static_cast<std::int32_t>(static_cast<std::uint32_t>(x)); }
)"},
    Helper{"detail::add(",
           "inline std::int32_t add(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} + b); }\n"},
    Helper{"detail::subtract(",
           "inline std::int32_t subtract(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} - b); "
           "}\n"},
    Helper{"detail::multiply(",
           "inline std::int32_t multiply(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} * b); "
           "}\n"},
    Helper{"detail::divide(",
           "inline std::int32_t divide(std::int32_t a, std::int32_t b) noexcept { return b == 0 ? 0 : "
           "wrap(std::int64_t{a} / b); }\n"},
    Helper{"detail::modulo(",
           "inline std::int32_t modulo(std::int32_t a, std::int32_t b) noexcept { return b == 0 ? 0 : "
           "wrap(std::int64_t{a} % b); }\n"},
    Helper{"detail::negate(",
           "inline std::int32_t negate(std::int32_t a) noexcept { return wrap(-std::int64_t{a}); }\n"},
};

}  // namespace

std::string cpp_helper_functions(const std::string& body) {
  // One pass: the body of a long diagram is long.
  std::set<std::string_view> called;
  constexpr std::string_view scope = "detail::";
  for (auto at = body.find(scope); at != std::string::npos; at = body.find(scope, at + scope.size())) {
    called.insert(std::string_view(body).substr(at, body.find('(', at) + 1 - at));
  }
  const bool wraps = std::ranges::any_of(helpers, [&](const Helper& one) {
    return one.text.find(" wrap(") != std::string_view::npos && called.contains(one.name);
  });
  if (wraps) {
    called.insert("detail::wrap(");
  }
  std::string text;
  for (const Helper& helper : helpers) {
    if (called.contains(helper.name)) {
      text += std::string(helper.text) + "\n";
    }
  }
  return text.empty() ? text : "namespace detail {\n\n" + text + "}  // namespace detail\n\n";
}

}  // namespace hysteron
