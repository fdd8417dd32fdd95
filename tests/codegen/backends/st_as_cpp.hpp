// Generated Structured Text as C++, token by token, so that a test can compile and run it: the precedence of operators
// is the same in both, but for XOR, whose operands stand in brackets or alone.
#pragma once

#include <cctype>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::testing {

/// Before the first block: the types and functions of IEC 61131-3 that generated text uses.
inline constexpr std::string_view st_prelude = R"(#include <array>
#include <cmath>
#include <cstdint>
#include <cfenv>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>
using LREAL = double;
using REAL = float;
using DINT = std::int32_t;
using BOOL = bool;
template <class Bits>
struct Pattern {  // AND, OR and NOT are written as those of truth values
  Bits bits = 0;
  friend Pattern operator&&(Pattern a, Pattern b) { return {Bits(a.bits & b.bits)}; }
  friend Pattern operator||(Pattern a, Pattern b) { return {Bits(a.bits | b.bits)}; }
  friend Pattern operator^(Pattern a, Pattern b) { return {Bits(a.bits ^ b.bits)}; }
  friend Pattern operator!(Pattern a) { return {Bits(~a.bits)}; }
  friend bool operator==(Pattern a, Pattern b) { return a.bits == b.bits; }
  friend Pattern SHL(Pattern x, int places) { return {Bits(x.bits << places)}; }
  friend Pattern SHR(Pattern x, int places) { return {Bits(x.bits >> places)}; }
};
using WORD = Pattern<std::uint16_t>;
using DWORD = Pattern<std::uint32_t>;
inline DWORD DINT_TO_DWORD(DINT x) { return {static_cast<std::uint32_t>(x)}; }
inline DINT DWORD_TO_DINT(DWORD x) { return static_cast<DINT>(x.bits); }
inline WORD DWORD_TO_WORD(DWORD x) { return {static_cast<std::uint16_t>(x.bits)}; }
inline DINT WORD_TO_DINT(WORD x) { return x.bits; }
inline REAL LREAL_TO_REAL(LREAL x) { return static_cast<REAL>(x); }
inline LREAL REAL_TO_LREAL(REAL x) { return x; }
template <class T> T MIN(T a, T b) { return b < a ? b : a; }
template <class T> T MAX(T a, T b) { return b > a ? b : a; }
template <class T> T LIMIT(T low, T x, T high) { return MIN(MAX(x, low), high); }
template <class T> T SEL(bool g, T in0, T in1) { return g ? in1 : in0; }
template <class T> T EXPT(T base, T exponent) { return std::pow(base, exponent); }
template <class T> T ABS(T x) { return std::fabs(x); }
template <class T> T SQRT(T x) { if (x < 0) { std::fputs("SQRT below 0\n", stderr); std::exit(3); } return std::sqrt(x); }
template <class T> T LN(T x) { if (x <= 0) { std::fputs("LN at 0\n", stderr); std::exit(3); } return std::log(x); }
template <class T> T EXP(T x) { return std::exp(x); }
template <class T> T SIN(T x) { return std::sin(x); }
template <class T> T COS(T x) { return std::cos(x); }
template <class T> T TAN(T x) { return std::tan(x); }
template <class T> T ASIN(T x) { return std::asin(x); }
template <class T> T ACOS(T x) { return std::acos(x); }
template <class T> T ATAN(T x) { return std::atan(x); }
template <class T> DINT TRUNC(T x) { return static_cast<DINT>(x); }
inline LREAL DINT_TO_LREAL(DINT x) { return x; }
inline REAL DINT_TO_REAL(DINT x) { return static_cast<REAL>(x); }
inline DINT LREAL_TO_DINT(LREAL x) { return static_cast<DINT>(std::lrint(x)); }
inline DINT REAL_TO_DINT(REAL x) { return static_cast<DINT>(std::lrint(x)); }
)";

class StAsCpp {
 public:
  explicit StAsCpp(std::string_view text) { scan(text); }

  /// A structure with the variables of the block as members and its body as `void call()`.
  std::string translated() {
    expect("FUNCTION_BLOCK");
    std::string text = "struct " + take() + " {\n";
    while (peek().starts_with("VAR")) {
      take();
      if (peek() == "CONSTANT") {
        take();
      }
      while (peek() != "END_VAR") {
        text += declaration();
      }
      take();
    }
    text += "void call() {\n";
    while (peek() != "END_FUNCTION_BLOCK") {
      text += in_cpp(take());
    }
    return text + "}\n};\n";
  }

  [[nodiscard]] std::vector<std::string> tokens() const { return tokens_; }

 private:
  static bool is_word(char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_'; }

  void scan(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      if (text.substr(at).starts_with("(*")) {
        at = text.find("*)", at) + 2;
      } else if (std::isspace(static_cast<unsigned char>(text[at])) != 0) {
        ++at;
      } else if (is_word(text[at])) {
        const std::size_t begin = at;
        bool number = std::isdigit(static_cast<unsigned char>(text[at])) != 0;
        for (; at < text.size(); ++at) {
          const char letter = text[at];
          number = number || letter == '#';
          const bool point = number && letter == '.' && text[at + 1] != '.';
          const bool sign = (letter == '-' || letter == '+') && number && (text[at - 1] == '#' || text[at - 1] == 'E');
          if (!is_word(letter) && letter != '#' && !point && !sign) {
            break;
          }
        }
        tokens_.emplace_back(text.substr(begin, at - begin));
      } else {
        std::size_t length = 1;
        for (const std::string_view two : {":=", "<>", "<=", ">=", "..", "**"}) {
          length = text.substr(at).starts_with(two) ? 2 : length;
        }
        tokens_.emplace_back(text.substr(at, length));
        at += length;
      }
    }
  }
  [[nodiscard]] const std::string& peek() const { return tokens_.at(at_); }
  std::string take() { return tokens_.at(at_++); }
  void expect(std::string_view what) {
    if (take() != what) {
      throw std::runtime_error("no " + std::string(what) + " but " + tokens_.at(at_ - 1));
    }
  }

  std::string declaration() {
    std::vector<std::string> names{take()};
    while (peek() == ",") {
      take();
      names.push_back(take());
    }
    expect(":");
    std::string type = take();
    if (type == "ARRAY") {
      expect("[");
      expect("0");
      expect("..");
      const std::string last = take();
      expect("]");
      expect("OF");
      type = "std::array<" + take() + ", " + last + " + 1>";
    }
    std::string value;
    if (peek() == ":=") {
      take();
      while (peek() != ";") {
        const std::string token = take();
        value += token == "[" ? "{" : token == "]" ? "}" : in_cpp(token);
      }
    }
    expect(";");
    std::string text;
    for (const std::string& name : names) {
      text += type + " " + name + "{" + value + "};\n";
    }
    return text;
  }

  /// REAL#0.1 is REAL(0.1); a plain literal with a point is of the type of its neighbours, which is LREAL here.
  static std::string literal(const std::string& token) {
    const auto hash = token.find('#');
    if (hash == std::string::npos) {
      return token;
    }
    if (token.starts_with("WORD#16#")) {
      return "WORD{0x" + token.substr(8) + "}";
    }
    if (token.starts_with("DWORD#16#")) {
      return "DWORD{0x" + token.substr(9) + "}";
    }
    return token.substr(0, hash) + "(" + token.substr(hash + 1) + ")";
  }

  std::string in_cpp(const std::string& token) {
    static const std::map<std::string, std::string> words{
        {":=", "="},     {"=", "=="},      {"<>", "!="},         {"AND", "&&"},
        {"OR", "||"},    {"XOR", "^"},     {"NOT", "!"},         {"MOD", "%"},
        {"IF", "if ("},  {"THEN", ") {"},  {"ELSE", "} else {"}, {"ELSIF", "} else if ("},
        {"END_IF", "}"}, {"END_FOR", "}"}, {"TRUE", "true"},     {"FALSE", "false"},
        {";", ";\n"}};
    if (token == "FOR") {
      const std::string name = take();
      expect(":=");
      std::string first = take();
      expect("TO");
      std::string last = take();
      expect("DO");
      return "for (" + name + " = " + first + "; " + name + " <= " + last + "; ++" + name + ") {\n";
    }
    const auto found = words.find(token);
    return (found != words.end() ? found->second : literal(token)) + " ";
  }

  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
};

}  // namespace hysteron::testing
