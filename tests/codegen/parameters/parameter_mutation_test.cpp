// Thousands of damaged parameter files: each is read, or refused with number, place, cause and mend.
#include <gtest/gtest.h>

#include <random>

#include "tests/fuzz/toml_property.hpp"
#include "tests/support/mutation.hpp"

namespace hysteron::parameters {
namespace {

TEST(ParameterReader, DamagedFilesAreReadOrRefused) {
  const std::vector<std::string> seeds{
      "[parameters]\nGAIN = 2\n[parameters.INV]\nC1 = 0.05 # um/V\nC2 = [1.0, 2.0]\nON = true\n",
      "[fit.INV]\nC1 = {min = 0.0, max = 1.0, start = 0.5, scale = 1e-3}\nC2 = {}\n[parameters.INV]\nC1 = 0.05\n",
      "[tune]\noutputs = [\"Y\"]\nloss = \"huber\"\ntrain = [[1.0, 9.0], [12.0, 21.0]]\ntest = [21.0, 40.0]\n"
      "initial_states = [\"HYST.P\"]\n",
  };
  const std::vector<std::string> pieces{"[",
                                        "]",
                                        "[[",
                                        "]]",
                                        "{",
                                        "}",
                                        ".",
                                        "=",
                                        ",",
                                        "\"",
                                        "'",
                                        R"(""")",
                                        "nan",
                                        "inf",
                                        "-inf",
                                        "1e308",
                                        "true",
                                        "0x10",
                                        "2024-01-01",
                                        "\n",
                                        "\r\n",
                                        "#",
                                        "\\",
                                        "µ",
                                        "\xB5",
                                        "parameters",
                                        "fit",
                                        "tune",
                                        "[parameters.A]\n",
                                        "a.b.c = 1\n",
                                        std::string(1, '\0'),
                                        "99999999999999999999"};
  std::mt19937 random(8);
  int files = 0;
  int errors = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto text = test::mutated(seeds[random() % seeds.size()], pieces, random);
    const auto outcome = test::read_as_parameters(text);
    ASSERT_EQ(outcome.flaw, "") << text;
    ++(outcome.accepted ? files : errors);
  }
  EXPECT_GT(files, 300) << "mutations too harsh to reach the far end";
  EXPECT_GT(errors, 1000) << "mutations too tame";
}

}  // namespace
}  // namespace hysteron::parameters
