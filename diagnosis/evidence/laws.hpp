// Laws: what each effect would add to the signal of an edge, as a function of signals that were measured.
//
//   φ(k) = effect(x, drivers)(k) − x(k)
//
// The effect is the block itself, run by itself on the measured signals: its formula stands in its header and nowhere
// else. In a strength that a law is linear in, φ is a unit of it, and how much there is of it is found by regression; a
// strength that it is not linear in, the width of a backlash, is tried on a grid as a shape is.
//
// A speed v is found from positions, with a deviation s. A dry friction jumps with its sign. Where the machine rests,
// the friction is whatever holds it, up to its level (Filippov's set-valued law): it lies between what the block gives
// at v − 2s and at v + 2s.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/effects/starts.hpp"
#include "diagnosis/evidence/blocks.hpp"
#include "diagnosis/evidence/space.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// An effect on an edge at one setting of its shapes.
struct Law {
  struct Term {
    std::string strength{};  ///< the parameter that it is a unit of
    std::string measure{};   ///< in which that one is given, as its block says it: 'x
    double unit = 1.0;       ///< that one less its neutral value, at a share of 1
    double neutral = 0.0;
    double lowest = 0.0;  ///< of the share
    double highest = 0.0;
    /// Or of the share turned round, together with those of its family on the edge: what resists a motion is a force of
    /// the other sign where the motion is imposed, and two of one family do not act against each other.
    bool either_way = false;

    [[nodiscard]] bool holds(double share) const { return share >= lowest && share <= highest; }
  };
  std::string effect{};
  std::string family{};
  std::string edge{};
  std::vector<std::string> drivers{};
  std::vector<std::pair<std::string, double>> shape{};  ///< what is no term: shapes, strengths that are not linear
  std::vector<Term> terms{};
  MatrixXd responses{};  ///< of the outputs, thinned; a column for each term
  MatrixXd slacks{};     ///< half of what they change by with a speed as far as it is not known; or empty
  std::size_t place = 0;

  /// The same but for its numbers.
  [[nodiscard]] bool is_like(const Law& other) const {
    return effect == other.effect && edge == other.edge && drivers == other.drivers;
  }
};

struct LawOptions {
  std::vector<std::string> effects{};  ///< identifiers; empty: all
  unsigned threads = 2;
};

/// All laws on all places of a space; those that do there what another one of the same effect does are left out.
[[nodiscard]] std::vector<Law> laws_of(const Task& task, const Space& space, const Explanation& fitted,
                                       const Blocks& blocks, const LawOptions& options);

}  // namespace hysteron::diagnosis
