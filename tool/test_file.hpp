// The test file beside a diagram, NAME.test.toml beside NAME.st: cases that say what comes out for what goes in.
//
//   [[case]]
//   name = "a step passes the gain"
//   block = "AMPLIFIER"                    # where the diagram has several top blocks
//   params = {AMP = {K = 2.0}}             # over those of the diagram; or a parameter file: "tuned.toml"
//   steps = 10
//   inputs = {X = {0 = 0.0, 5 = 1.0}}      # the value from each of these steps on
//   expect = {Y = {4 = 0.0, 5 = 2.0}}      # the value at each of these steps
//   abs = 1e-12                            # |got − expected| ≤ abs + rel·|expected|
//   rel = 1e-9
//
// An input is also one value for all steps, a list with one value for each, or {from = 0.0, to = 1.0}, a ramp from the
// first step to the last; `csv = "log.csv"` takes inputs from a record. What is expected is also one value for all
// steps or a list; `golden = "NAME.csv"` names a record of all outputs, which `hysteron test --update` writes.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::tool {

struct Ramp {
  double from = 0.0;
  double to = 0.0;
};
using ValuesByStep = std::map<std::size_t, double>;

/// An input over the steps, or what is expected of an output.
struct TestSignal {
  std::string name{};
  Place place{};        ///< of the name
  Place value_place{};  ///< of the value
  std::variant<double, std::vector<double>, ValuesByStep, Ramp> values{};
};

struct TestText {
  std::string text{};
  Place place{};
};

struct TestCase {
  std::string name{};
  Place place{};
  TestText block{};
  TestText parameter_file{};
  std::vector<parameters::ParameterValue> parameters{};
  bool float32 = false;
  std::optional<std::size_t> steps{};
  TestText csv{};
  TestText golden{};
  std::vector<TestSignal> inputs{};
  std::vector<TestSignal> expected{};
  double absolute = 1e-12;
  double relative = 1e-9;  ///< 1e-5 where float32 is set and it is not
};

struct TestFile {
  std::string path{};
  std::vector<TestCase> cases{};
};

/// Throws InputError with every error found: HY100 where it cannot be read, HY720 to HY723.
[[nodiscard]] TestFile read_test_file(const std::string& path);

/// The same from a text; `file` stands in the places of errors.
[[nodiscard]] TestFile parse_test_file(const std::string& file, std::string_view text);

}  // namespace hysteron::tool
