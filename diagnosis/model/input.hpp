// What a diagnosis is given, and how it is asked to work.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "diagnosis/prior.hpp"
#include "records/record.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {

struct DiagnosisInput {
  Program program{};
  std::string text{};  ///< of the diagram
  parameters::ParameterFile file{};
  std::vector<records::Record> records{};
};

struct DiagnosisOptions {
  double material = 0.0;  ///< smallest gap that matters, RMS in the output's unit; noise_floor.hpp says the least
  std::vector<std::string> effects{};  ///< identifiers to be tried; empty: all
  int most_effects = 3;
  double effort = 1.0;           ///< of a search, in policy::work
  double time_limit = infinity;  ///< s, after which no further effect is added either; the verdict then depends on it
  std::uint64_t seed = 1;
  bool explain = false;                ///< keeps the answers of the rules
  Prior prior{};                       ///< by the machine's siblings
  std::vector<std::string> without{};  ///< rules that are left out, see rules.hpp
  unsigned threads = 2;
  std::function<void(double fraction, std::string_view text)> progress{};
  /// Of the next experiment, by name: "U" the largest |value| of an input, "U.low", "U.high", "U.rate" its ends and
  /// its fastest change a second. What is not named is taken from the records.
  std::vector<std::pair<std::string, double>> limits{};
};

}  // namespace hysteron::diagnosis
