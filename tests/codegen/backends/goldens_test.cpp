// What the back-ends write for one small diagram, to the byte. HYSTERON_UPDATE_GOLDENS=1 writes the files anew: read
// the difference before it is committed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "codegen/backends/batch/batch.hpp"
#include "codegen/backends/c/c.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/st/st.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

/// A signal at two rates, a guarded power, an array, a bound at infinity, and an input of the name that a PLC needs.
constexpr std::string_view golden_diagram = R"(FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT
    TARGET : LREAL;          (* @unit um @min -10 @max 10 @doc where the stage is to go *)
    RESET  : BOOL := FALSE;  (* @doc of the integral alone *)
    SHAPE  : LREAL := 1.5;   (* @param @min 0.5 @max 3 @doc exponent, µ-law *)
  END_VAR
  VAR_OUTPUT
    U    : LREAL;  (* @unit um *)
    NEAR : BOOL;
    N    : DINT;
  END_VAR
  VAR
    CURVE  : HY_TABLE := (COUNT := 3, X := [-1.0, 0.0, 2.0], Y := [-2.0, 0.0, 1.0]);
    BOUND  : HY_LIMIT := (MN := -5.0);
    SLOWER : HY_SAMPLE;  (* @every 4 *)
    BACK   : HY_HOLD;
    SUM    : HY_INTEGRAL;
  END_VAR

  CURVE(XIN := TARGET);
  BOUND(XIN := CURVE.XOUT);
  SLOWER(XIN := BOUND.XOUT);
  BACK(XIN := SLOWER.XOUT);
  SUM(XIN := BACK.XOUT, R1 := RESET);
  U := TARGET;
  NEAR := ABS(SUM.XOUT) ** SHAPE < 1.0 XOR RESET;
  N := LREAL_TO_DINT(TARGET / SUM.XOUT) MOD 7;
END_FUNCTION_BLOCK
)";

/// Sums of four terms and rows of three; operands that are an array, and such that stand alone; a reset by hand; a
/// memory that is moved on within itself.
constexpr std::string_view golden_vectors = R"(FUNCTION_BLOCK OBSERVER  (* @ts 1ms *)
  VAR_INPUT
    FORCE, LOAD, TORQUE : LREAL;
    AGAIN               : BOOL;
    U                   : ARRAY[0..3] OF LREAL;
  END_VAR
  VAR_OUTPUT
    Y     : ARRAY[0..2] OF LREAL;
    X     : ARRAY[0..3] OF LREAL;
    MIXED : ARRAY[0..2] OF LREAL;
    HELD  : LREAL;
    CALM  : LREAL;
  END_VAR
  VAR
    MODEL : HY_STATE_SPACE := (A := [0.9, 0.1, 0.0, 0.0,  0.0, 0.8, 0.1, 0.0,  0.0, 0.0, 0.7, 0.1,  0.0, 0.0, 0.0, 0.6],
                               B := [0.0, 1.0, 0.5, 0.2],
                               C := [1.0, 0.0, 0.0, 0.0,  0.0, 1.0, 0.0, 0.0,  0.0, 0.0, 1.0, 1.0]);
    MIX   : HY_MATRIX_GAIN := (K := [1.0, 2.0, 3.0,  4.0, 5.0, 6.0,  7.0, 8.0, 9.0], ROWS := 3);
    PLANT : HY_TRANSFER_FUNCTION_ZOH := (NUM := [1.0], DEN := [1.0, 2.0, 3.0, 4.0]);
    NOTCH : HY_TRANSFER_FUNCTION := (NUM := [1.0, 0.5, 0.2, 0.1, 0.0], DEN := [1.0, 0.2, 0.1, 0.05, 0.01]);
  END_VAR

  MODEL(U := FORCE, R1 := AGAIN);
  Y := MODEL.Y;
  X := MODEL.X;
  MIX(XIN := [FORCE, LOAD, TORQUE + 1.0]);
  MIXED := MIX.XOUT;
  PLANT(XIN := LOAD, R1 := AGAIN);
  HELD := PLANT.XOUT + 0.5 * SUM(U);
  NOTCH(XIN := TORQUE);
  CALM := NOTCH.XOUT;
END_FUNCTION_BLOCK
)";

void hold_against_golden(const GeneratedFile& file, const std::string& folder) {
  const std::string path =
      std::string(HYSTERON_SOURCE_DIR) + "/tests/codegen/backends/goldens/" + folder + "_" + file.name;
  if (std::getenv("HYSTERON_UPDATE_GOLDENS") != nullptr) {
    std::ofstream(path, std::ios::binary) << file.text;
  }
  EXPECT_EQ(file.text, test::contents_of(path)) << path;
}

/// Structures and steps of a batch, without the functions on vectors, which are the same for every diagram.
GeneratedFile step_of_batch(const Program& program) {
  const std::string text = generate_batch(program).text;
  const std::size_t structures = text.find("struct Params");
  const std::size_t passes = text.find("// The code below");
  return {"axis_batch.txt",
          text.substr(structures, passes - structures) + text.substr(text.find("HYSTERON_INLINE void reset_pack"))};
}

TEST(Goldens, OfEveryTargetAreKeptToTheByte) {
  const Program program = compile_text(std::string(golden_diagram));
  for (const char* const dialect : {"portable", "codesys", "twincat", "siemens-scl"}) {
    for (const GeneratedFile& file : generate_st(program, {.dialect = *st_dialect(dialect)})) {
      hold_against_golden(file, dialect);
    }
  }
  hold_against_golden(generate_st(program, {.dialect = *st_dialect("portable"), .float32 = true}).front(), "real");
  for (const GeneratedFile& file : generate_c(program)) {
    hold_against_golden(file, "c");
  }
  hold_against_golden(generate_c(program, {.float32 = true}).back(), "c_float");
  hold_against_golden(generate_cpp_header(program), "cpp");
  hold_against_golden(step_of_batch(program), "batch");
}

TEST(Goldens, OfVectorsWithinAStepAreKeptToTheByte) {
  const Program program = compile_text(std::string(golden_vectors));
  hold_against_golden(generate_st(program, {.dialect = *st_dialect("portable")}).front(), "portable");
  hold_against_golden(generate_st_structured(program, {.dialect = *st_dialect("portable")}).front(), "structured");
  for (const GeneratedFile& file : generate_c(program)) {
    hold_against_golden(file, "c");
  }
  hold_against_golden(generate_cpp_header(program), "cpp");
}

}  // namespace
}  // namespace hysteron::testing
