// What the evidence tells: effects that may be there, alone, in sets and by families, each with its probability and
// with the share of the gap that it closes on stretches which its fit did not see.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hysteron::diagnosis {

/// A number of an effect, and the standard error of it by leaving blocks out; 0 where it was given by a grid, not a
/// number where it was fitted to all blocks.
struct LawValue {
  std::string name{};
  double value = 0.0;
  double error = 0.0;
  std::string unit{};  ///< as its block says it: 'x is that of the edge
};

struct LawFinding {
  std::string effect{};
  std::string family{};
  std::string edge{};
  std::vector<std::string> drivers{};
  std::vector<LawValue> values{};
  double closed = 0.0;  ///< of the held-out gap, by Shapley's share in the set
};

struct SetFinding {
  std::string space{};
  std::vector<LawFinding> laws{};
  double probability = 0.0;
  double closed = 0.0;          ///< of the held-out gap
  std::vector<double> known{};  ///< the known parameters that go with it, to first order
};

struct FamilyFinding {
  std::string family{};
  double probability = 0.0;
  double by_record = 0.0;  ///< the probability by the record alone: without a prior, the same
  double closed = 0.0;     ///< of the held-out gap, by Shapley's share in the most probable set that holds it
  double alone = 0.0;      ///< and by itself
  std::string effect{};    ///< its most probable member
  double member = 0.0;     ///< the probability of that one, of that of the family
  std::string edge{};
};

/// What functions of one kind, whatever they are called, could predict of a gap on stretches that no fit saw.
struct KindFinding {
  std::string kind{};  ///< by its name in gap_kinds.hpp
  double alone = 0.0;  ///< by itself, with its 95 % interval by the jackknife over the stretches
  double low = 0.0;
  double high = 0.0;
  double only = 0.0;   ///< nothing else can
  double share = 0.0;  ///< its part of what all kinds close together: the mean of `alone` and `only`, to scale
};

/// The gap by kinds, before any effect has a name.
struct GapBudget {
  std::string at{};                  ///< the output, or the edge where what is missing can be seen
  double closed = 0.0;               ///< by all kinds together; the rest is noise, or of no kind
  double noise = 0.0;                ///< of the gap at the outputs, at most; 0 at an edge
  std::vector<KindFinding> kinds{};  ///< largest share first
};

/// What is missing beside all that is explained otherwise, over the signal that it is a function of, with the law.
struct MissingPicture {
  std::string edge{};
  std::string unit{};
  std::string effect{};
  std::string over{};
  std::string over_unit{};
  std::vector<double> places{};
  std::vector<double> missing{};
  std::vector<double> law{};
};

struct Evidence {
  std::vector<FamilyFinding> families{};  ///< by what each closes times how probable it is, largest first
  std::vector<SetFinding> sets{};         ///< most probable first
  MissingPicture picture{};               ///< of the first family; empty where nothing is there
  std::size_t tried = 0;                  ///< laws
  bool is_told = false;                   ///< the verdict is of it: a family is more probable than not, and is relevant
  bool is_open_loop = false;              ///< of the plant alone, taken out of the loop whose effort was logged
};

}  // namespace hysteron::diagnosis
