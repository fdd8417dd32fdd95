// Statements of those operations that would stop a PLC, each with its guard.
#include <fmt/format.h>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/writer.hpp"

namespace hysteron {

/// By 0, a number with the sign of the numerator that is as large as can be; 0 / 0 is 0. By a parameter that is
/// infinite, a 0 with the sign of the numerator.
void StWriter::define_quotient(const Value& value, const std::string& name, std::string& text) {
  const std::string above = printer_.text(value.args[0], Strength::Primary);
  const std::string below = printer_.text(value.args[1], Strength::Primary);
  const std::string zero = printer_.zero();
  std::string largest;
  std::string lowest;
  printer_.print_largest(false, Strength::Loosest, largest);
  printer_.print_largest(true, Strength::Loosest, lowest);
  std::string positive;
  printer_.print_call("SEL", {"G", "IN0", "IN1"}, {above + " > " + zero, zero, largest}, positive);
  std::string limit;
  if (const Value& numerator = routine.tape[value.args[0]]; numerator.op == Op::RealLiteral) {
    limit = numerator.literal > 0.0 ? largest : numerator.literal < 0.0 ? lowest : zero;
  } else {
    printer_.print_call("SEL", {"G", "IN0", "IN1"}, {above + " < " + zero, positive, lowest}, limit);
  }
  if (const Value& divisor = routine.tape[value.args[1]]; divisor.op == Op::RealLiteral && divisor.literal == 0.0) {
    append(text, fmt::format("{} := {};\n", name, limit));  // MATIEC refuses a division by a literal 0
    return;
  }
  std::string begin = "IF";
  if (printer_.guards().may_be_infinite(value.args[1])) {
    append(text, fmt::format("IF {} >= {} THEN {} := {} * {};\n", below, largest, name, zero, above));
    begin = std::string(indentation) + "ELSIF";
  }
  append(text, fmt::format("{4} {2} <> {3} THEN {0} := {1} / {2};\n", name, above, below, zero, begin));
  line(fmt::format("ELSE {} := {}; END_IF;", name, limit), text);
}

/// By 0 it is 0; by −1 the lowest DINT would leave its range.
void StWriter::define_integer_quotient(const Value& value, const std::string& name, std::string& text) {
  const std::string above = printer_.text(value.args[0], Strength::Primary);
  const std::string below = printer_.text(value.args[1], Strength::Primary);
  const bool quotient = value.op == Op::IntDivide;
  if (const Value& divisor = routine.tape[value.args[1]]; divisor.op == Op::IntLiteral && divisor.literal == 0.0) {
    append(text, fmt::format("{} := 0;\n", name));  // MATIEC refuses a division by a literal 0
    return;
  }
  append(text, fmt::format("IF {} = 0 THEN {} := 0;\n", below, name));
  line(fmt::format("ELSIF {} = -1 THEN {} := {};", below, name, quotient ? "0 - " + above : "0"), text);
  line(fmt::format("ELSE {} := {} {} {}; END_IF;", name, above, quotient ? "/" : "MOD", below), text);
}

/// A literal exponent below 0.
void StWriter::define_power(const Value& value, const std::string& name, std::string& text) {
  if (printer_.guards().power_form(value) == PowerForm::Any) {
    return define_power_of_any(value, name, text);
  }
  const bool whole = printer_.guards().power_form(value) == PowerForm::NonZero;
  const std::string base = printer_.text(value.args[0], Strength::Primary);
  const std::string exponent = st_typed_literal(st_type(Type::Real, printer_.float32()),
                                                printer_.literal(Type::Real, routine.tape[value.args[1]].literal));
  std::string power;
  printer_.print_power(base, exponent, power);
  std::string largest;
  printer_.print_largest(false, Strength::Loosest, largest);
  append(text, fmt::format("IF {} {} {} THEN {} := {};\n", base, whole ? "<>" : ">", printer_.zero(), name, power));
  line(fmt::format("ELSE {} := {}; END_IF;", name, largest), text);
}

/// The exponents 1, 2, 1/2 and 0 have a path of their own in every target, so that bits agree.
void StWriter::define_power_of_any(const Value& value, const std::string& name, std::string& text) {
  const std::string base = printer_.text(value.args[0], Strength::Primary);
  const std::string exponent = printer_.text(value.args[1], Strength::Primary);
  const auto real = [&](std::string_view digits) { return printer_.real(digits); };
  const std::string zero = printer_.zero();
  const bool never_negative = printer_.guards().never_negative(value.args[0]);
  std::string power;
  printer_.print_power(base, exponent, power);
  std::string root = base;
  if (!never_negative) {
    root.clear();
    printer_.print_call("MAX", {"IN1", "IN2"}, {base, zero}, root);
  }
  std::string largest;
  printer_.print_largest(false, Strength::Loosest, largest);
  std::string of_zero;
  printer_.print_call("SEL", {"G", "IN0", "IN1"}, {exponent + " > " + zero, largest, zero}, of_zero);

  append(text, fmt::format("IF {} = {} THEN {} := {};\n", exponent, real("1.0"), name, base));
  line(fmt::format("ELSIF {1} = {2} THEN {0} := {3} * {3};", name, exponent, real("2.0"), base), text);
  line(fmt::format("ELSIF {1} = {2} THEN {0} := SQRT({3});", name, exponent, real("0.5"), root), text);
  line(fmt::format("ELSIF {1} = {2} THEN {0} := {3};", name, exponent, zero, real("1.0")), text);
  line(fmt::format("ELSIF {1} > {2} THEN {0} := {3};", name, base, zero, power), text);
  if (!never_negative) {  // a number below 0 has powers of whole exponents only; beyond 2^31 they are not tried
    line(fmt::format("ELSIF {1} < {2} THEN {0} := {2};", name, base, zero), text);
    line(fmt::format("  IF ABS({}) < {} THEN", exponent, real("2147483648.0")), text);
    line(fmt::format("    IF {0}({1}({2})) = {2} THEN {3} := {4}; END_IF;",
                     printer_.float32() ? "DINT_TO_REAL" : "DINT_TO_LREAL",
                     printer_.float32() ? "REAL_TO_DINT" : "LREAL_TO_DINT", exponent, name, power),
         text);
    line("  END_IF;", text);
  }
  line(fmt::format("ELSE {} := {}; END_IF;", name, of_zero), text);
}

/// Towards zero; saturated at the ends of DINT, and 0 for what is not a number.
void StWriter::define_integer(const Value& value, const std::string& name, std::string& text) {
  const std::string real = printer_.text(value.args[0], Strength::Primary);
  append(text, fmt::format("IF {} >= {} THEN {} := 2147483647;\n", real, printer_.real("2147483648.0"), name));
  line(fmt::format("ELSIF {1} > ({2}) THEN {0} := TRUNC({1});", name, real, printer_.real("-2147483648.0")), text);
  line(fmt::format("ELSIF {1} = {1} THEN {0} := -2147483647 - 1;", name, real), text);
  line(fmt::format("ELSE {} := 0; END_IF;", name), text);
}

}  // namespace hysteron
