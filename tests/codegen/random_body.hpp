// Random sequential bodies, with the ports of a RandomDiagram: X1, X2, X3, B1, B2, N1 and Y0 to Y3, Q, N.
#pragma once

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

#include "codegen/compile.hpp"

namespace hysteron::testing {

class RandomBody {
 public:
  /// With `timers`, TON, TOF and TP are called under conditions too, and TIME() is read.
  RandomBody(std::uint64_t seed, const std::string& name, int statements, bool timers = false)
      : engine_(seed), timers_(timers) {
    text_ = fmt::format(R"(TYPE PAIR : STRUCT A : INT := 3; B : LREAL; END_STRUCT; END_TYPE
FUNCTION CLAMP : INT
VAR_INPUT V : INT; W : INT; END_VAR
VAR R : INT; END_VAR
  R := V;
  IF R > W THEN CLAMP := W; RETURN; END_IF;
  CLAMP := R - 1;
END_FUNCTION
FUNCTION_BLOCK COUNTER (* @body *)
VAR_INPUT UP : BOOL; INC : INT := 1; END_VAR
VAR_OUTPUT COUNT : INT; END_VAR
VAR_IN_OUT SUM : LREAL; END_VAR
  IF UP THEN COUNT := COUNT + INC; SUM := SUM * 0.5 + 1.0; END_IF;
END_FUNCTION_BLOCK
FUNCTION_BLOCK {} (* @ts 1ms @body *)
VAR_INPUT X1 : LREAL; X2 : LREAL; X3 : LREAL; B1 : BOOL; B2 : BOOL; N1 : DINT; END_VAR
VAR_OUTPUT Y0 : LREAL; Y1 : LREAL; Y2 : LREAL; Y3 : LREAL; Q : BOOL; N : DINT; END_VAR
VAR L1 : LREAL := 0.5; L2 : LREAL; R1 : REAL := 1.25; R2 : REAL; I1 : INT := -7; I2 : INT; U1 : UINT; D1 : DINT;
  V1 : UDINT := 4000000000; K1 : BYTE; W1 : WORD; E1 : DWORD := 16#F0F0F0F0; C1 : BOOL; C2 : BOOL := TRUE; S : PAIR;
  A : ARRAY[0..3] OF INT := [1, 2, 3, 4]; F : ARRAY[1..2] OF LREAL; T1 : COUNTER; T2 : COUNTER; J : INT;
  G : USINT;{} END_VAR
VAR_TEMP H : INT; END_VAR
)",
                        name, timers ? " LATE : TIME; D_ON : TON; D_OFF : TOF; D_PULSE : TP;" : "");
    for (int i = 0; i < statements; ++i) {
      text_ += statement(0, "  ");
    }
    text_ += "END_FUNCTION_BLOCK\n";
    name_ = name;
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] Program program() const { return compile_text(text_, {.top = name_}); }

 private:
  std::size_t pick(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  std::string one_of(const std::vector<std::string>& list) { return list[pick(list.size())]; }

  std::string truth(int depth) {
    if (depth > 2 || pick(3) == 0) {
      return one_of({"B1", "B2", "C1", "C2", "Q", "TRUE", "FALSE", "W1.3", "E1.31"});
    }
    switch (pick(6)) {
      case 0:
        return fmt::format("({} {} {})", integer(depth + 1), one_of({"<", "<=", ">", ">=", "=", "<>"}),
                           integer(depth + 1));
      case 1:
        return fmt::format("({} {} {})", real(depth + 1), one_of({"<", "<=", ">", ">="}), real(depth + 1));
      case 2:
        return fmt::format("({} {} {})", truth(depth + 1), one_of({"AND", "OR", "XOR", "=", "<>"}), truth(depth + 1));
      case 3:
        return fmt::format("({} {} {})", unsigned_32(), one_of({"<", "<=", ">", ">=", "="}), unsigned_32());
      case 4:
        return fmt::format("({} {} {})", single(depth + 1), one_of({"<", ">="}), single(depth + 1));
      default:
        return fmt::format("(NOT {})", truth(depth + 1));
    }
  }

  std::string small() { return one_of({"I1", "I2", "A[1]", "S.A", "T1.COUNT", "H"}); }
  std::string index() { return one_of({"0", "3", "I1", "D1 MOD 4", "J"}); }

  /// Of any width up to 32 bits with a sign.
  std::string integer(int depth) {
    if (depth > 2 || pick(3) == 0) {
      return pick(4) == 0 ? fmt::format("{}", static_cast<int>(pick(2000)) - 1000)
                          : (pick(2) == 0 ? small() : one_of({"D1", "N1", "N", fmt::format("A[{}]", index())}));
    }
    switch (pick(7)) {
      case 0:
        return fmt::format("({} {} {})", integer(depth + 1), one_of({"+", "-", "*"}), integer(depth + 1));
      case 1:
        return fmt::format("({} {} {})", integer(depth + 1), one_of({"/", "MOD"}), integer(depth + 1));
      case 2:
        return fmt::format("SEL({}, {}, {})", truth(depth + 1), integer(depth + 1), integer(depth + 1));
      case 3:
        return fmt::format("CLAMP({}, I2)", small());
      case 4:
        return fmt::format("{}({}, {})", one_of({"MIN", "MAX"}), integer(depth + 1), integer(depth + 1));
      case 5:
        return fmt::format("LREAL_TO_DINT({} * 3.0)", real(depth + 1));
      default:
        return fmt::format("(-{})", small());
    }
  }

  std::string unsigned_32() {
    return one_of({"V1", "(V1 / 7)", "(V1 MOD 11)", "(V1 + V1)", "UDINT#3000000000", "(V1 - 5)"});
  }

  std::string bits(int depth) {
    if (depth > 1) {
      return one_of({"E1", "DWORD#16#FF00", "DINT_TO_DWORD(D1)"});
    }
    return one_of({fmt::format("({} {} {})", bits(depth + 1), one_of({"AND", "OR", "XOR"}), bits(depth + 1)),
                   fmt::format("SHL({}, {})", bits(depth + 1), pick(34)),
                   fmt::format("SHR({}, {})", bits(depth + 1), pick(34)), fmt::format("SHL({}, A[2])", bits(depth + 1)),
                   fmt::format("ROL({}, {})", bits(depth + 1), pick(32)), fmt::format("(NOT {})", bits(depth + 1))});
  }

  std::string real(int depth) {
    if (depth > 2 || pick(3) == 0) {
      return one_of({"X1", "X2", "X3", "L1", "L2", "S.B", "F[1]", "F[I1]", "Y1", "0.75", "2"});
    }
    switch (pick(5)) {
      case 0:
        return fmt::format("({} {} {})", real(depth + 1), one_of({"+", "-", "*"}), real(depth + 1));
      case 1:
        return fmt::format("({} / ({} * {} + 1.0))", real(depth + 1), one_of({"X1", "L1"}), one_of({"X1", "L1"}));
      case 2:
        return fmt::format("DINT_TO_LREAL({})", one_of({"D1", "N1", "N"}));
      case 3:
        return fmt::format("LIMIT(-2.0, {}, 2.0)", real(depth + 1));
      default:
        return fmt::format("REAL_TO_LREAL({})", single(depth + 1));
    }
  }

  std::string single(int depth) {
    if (depth > 2 || pick(3) == 0) {
      return one_of({"R1", "R2", "REAL#0.1", "LREAL_TO_REAL(X1)"});
    }
    return one_of({fmt::format("({} {} {})", single(depth + 1), one_of({"+", "-", "*"}), single(depth + 1)),
                   fmt::format("({} * 0.3)", single(depth + 1)), fmt::format("ABS({})", single(depth + 1)),
                   "INT_TO_REAL(I1)",
                   fmt::format("SEL({}, {}, {})", truth(depth + 1), single(depth + 1), single(depth + 1))});
  }

  std::string timer() {
    return one_of({fmt::format("D_ON(IN := {}, PT := T#3ms, ET => LATE);", truth(1)),
                   fmt::format("D_OFF(IN := {}, PT := LATE); C1 := D_OFF.Q;", truth(1)),
                   fmt::format("D_PULSE(IN := {}, PT := T#2ms); Q := D_PULSE.Q;", truth(1)),
                   "IF TIME() > T#20ms THEN LATE := TIME() - T#18ms; END_IF;"});
  }

  std::string assignment() {
    if (timers_ && pick(4) == 0) {
      return timer();
    }
    switch (pick(14)) {
      case 0:
        return fmt::format("{} := LIMIT(-1000.0, {}, 1000.0);",
                           one_of({"Y0", "Y1", "Y2", "Y3", "L1", "L2", "S.B", "F[2]", "F[J]"}), real(0));
      case 1:
        return fmt::format("{} := {};", one_of({"R1", "R2"}), single(0));
      case 2:
        return fmt::format("{} := DINT_TO_INT({});", one_of({"I1", "I2", "S.A", "H", fmt::format("A[{}]", index())}),
                           integer(0));
      case 3:
        return fmt::format("I1 := {} {} {};", small(), one_of({"+", "-", "*"}), small());
      case 4:
        return fmt::format("{} := {};", one_of({"D1", "N"}), integer(0));
      case 5:
        return fmt::format("{} := {};", one_of({"C1", "C2", "Q", "E1.7", "W1.15"}), truth(0));
      case 6:
        return fmt::format("V1 := {};", unsigned_32());
      case 7:
        return fmt::format("E1 := {};", bits(0));
      case 8:
        return "U1 := U1 + 40000; W1 := SHL(W1, 1) OR UINT_TO_WORD(U1);";
      case 9:
        return fmt::format("K1 := DWORD_TO_BYTE({}); D1 := BYTE_TO_DINT(K1);", bits(1));
      case 10:
        return fmt::format("T1(UP := {}, SUM := L2);", truth(1));
      case 11:
        return fmt::format("T2.INC := {}; T2(UP := C1, SUM := F[1], COUNT => I2);", small());
      case 12:
        return "Q := NOT Q; N := N + A[J];";
      default:
        return fmt::format("Y{} := {};", pick(4), real(0));
    }
  }

  /// Of each kind: with constant bounds, with bounds in a range, and until something holds that is sure to come.
  std::string loop(const std::string& indent, const std::string& inside) {
    switch (pick(5)) {
      case 0:
        return fmt::format("{0}FOR J := {1} TO MIN(MAX({2}, -3), 4) DO\n{3}{0}END_FOR;\n", indent,
                           one_of({"-1", "MAX(MIN(I1, 3), 0)"}), small(), inside);
      case 1:
        return fmt::format("{0}FOR J := MIN(MAX({1}, -2), 3) TO {2} BY -1 DO\n{3}{0}END_FOR;\n", indent, small(),
                           one_of({"-1", "MAX(MIN(I2, 1), -2)"}), inside);
      case 2:
        return fmt::format("{0}G := DINT_TO_USINT({1}) / 16;\n{0}WHILE G > 0 DO\n{0}  G := G / 2;\n{2}{0}END_WHILE;\n",
                           indent, integer(1), inside);
      case 3:
        return fmt::format("{0}G := 0;\n{0}REPEAT\n{0}  G := G + 1;\n{1}{0}UNTIL G >= 3 OR {2} END_REPEAT;\n", indent,
                           inside, truth(1));
      default:
        return fmt::format("{0}FOR J := 3 TO -1 BY -2 DO\n{1}{0}END_FOR;\n", indent, inside);
    }
  }

  std::string statement(int depth, const std::string& indent) {
    const std::string deeper = indent + "  ";
    const auto some = [&] {
      std::string list;
      for (std::size_t i = 0; i <= pick(2); ++i) {
        list += statement(depth + 1, deeper);
      }
      return list;
    };
    if (depth < 3 && pick(3) == 0) {
      switch (pick(4)) {
        case 0:
          return fmt::format("{0}IF {1} THEN\n{2}{0}ELSIF {3} THEN\n{4}{0}ELSE\n{5}{0}END_IF;\n", indent, truth(0),
                             some(), truth(1), some(), some());
        case 1:
          return fmt::format("{0}IF {1} THEN\n{2}{0}END_IF;\n", indent, truth(0), some());
        case 2:
          return fmt::format("{0}CASE {1} OF\n{0}0, 1:\n{2}{0}-3..-1, 5:\n{3}{0}ELSE\n{4}{0}END_CASE;\n", indent,
                             one_of({"I1", "D1 MOD 7", "N1"}), some(), some(), some());
        default: {
          // What counts a loop may not count another inside of it.
          if (loops_++ > 3 || depth > 1 || in_loop_) {
            return indent + assignment() + "\n";
          }
          in_loop_ = true;
          const std::string inside = some();
          in_loop_ = false;
          const std::string jump =
              pick(2) == 0 ? fmt::format("{}IF {} THEN {}; END_IF;\n", deeper, truth(0), one_of({"EXIT", "CONTINUE"}))
                           : "";
          return loop(indent, inside + jump);
        }
      }
    }
    if (depth > 0 && pick(25) == 0) {
      return fmt::format("{}IF {} THEN RETURN; END_IF;\n", indent, truth(0));
    }
    return indent + assignment() + "\n";
  }

  std::mt19937_64 engine_;
  bool timers_ = false;
  bool in_loop_ = false;
  std::string name_{};
  std::string text_{};
  int loops_ = 0;
};

}  // namespace hysteron::testing
