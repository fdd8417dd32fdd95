// Candidates: the diagram as it stands, changed by one effect more.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnosis/effects/edges.hpp"
#include "diagnosis/effects/effects.hpp"
#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

/// An effect that is part of a diagram.
struct Applied {
  std::string effect{};              ///< creep
  std::string simpler{};             ///< as EffectKind has it
  std::string block{};               ///< HY_CREEP
  std::string edge{};                ///< HYST.XOUT; of a richer block, its output
  bool at_port = false;              ///< that edge is an input or an output of the diagram
  bool is_displaced = false;         ///< a converter's, between two parts of the machine
  bool is_own = false;               ///< of a block that the diagram has: parameters are moved, nothing is added
  std::vector<std::string> twins{};  ///< edges on which it gained as much: not told apart, and not fitted
  std::string instance{};            ///< path of the block that carries it
  std::vector<EffectParameter> parameters{};
  std::vector<std::string> paths{};                          ///< of the parameters, beside them
  std::vector<std::pair<std::string, double>> settings{};    ///< of parameters that are not fitted, by path
  std::vector<std::pair<std::string, std::string>> wires{};  ///< auxiliary pins and their drivers: SPEED.XOUT, -Y'
  std::string delay{};                                       ///< path of the HY_DELAY before them; empty: none
  std::string rate{};                                        ///< path of the HY_DERIVATIVE before them; empty: none

  [[nodiscard]] bool has(Role role) const;
  [[nodiscard]] bool has_gap() const;
  [[nodiscard]] bool has_end() const;  ///< one strength, that begins to act at one instant and ceases at another
  /// By one of its paths.
  [[nodiscard]] const EffectParameter& parameter(const std::string& path) const;
  [[nodiscard]] std::string place() const { return effect + "@" + edge; }
  /// Of the parameter of a role; empty where there is none.
  [[nodiscard]] std::string path_of(FieldRole role) const;
  /// Whether the other one is a simpler formula of this, as the description of its block says.
  [[nodiscard]] bool holds(const Applied& other) const;
};

/// The edge of the user's diagram that an edge lies on: beside the block of another effect there is only the edge where
/// that one was put.
[[nodiscard]] std::string in_the_diagram(std::string edge, const std::vector<Applied>& effects);

/// A diagram with the effects added so far.
struct Variant {
  std::string text{};
  std::shared_ptr<const Program> program{};
  std::vector<Applied> effects{};
  std::vector<Unknown> further{};            ///< the parameters of the effects, in their order
  std::vector<NoisyOutput> noisy_outputs{};  ///< whose noise goes around in a loop, from columns of the records
};

/// A variant and the candidate's own part of it: the last effect.
struct Candidate {
  EffectKind kind{};
  Variant variant{};
  Wire input{};                   ///< what drives the effect's XIN
  std::vector<Wire> auxiliary{};  ///< what drives its further inputs
  std::size_t upstream = 0;       ///< how many blocks its input comes from
  bool about_zero = false;        ///< its centre is 0, not the middle of the signal
  double rate_reference = 1.0;    ///< what its rate refers to, over the signal's usual rate
  std::string family{};           ///< candidates with the same signals: name of edge and wires

  [[nodiscard]] const Applied& own() const { return variant.effects.back(); }
};

/// Whether an effect is among those that the user wants tried; none given are all.
[[nodiscard]] bool is_tried(const std::vector<std::string>& effects, std::string_view effect);

/// What drives the first further input of an effect, where that is known and need not be searched for.
struct GivenDriver {
  std::string signal{};       ///< text that gives it: Y, SPEED.XOUT
  bool is_rate = false;       ///< of it the rate, by a block of its own
  bool is_backwards = false;  ///< with the other sign: the effect is on a force that a motion asks for
};

struct CandidateOptions {
  std::vector<std::string> effects{};  ///< identifiers; empty: all
  std::vector<std::string> columns{};  ///< of the records that the diagram does not use, for cross-coupling
  bool again = false;                  ///< effects that the variant has are tried beside themselves, too
  /// What drives the further inputs of an effect but the first, in their order; none: they stay at their defaults. It
  /// is there in the top block alone.
  std::vector<std::string> loads{};
  /// The effects have this driver and no other, wherever it comes from.
  std::optional<GivenDriver> driver{};
};

/// Every effect on every edge, every richer block, every parameter that switches an effect on.
/// `base` compiles; candidates that do not are left out.
[[nodiscard]] std::vector<Candidate> candidates_of(const Variant& base, const std::string& top,
                                                   const CandidateOptions& options);

/// The block of a path, without regard to case; null where there is none.
[[nodiscard]] const Node* find_node(const Graph& graph, std::string_view path);

/// Sets the first element of a parameter by its path; nothing where there is none of that name.
void set_parameter(Graph& graph, std::string_view path, double value);

/// The program of a variant's text, statements in any order, with the settings of its effects.
[[nodiscard]] std::shared_ptr<const Program> compiled(const Variant& variant, const std::string& top);

}  // namespace hysteron::diagnosis
