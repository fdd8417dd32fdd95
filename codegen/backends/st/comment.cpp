#include "codegen/backends/st/comment.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "support/numbers.hpp"

namespace hysteron {
namespace {

struct SignInAscii {
  std::string_view sign;
  std::string_view text;
};

constexpr std::array signs_in_ascii{
    SignInAscii{"(*", "( *"},  SignInAscii{"*)", "* )"}, SignInAscii{"]]>", "]] >"}, SignInAscii{"\r", " "},
    SignInAscii{"µ", "u"},     SignInAscii{"μ", "u"},    SignInAscii{"·", "*"},      SignInAscii{"×", "x"},
    SignInAscii{"²", "^2"},    SignInAscii{"³", "^3"},   SignInAscii{"°", "deg"},    SignInAscii{"±", "+-"},
    SignInAscii{"−", "-"},     SignInAscii{"–", "-"},    SignInAscii{"—", "-"},      SignInAscii{"→", "->"},
    SignInAscii{"≤", "<="},    SignInAscii{"≥", ">="},   SignInAscii{"≠", "<>"},     SignInAscii{"…", "..."},
    SignInAscii{"√", "sqrt "}, SignInAscii{"π", "pi"},   SignInAscii{"τ", "tau"},    SignInAscii{"Δ", "d"},
    SignInAscii{"½", "1/2"},   SignInAscii{"Ω", "Ohm"},  SignInAscii{"’", "'"},      SignInAscii{"∞", "infinity"},
};

}  // namespace

std::string st_comment(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const SignInAscii* found = nullptr;
    for (const SignInAscii& one : signs_in_ascii) {
      if (text.substr(at).starts_with(one.sign)) {
        found = &one;
        break;
      }
    }
    if (found != nullptr) {
      result += found->text;
      at += found->sign.size();
    } else if (static_cast<unsigned char>(text[at]) < 0x80) {
      result += text[at++];
    } else {
      result += '?';
      do {
        ++at;
      } while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U);
    }
  }
  // "(" and "*" may have met by a replacement, and so may "*" and ")".
  for (std::size_t at = 0; (at = result.find_first_of("(*", at)) != std::string::npos; ++at) {
    if (result.compare(at, 2, "(*") == 0 || result.compare(at, 2, "*)") == 0) {
      result.insert(at + 1, " ");
    }
  }
  return result;
}

std::string st_remark(std::string_view unit, double minimum, double maximum, bool above_minimum,
                      std::string_view meaning) {
  std::string text;
  const auto part = [&](const std::string& words) { text += (text.empty() ? "" : " ") + words; };
  if (!unit.empty() && unit.find('\'') == std::string_view::npos) {
    part(fmt::format("[{}]", unit));
  }
  const bool low = std::isfinite(minimum);
  const bool high = std::isfinite(maximum);
  if (low && high) {
    part(fmt::format("{}{} to {}", above_minimum ? "above " : "", number_text(minimum), number_text(maximum)));
  } else if (low) {
    part(fmt::format("{} {}", above_minimum ? "above" : "at least", number_text(minimum)));
  } else if (high) {
    part(fmt::format("at most {}", number_text(maximum)));
  }
  if (!meaning.empty()) {
    text += (low || high ? "; " : text.empty() ? "" : " ") + std::string(meaning);
  }
  for (char& letter : text) {
    letter = letter == '\n' || letter == '\r' ? ' ' : letter;
  }
  return text;
}

}  // namespace hysteron
