#include "codegen/graph/unit.hpp"

#include <fmt/format.h>

#include <charconv>

namespace hysteron::units {
namespace {

constexpr double radians_in_a_cycle = 2 * 3.14159265358979323846;

struct Symbol {
  std::string_view name;
  double factor;
  std::array<int, std::tuple_size_v<Powers>> powers;  // m kg s A K degC mol cd, rad, cycles
  bool prefixes;
};
constexpr std::array symbols{
    Symbol{"m", 1, {1}, true},
    Symbol{"g", 1e-3, {0, 1}, true},
    Symbol{"s", 1, {0, 0, 1}, true},
    Symbol{"A", 1, {0, 0, 0, 1}, true},
    Symbol{"K", 1, {0, 0, 0, 0, 1}, true},
    Symbol{"degC", 1, {0, 0, 0, 0, 0, 1}, false},
    Symbol{"°C", 1, {0, 0, 0, 0, 0, 1}, false},
    Symbol{"mol", 1, {0, 0, 0, 0, 0, 0, 1}, true},
    Symbol{"cd", 1, {0, 0, 0, 0, 0, 0, 0, 1}, true},
    Symbol{"N", 1, {1, 1, -2}, true},
    Symbol{"Pa", 1, {-1, 1, -2}, true},
    Symbol{"bar", 1e5, {-1, 1, -2}, true},
    Symbol{"J", 1, {2, 1, -2}, true},
    Symbol{"W", 1, {2, 1, -3}, true},
    Symbol{"C", 1, {0, 0, 1, 1}, true},
    Symbol{"V", 1, {2, 1, -3, -1}, true},
    Symbol{"F", 1, {-2, -1, 4, 2}, true},
    Symbol{"Ohm", 1, {2, 1, -3, -2}, true},
    Symbol{"Ω", 1, {2, 1, -3, -2}, true},
    Symbol{"S", 1, {-2, -1, 3, 2}, true},
    Symbol{"Wb", 1, {2, 1, -2, -1}, true},
    Symbol{"T", 1, {0, 1, -2, -1}, true},
    Symbol{"H", 1, {2, 1, -2, -2}, true},
    Symbol{"Hz", 1, {0, 0, -1, 0, 0, 0, 0, 0, 0, 1}, true},
    Symbol{"L", 1e-3, {3}, true},
    Symbol{"l", 1e-3, {3}, true},
    Symbol{"min", 60, {0, 0, 1}, false},
    Symbol{"h", 3600, {0, 0, 1}, false},
    Symbol{"d", 86400, {0, 0, 1}, false},
    Symbol{"rpm", radians_in_a_cycle / 60, {0, 0, -1, 0, 0, 0, 0, 0, 1}, false},
    Symbol{"rad", 1, {0, 0, 0, 0, 0, 0, 0, 0, 1}, true},
    Symbol{"deg", radians_in_a_cycle / 360, {0, 0, 0, 0, 0, 0, 0, 0, 1}, false},
    Symbol{"rev", radians_in_a_cycle, {0, 0, 0, 0, 0, 0, 0, 0, 1}, false},
    Symbol{"%", 1e-2, {}, false},
    Symbol{"ppm", 1e-6, {}, false},
    Symbol{"count", 1, {}, false},
    Symbol{"LSB", 1, {}, false},
};

struct Prefix {
  std::string_view name;
  double factor;
};
constexpr std::array prefixes{Prefix{"f", 1e-15}, Prefix{"p", 1e-12}, Prefix{"n", 1e-9}, Prefix{"u", 1e-6},
                              Prefix{"µ", 1e-6},  Prefix{"μ", 1e-6},  Prefix{"m", 1e-3}, Prefix{"c", 1e-2},
                              Prefix{"d", 1e-1},  Prefix{"h", 1e2},   Prefix{"k", 1e3},  Prefix{"M", 1e6},
                              Prefix{"G", 1e9},   Prefix{"T", 1e12}};

Unit unit_of(const Symbol& symbol, double factor, std::string_view written) {
  Unit unit;
  unit.symbols.emplace_back(written, Fraction{1, 1});
  unit.factor = symbol.factor * factor;
  for (std::size_t i = 0; i < unit.powers.size(); ++i) {
    unit.powers[i] = {symbol.powers[i], 1};
  }
  return unit;
}

std::optional<Unit> find_symbol(std::string_view name) {
  for (const Symbol& symbol : symbols) {
    if (symbol.name == name) {
      return unit_of(symbol, 1.0, name);
    }
  }
  for (const Prefix& prefix : prefixes) {
    if (name.starts_with(prefix.name)) {
      for (const Symbol& symbol : symbols) {
        if (symbol.prefixes && symbol.name == name.substr(prefix.name.size())) {
          return unit_of(symbol, prefix.factor, name);
        }
      }
    }
  }
  return std::nullopt;
}

/// Reads `um/V`, `'y/'x`, `kg*m^2/s^2`, `'x^(1/2)`, `1/(m*K)`.
class Parser {
 public:
  Parser(std::string_view text, const UnitVariable& variable) : text_(text), variable_(variable) {}

  std::optional<Unit> parse(std::string& reason) {
    std::optional<Unit> unit = product(0);
    if (unit && at_ != text_.size()) {
      fail(fmt::format("'{}' is left over", text_.substr(at_)));
    }
    reason = reason_;
    return reason_.empty() ? unit : std::nullopt;
  }

 private:
  void fail(std::string reason) {
    if (reason_.empty()) {
      reason_ = std::move(reason);
    }
  }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') {
      ++at_;
    }
  }
  bool take(std::string_view token) {
    skip();
    if (!text_.substr(at_).starts_with(token)) {
      return false;
    }
    at_ += token.size();
    skip();
    return true;
  }

  std::optional<Unit> product(int depth) {
    std::optional<Unit> result = power(depth);
    while (result) {
      const bool times = take("*") || take("·");
      if (!times && !take("/")) {
        break;
      }
      const auto next = power(depth);
      if (!next) {
        return std::nullopt;
      }
      result->multiply(*next, {times ? 1 : -1, 1});
    }
    return result;
  }

  std::optional<Unit> power(int depth) {
    std::optional<Unit> base = factor(depth);
    if (!base) {
      return base;
    }
    std::optional<Fraction> exponent;
    if (take("^")) {
      exponent = exponent_of();
    } else if (take("²")) {
      exponent = Fraction{2, 1};
    } else if (take("³")) {
      exponent = Fraction{3, 1};
    } else {
      return base;
    }
    if (!exponent) {
      fail("an exponent is a whole number or a fraction in brackets: m^2, m^(1/2)");
      return std::nullopt;
    }
    Unit result;
    result.multiply(*base, *exponent);
    return result;
  }

  // Byte by byte would not do: °, µ, · and the superscripts begin with the same one.
  [[nodiscard]] bool at_separator() const {
    const std::string_view rest = text_.substr(at_);
    for (const std::string_view separator : {"*", "/", "^", "(", ")", " ", "·", "²", "³"}) {
      if (rest.starts_with(separator)) {
        return true;
      }
    }
    return false;
  }

  std::optional<Fraction> exponent_of() {
    const bool bracket = take("(");
    const auto over = whole();
    if (!over) {
      return std::nullopt;
    }
    Fraction result{*over, 1};
    if (bracket) {
      if (take("/")) {
        const auto under = whole();
        if (!under || *under == 0) {
          return std::nullopt;
        }
        result = Fraction::of(*over, *under);
      }
      if (!take(")")) {
        return std::nullopt;
      }
    }
    return result;
  }

  std::optional<std::int32_t> whole() {
    std::int32_t value = 0;
    const auto [end, problem] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (problem != std::errc{} || std::abs(value) > 24) {
      return std::nullopt;
    }
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  std::optional<Unit> factor(int depth) {
    if (take("(")) {
      auto inner = depth < 16 ? product(depth + 1) : std::nullopt;
      if (!inner || !take(")")) {
        fail("a bracket is not closed");
        return std::nullopt;
      }
      return inner;
    }
    if (take("1")) {
      return Unit{};
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !at_separator()) {
      ++at_;
    }
    const std::string_view name = text_.substr(begin, at_ - begin);
    if (name.empty()) {
      fail("a symbol is missing");
      return std::nullopt;
    }
    if (name.front() == '\'' && variable_) {
      Unit unit;
      unit.add_variable(variable_(name.substr(1)), {1, 1});
      return unit;
    }
    auto found = find_symbol(name);
    if (!found) {
      fail(fmt::format("the symbol '{}' is not known", name));
    }
    return found;
  }

  std::string_view text_;
  const UnitVariable& variable_;
  std::size_t at_ = 0;
  std::string reason_{};
};

}  // namespace

std::optional<Unit> parse_unit(std::string_view text, std::string& reason, const UnitVariable& variable) {
  return Parser(text, variable).parse(reason);
}

std::optional<double> conversion(const Unit& from, const Unit& to) {
  if (!from.same_dimension(to)) {
    return std::nullopt;
  }
  const auto more = [&](std::size_t mark) { return from.powers[mark].number() - to.powers[mark].number(); };
  const double surplus = more(cycles);
  const double lack = -more(radians);
  const double exchanged = surplus * lack <= 0.0 ? 0.0 : std::abs(surplus) < std::abs(lack) ? surplus : lack;
  return from.factor / to.factor * std::pow(radians_in_a_cycle, exchanged);
}

std::string unit_text(const Unit& unit) {
  std::string over;
  std::string under;
  for (const auto& [symbol, power] : unit.symbols) {
    std::string& side = power.over < 0 ? under : over;
    const auto size = std::abs(power.over);
    side += side.empty() ? "" : "*";
    side += symbol;
    if (power.under != 1) {
      side += fmt::format("^({}/{})", size, power.under);
    } else if (size != 1) {
      side += fmt::format("^{}", size);
    }
  }
  std::string text = over.empty() ? "1" : over;
  if (!under.empty()) {
    text += under.find('*') == std::string::npos ? "/" + under : "/(" + under + ")";
  }
  return text;
}

}  // namespace hysteron::units
