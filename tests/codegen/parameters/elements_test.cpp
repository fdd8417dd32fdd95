// A parameter file by the elements of vectors: lists, fits of whole vectors, and names that mean one element twice.
#include "codegen/parameters/elements.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/apply.hpp"
#include "support/render.hpp"

namespace hysteron::parameters {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view vectors = R"(FUNCTION_BLOCK TOP  (* @ts 1ms *)
  VAR_INPUT
    U  : LREAL;
    K  : ARRAY[0..2] OF LREAL := [1.0, 2.0, 3.0];  (* @param @min 0 *)
    ON : ARRAY[0..1] OF BOOL;                      (* @param *)
    N  : ARRAY[0..1] OF DINT;                      (* @param *)
    M  : ARRAY[0..1] OF WORD;                      (* @param *)
  END_VAR
  VAR_OUTPUT
    Y : ARRAY[0..2] OF LREAL;
  END_VAR

  Y := SEL(ON[0] AND ON[1], U * K, DINT_TO_LREAL(N[0] + WORD_TO_DINT(M[1])) + K);
END_FUNCTION_BLOCK
)";

class Elements : public ::testing::Test {
 protected:
  [[nodiscard]] ParameterFile by_elements(const std::string& text) const {
    return by_element(parse_parameter_file("p.toml", text), program_.graph);
  }

  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      Graph graph = program_.graph;
      apply(parse_parameter_file("p.toml", text), graph);
    } catch (const InputError& problem) {
      Sources sources;
      sources.put("p.toml", text);
      return as_text(problem.diagnostics(), sources);
    }
    return "taken";
  }

  Program program_ = compile_text(std::string(vectors));
};

std::vector<std::string> paths_of(const auto& items) {
  std::vector<std::string> paths;
  for (const auto& item : items) {
    paths.push_back(item.path);
  }
  return paths;
}

TEST_F(Elements, AListIsOneValueForEach) {
  const ParameterFile file =
      by_elements("[parameters]\nK = [4.0, 5, 6.0]\non = [true, false]\nN = [-7, 8]\nM = [4, 65535]\n");
  EXPECT_THAT(paths_of(file.values),
              ElementsAre("K[0]", "K[1]", "K[2]", "on[0]", "on[1]", "N[0]", "N[1]", "M[0]", "M[1]"));
  Graph graph = program_.graph;
  apply(file, graph);
  std::vector<double> values;
  for (const Parameter& parameter : graph.parameters) {
    values.push_back(parameter.value.front());
  }
  EXPECT_THAT(values, ElementsAre(4.0, 5.0, 6.0, 1.0, 0.0, -7.0, 8.0, 4.0, 65535.0));
}

TEST_F(Elements, AFitOfAVectorFitsEachElement) {
  const ParameterFile file = by_elements("[fit]\nK = {min = 0.5, max = 9.0}\n");
  ASSERT_THAT(paths_of(file.fits), ElementsAre("K[0]", "K[1]", "K[2]"));
  for (const FitSetting& fit : file.fits) {
    EXPECT_EQ(fit.minimum->value, 0.5);
    EXPECT_EQ(fit.maximum->value, 9.0);
  }
}

TEST_F(Elements, OutputsOfAFitAreThoseOfTheVector) {
  std::vector<std::string> names;
  for (const PlacedText& one : by_elements("[tune]\noutputs = [\"y\", \"W\"]\n").tune.outputs) {
    names.push_back(one.text);
  }
  EXPECT_THAT(names, ElementsAre("Y[0]", "Y[1]", "Y[2]", "W"));
}

TEST_F(Elements, AnOutputTwiceIsRefused) {
  EXPECT_THAT(refusal("[tune]\noutputs = [\"Y\", \"Y[0]\"]\n"),
              HasSubstr("HY602 error: p.toml:2:17: Y[0] stands in the list twice: alone, and with its whole vector."));
}

/// Whatever the form, the file by elements says the same as itself by elements.
TEST_F(Elements, IsTheSameTwice) {
  const ParameterFile once = by_elements("[parameters]\nK = [4.0, 5.0, 6.0]\n\"ON[1]\" = true\n[fit]\nK = {}\n");
  const ParameterFile twice = by_element(once, program_.graph);
  EXPECT_EQ(parameter_text(once), parameter_text(twice));
  EXPECT_EQ(parameter_text(once), parameter_text(parse_parameter_file("p.toml", parameter_text(once))));
}

TEST_F(Elements, AnElementGivenTwiceIsRefusedInBothOrders) {
  for (const std::string text : {"K = [4.0, 5.0, 6.0]\n\"K[1]\" = 7.0\n", "\"k[1]\" = 7.0\nK = [4.0, 5.0, 6.0]\n"}) {
    EXPECT_THAT(refusal("[parameters]\n" + text), AllOf(HasSubstr("HY602 error: p.toml:3:1: "),
                                                        HasSubstr("is given twice: alone, and with its whole vector."),
                                                        HasSubstr("the first"), HasSubstr("1 error")));
  }
  EXPECT_THAT(refusal("[fit]\nK = {}\n\"K[2]\" = {max = 9.0}\n"),
              HasSubstr("HY602 error: p.toml:3:1: K[2] is given twice"));
}

TEST_F(Elements, ListsOfAnotherLengthOrTypeAreRefused) {
  EXPECT_THAT(refusal("[parameters]\nK = [1.0, 2.0]\n"),
              AllOf(HasSubstr("HY604 error: p.toml:2:5: K is a vector of 3 elements, and here is 2."),
                    HasSubstr("mend: give each element a value, as in K = [1.0, …].")));
  EXPECT_THAT(refusal("[parameters]\nON = true\n"),
              AllOf(HasSubstr("HY604 error: p.toml:2:6: ON is a vector of 2 elements, and here is a single value."),
                    HasSubstr("ON = [true, …]")));
  EXPECT_THAT(refusal("[parameters]\nON = [1, 0]\n"), HasSubstr("ON[0] takes true or false, not 1."));
  EXPECT_THAT(refusal("[parameters]\nN = [true, false]\n"), HasSubstr("N[0] takes a whole number, not true."));
  EXPECT_THAT(refusal("[parameters]\nN = [1.5, 2]\n"), HasSubstr("N[0] takes a whole number, not 1.5."));
  EXPECT_THAT(refusal("[parameters]\nK = [1.0, -2.0, 3.0]\n"), HasSubstr("K[1] = -2 lies outside of its range."));
}

}  // namespace
}  // namespace hysteron::parameters
