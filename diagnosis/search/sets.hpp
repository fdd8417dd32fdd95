// Sets of effects built anew: the same effects, on another variant of the diagram.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

class Sets {
 public:
  Sets(const Task& task, const std::string& top, const CandidateOptions& options)
      : task_(task), top_(top), options_(options) {}

  /// A set without one of its effects, on the bare diagram, fitted in so many steps from where it stood. The cost is ∞
  /// where it cannot be built.
  [[nodiscard]] Explanation without(const Explanation& whole, std::size_t dropped, const Variant& bare,
                                    int iterations) const;

  /// A set without one of its effects, not fitted again: bent towards what the missing effect did, the rest would leave
  /// no room for the right one. Where the missing effect had taken over a gain of the diagram, a relaxation of 24 times
  /// the signal a motor's constant, the known parameters are those as `tuned`.
  [[nodiscard]] Explanation rest_of(const Explanation& whole, std::size_t dropped, const Variant& bare,
                                    const VectorXd& tuned) const;

  /// A set with one of its effects on each edge in turn that has a place for it, the others where they are, fitted in
  /// so many steps from where the set stood.
  [[nodiscard]] std::vector<Explanation> on_each_edge(const Explanation& whole, std::size_t moved, const Variant& bare,
                                                      int iterations) const;

  /// A set with one of its effects in each simpler formula that it holds, one whose parameters are some of its own, on
  /// the same edge and from its values: a Coulomb friction for a Stribeck friction. Fitted to the end.
  [[nodiscard]] std::vector<Explanation> in_simpler_formulas(const Explanation& whole, std::size_t which,
                                                             const Variant& bare) const;

  /// Two effects as they were screened, with the known parameters and states `known`, after a few steps of a fit; on
  /// one edge in the better order. The cost is ∞ where the second one has no place beside the first.
  [[nodiscard]] Explanation together(const Screened& first, const Screened& second, const VectorXd& known) const;

  /// Whether two edges are one but for what was put onto it: HYST_CREEP.XOUT is HYST.XOUT.
  [[nodiscard]] static bool same_root(std::string_view a, std::string_view b);

 private:
  [[nodiscard]] Explanation rebuilt(const Explanation& whole, std::size_t dropped, const Variant& bare,
                                    int iterations) const;
  /// A candidate for `wanted` with that one's settings, and at the end of `start` those of its parameters that both
  /// have.
  void take_on(Explanation& result, VectorXd& start, Candidate candidate, const Explanation& whole,
               const Applied& wanted) const;
  /// As above, fitted; the cost is ∞ where it cannot be built.
  [[nodiscard]] Explanation with_candidate(const Explanation& rest, Candidate candidate, const Explanation& whole,
                                           const Applied& wanted, int iterations) const;
  /// With the states at the start as in `whole`.
  void fit_from(Explanation& result, VectorXd start, const Explanation& whole, int iterations) const;
  /// The effect on that edge of another variant, in the same formula, or else about it.
  [[nodiscard]] std::vector<Candidate> in_place_of(const Variant& base, const Applied& wanted) const;

  const Task& task_;
  const std::string& top_;
  const CandidateOptions& options_;
};

}  // namespace hysteron::diagnosis
