#include "codegen/backends/st/shape.hpp"

#include <fmt/format.h>

#include "codegen/backends/st/declarations.hpp"
#include "support/sha256.hpp"

namespace hysteron {
namespace {

/// A GUID that is the same for the same name: a project then knows the object that it has.
std::string identity(std::string_view name) {
  const std::string digits = sha256(fmt::format("hysteron {}", name));
  return fmt::format("{}-{}-4{}-8{}-{}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 3),
                     digits.substr(15, 3), digits.substr(18, 12));
}

}  // namespace

std::string st_text(const StPou& block, StDialect::Shape shape, std::string_view mark) {
  const bool siemens = shape == StDialect::Shape::Source;
  const std::string declaration =
      block.head +
      (siemens ? fmt::format("FUNCTION_BLOCK \"{}\"\n{{ S7_Optimized_Access := 'TRUE' }}\nVERSION : 0.1\n", block.name)
               : fmt::format("FUNCTION_BLOCK {}{}\n", block.name, mark)) +
      st_declarations(block.sections);
  switch (shape) {
    case StDialect::Shape::OneFile:
      return declaration + "\n" + block.body + "END_FUNCTION_BLOCK\n";
    case StDialect::Shape::TwoPanes:
      return declaration + "\n(* ---- above: the declaration; below: the body ---- *)\n\n" + block.body;
    case StDialect::Shape::Source:
      return declaration + "BEGIN\n" + block.body + "END_FUNCTION_BLOCK\n";
    case StDialect::Shape::Object:
      return fmt::format(
          R"(<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1">
  <POU Name="{}" Id="{{{}}}" SpecialFunc="None">
    <Declaration><![CDATA[{}]]></Declaration>
    <Implementation>
      <ST><![CDATA[{}]]></ST>
    </Implementation>
  </POU>
</TcPlcObject>
)",
          block.name, identity(block.name), declaration, block.body);
  }
  return "";
}

std::string st_program_text(const StPou& program) {
  return fmt::format("{}PROGRAM {}\n{}\n{}END_PROGRAM\n", program.head, program.name, st_declarations(program.sections),
                     program.body);
}

}  // namespace hysteron
