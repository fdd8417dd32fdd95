// Operations on the bits of integers and of WORDs in Structured Text, with as few conversions as there can be.
#include <fmt/format.h>

#include <cstdint>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/printer.hpp"

namespace hysteron {

/// The bits of an integer, as a DWORD. What operations on bits make of others stays a DWORD between them.
std::string StPrinter::pattern(ValueId id) const {
  const Value& value = tape()[id];
  if (is_integer(id)) {
    return fmt::format("DWORD#16#{:08X}", static_cast<std::uint32_t>(static_cast<std::int32_t>(value.literal)));
  }
  const bool is_inside = !is_named(id);
  if (is_inside && (value.op == Op::IntAnd || value.op == Op::IntOr || value.op == Op::IntXor)) {
    return "(" + bits_text(value) + ")";
  }
  if (is_inside && (value.op == Op::IntShiftLeft || value.op == Op::IntShiftRight)) {
    return bits_text(value);
  }
  return "DINT_TO_DWORD(" + argument(id) + ")";
}

/// An operation on the bits of integers, as a DWORD.
std::string StPrinter::bits_text(const Value& value) const {
  const ValueId first = value.args[0];
  const ValueId second = value.args[1];
  switch (value.op) {
    case Op::IntAnd:
      return pattern(first) + " AND " + pattern(second);
    case Op::IntOr:
      return pattern(first) + " OR " + pattern(second);
    case Op::IntXor:
      if (is_integer(second) && tape()[second].literal == -1.0) {
        return "NOT " + pattern(first);
      }
      return pattern(first) + " XOR " + pattern(second);
    default: {
      std::string shifted;
      print_call(value.op == Op::IntShiftLeft ? "SHL" : "SHR", {"IN", "N"}, {pattern(first), text(second)}, shifted);
      return shifted;
    }
  }
}

/// Whether an integer is the number of a WORD that the text can name: of a WORD, or a literal.
bool StPrinter::is_word(ValueId id) const {
  const Value& value = tape()[id];
  constexpr double largest_word = 65535.0;
  return (value.op == Op::WordToInt && !is_named(id)) ||
         (is_integer(id) && value.literal >= 0.0 && value.literal <= largest_word);
}

/// The lower 16 bits of an integer, as a WORD: by operations on WORDs as far as these are the same.
void StPrinter::print_as_word(ValueId id, int outer, std::string& out) const {
  constexpr double bits_of_word = 16.0;
  const Value& value = tape()[id];
  if (value.op == Op::WordToInt && !is_named(id)) {
    return print(value.args[0], outer, out);
  }
  if (is_integer(id)) {
    return append(out, literal(Type::Word, static_cast<std::uint16_t>(static_cast<std::int32_t>(value.literal))));
  }
  const bool logic = value.op == Op::IntAnd || value.op == Op::IntOr || value.op == Op::IntXor;
  if (logic && !is_named(id)) {
    return print_bits(value, outer, out);
  }
  const bool shift =
      value.op == Op::IntShiftLeft || (value.op == Op::IntShiftRight && is_word(value.args[0]));  // no bit comes in
  if (shift && !is_named(id) && tape()[value.args[1]].literal < bits_of_word) {
    std::string word;
    print_as_word(value.args[0], Strength::Loosest, word);
    return print_call(value.op == Op::IntShiftLeft ? "SHL" : "SHR", {"IN", "N"}, {word, text(value.args[1])}, out);
  }
  append(out, "DWORD_TO_WORD(", pattern(id), " AND DWORD#16#0000FFFF)");  // some compilers saturate
}

/// AND, OR and XOR of two WORDs, and NOT as what turns every bit.
void StPrinter::print_bits(const Value& value, int outer, std::string& out) const {
  constexpr double every_bit = 65535.0;
  if (value.op == Op::IntXor && is_integer(value.args[1]) && tape()[value.args[1]].literal == every_bit) {
    std::string turned;
    print_as_word(value.args[0], Strength::Primary, turned);
    const bool twice = turned.starts_with("NOT ");
    return append(out, twice ? "NOT (" : "NOT ", turned, twice ? ")" : "");
  }
  const bool brackets = outer > Strength::Loosest;
  out += brackets ? "(" : "";
  print_as_word(value.args[0], Strength::Primary, out);
  out += value.op == Op::IntAnd ? " AND " : (value.op == Op::IntOr ? " OR " : " XOR ");
  print_as_word(value.args[1], Strength::Primary, out);
  out += brackets ? ")" : "";
}

/// Of two WORDs, as WORDs where the text would convert one of them.
void StPrinter::print_comparison(const Value& value, int outer, std::string& out) const {
  const bool words = is_word(value.args[0]) && is_word(value.args[1]) &&
                     (tape()[value.args[0]].op == Op::WordToInt || tape()[value.args[1]].op == Op::WordToInt);
  const bool brackets = outer >= Strength::Equality;
  out += brackets ? "(" : "";
  const auto side = [&](ValueId id) {
    words ? print_as_word(id, Strength::Primary, out) : print(id, Strength::Equality + 1, out);
  };
  side(value.args[0]);
  out += value.op == Op::IntEqual ? " = " : " <> ";
  side(value.args[1]);
  out += brackets ? ")" : "";
}

}  // namespace hysteron
