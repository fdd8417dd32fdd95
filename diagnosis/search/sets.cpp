#include "diagnosis/search/sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnosis/model/refusal.hpp"

namespace hysteron::diagnosis {
namespace {

std::string without_instance(const std::string& path, const Applied& applied) {
  return path.substr(applied.instance.size());
}

/// The settings of an effect, of its instance in another variant; a simpler formula may not have all.
void take_settings(Candidate& candidate, const Applied& from) {
  Applied& own = candidate.variant.effects.back();
  for (const auto& [path, value] : from.settings) {
    std::string there = own.instance + without_instance(path, from);
    if (find_parameter(candidate.variant.program->graph, there) >= 0) {
      own.settings.emplace_back(std::move(there), value);
    }
  }
}

/// Whether two effects have the same parameters: one effect may have several formulas in one block.
bool same_formula(const Applied& a, const Applied& b) {
  return std::ranges::equal(a.paths, b.paths, [&](const std::string& one, const std::string& other) {
    return without_instance(one, a) == without_instance(other, b);
  });
}

/// What a richer formula shares out among its strengths, a simpler one has in its own: of multiples of the last
/// effect's strengths from a third to fourfold, the one that leaves the least, to half a hundredth.
void take_best_multiple(Model& model, Explanation& one) {
  const Applied& own = one.variant.effects.back();
  std::vector<Index> strengths;
  for (std::size_t k = 0; k < one.variant.further.size(); ++k) {
    const std::string& path = one.variant.further[k].path;
    if (std::ranges::find(own.paths, path) != own.paths.end() && own.parameter(path).strength) {
      strengths.push_back(model.first_further() + static_cast<Index>(k));
    }
  }
  const VectorXd shared = one.fit.x;
  double best = 0.0;  // octaves
  double least = std::numeric_limits<double>::infinity();
  const auto at_octaves = [&](double octaves) {
    VectorXd x = shared;
    for (const Index k : strengths) {
      x[k] = std::clamp(shared[k] * std::exp2(octaves), model.lower()[k], model.upper()[k]);
    }
    return x;
  };
  const auto try_octaves = [&](double octaves) {
    VectorXd x = at_octaves(octaves);
    VectorXd residuals;
    if (model.residuals(x, residuals) && residuals.squaredNorm() < least) {
      least = residuals.squaredNorm();
      best = octaves;
      one.fit.x = std::move(x);
    }
  };
  double step = 0.125;
  std::vector<VectorXd> points;
  for (int k = -12; k <= 16; ++k) {
    points.push_back(at_octaves(step * k));
  }
  model.foresee(std::move(points));
  for (int k = -12; k <= 16; ++k) {
    try_octaves(step * k);
  }
  for (int halving = 0; halving < 5; ++halving) {
    step *= 0.5;
    const double middle = best;
    try_octaves(middle - step);
    try_octaves(middle + step);
  }
}

bool has_effect(const Variant& variant, const std::string& effect) {
  return std::ranges::any_of(variant.effects, [&](const Applied& one) { return one.effect == effect; });
}

}  // namespace

bool Sets::same_root(std::string_view a, std::string_view b) {
  return a.substr(0, a.find_first_of("._")) == b.substr(0, b.find_first_of("._"));
}

std::vector<Candidate> Sets::in_place_of(const Variant& base, const Applied& wanted) const {
  std::vector<Candidate> list = candidates_of(
      base, top_, {.effects = {wanted.effect}, .columns = options_.columns, .again = has_effect(base, wanted.effect)});
  std::erase_if(list, [&](const Candidate& one) {
    return one.own().block != wanted.block || one.own().wires != wanted.wires ||
           !same_root(one.own().edge, wanted.edge) || !same_formula(one.own(), wanted);
  });
  (void)std::stable_partition(list.begin(), list.end(),
                              [&](const Candidate& one) { return one.own().edge == wanted.edge; });
  return list;
}

Explanation Sets::without(const Explanation& whole, std::size_t dropped, const Variant& bare, int iterations) const {
  return unless_refused([&] { return rebuilt(whole, dropped, bare, iterations); });
}

void Sets::take_on(Explanation& result, VectorXd& start, Candidate candidate, const Explanation& whole,
                   const Applied& wanted) const {
  take_settings(candidate, wanted);
  Variant& variant = candidate.variant;
  const Applied& own = variant.effects.back();
  for (const std::string& path : own.paths) {
    for (std::size_t k = 0; k < whole.variant.further.size(); ++k) {
      const Unknown& unknown = whole.variant.further[k];
      if (unknown.path == wanted.instance + without_instance(path, own)) {
        variant.further.push_back(unknown);
        variant.further.back().path = path;
        start.conservativeResize(start.size() + 1);
        start[start.size() - 1] = whole.fit.x[std::ssize(task_.known) + static_cast<Index>(k)];
      }
    }
  }
  result.variant = std::move(variant);
  result.variant.program = compiled(result.variant, top_);
}

void Sets::fit_from(Explanation& result, VectorXd start, const Explanation& whole, int iterations) const {
  Model model(task_, *result.variant.program, result.variant.further);
  const Index states = model.unknowns() - start.size();
  start.conservativeResize(model.unknowns());
  start.tail(states) = whole.fit.x.tail(states);
  result.fit = fit(model, start, {.iterations = iterations});
  keep_starts(result, model);
}

Explanation Sets::rebuilt(const Explanation& whole, std::size_t dropped, const Variant& bare, int iterations) const {
  Explanation result{.variant = bare};
  VectorXd start = whole.fit.x.head(std::ssize(task_.known));
  for (std::size_t i = 0; i < whole.variant.effects.size(); ++i) {
    if (i == dropped) {
      continue;
    }
    const Applied& wanted = whole.variant.effects[i];
    std::vector<Candidate> list = in_place_of(result.variant, wanted);
    if (list.empty()) {
      return result;
    }
    take_on(result, start, std::move(list.front()), whole, wanted);
  }
  fit_from(result, std::move(start), whole, iterations);
  return result;
}

std::vector<Explanation> Sets::on_each_edge(const Explanation& whole, std::size_t moved, const Variant& bare,
                                            int iterations) const {
  std::vector<Explanation> list;
  const Explanation rest = without(whole, moved, bare, 0);
  if (!std::isfinite(rest.fit.cost)) {
    return list;
  }
  const Applied& wanted = whole.variant.effects[moved];
  for (Candidate& candidate : candidates_of(rest.variant, top_, {.effects = {wanted.effect}})) {
    if (candidate.own().block != wanted.block || !same_formula(candidate.own(), wanted)) {
      continue;
    }
    Explanation one = with_candidate(rest, std::move(candidate), whole, wanted, iterations);
    if (std::isfinite(one.fit.cost)) {
      list.push_back(std::move(one));
    }
  }
  return list;
}

std::vector<Explanation> Sets::in_simpler_formulas(const Explanation& whole, std::size_t which,
                                                   const Variant& bare) const {
  std::vector<Explanation> list;
  const Applied& wanted = whole.variant.effects[which];
  const Explanation rest = without(whole, which, bare, 0);
  if (!std::isfinite(rest.fit.cost)) {
    return list;
  }
  const std::string edge = in_the_diagram(wanted.edge, whole.variant.effects);
  for (Candidate& candidate : candidates_of(rest.variant, top_, options_)) {
    if (!wanted.holds(candidate.own()) || candidate.own().wires != wanted.wires ||
        in_the_diagram(candidate.own().edge, candidate.variant.effects) != edge) {
      continue;
    }
    Explanation one = with_candidate(rest, std::move(candidate), whole, wanted, 0);
    if (std::isfinite(one.fit.cost)) {
      Model model(task_, *one.variant.program, one.variant.further);
      take_best_multiple(model, one);
      one.fit = fit(model, one.fit.x, {.iterations = 20});
      keep_starts(one, model);
      finish(task_, one, {.thoroughly = true});
      list.push_back(std::move(one));
    }
  }
  return list;
}

Explanation Sets::with_candidate(const Explanation& rest, Candidate candidate, const Explanation& whole,
                                 const Applied& wanted, int iterations) const {
  return unless_refused([&] {
    Explanation result{};
    VectorXd start = rest.fit.x.head(std::ssize(task_.known) + std::ssize(rest.variant.further));
    take_on(result, start, std::move(candidate), whole, wanted);
    fit_from(result, std::move(start), whole, iterations);
    return result;
  });
}

Explanation Sets::rest_of(const Explanation& whole, std::size_t dropped, const Variant& bare,
                          const VectorXd& tuned) const {
  constexpr double absurd = 4.0;
  Explanation rest = without(whole, dropped, bare, 0);
  Explanation as_tuned = whole;
  as_tuned.fit.x.head(tuned.size()) = tuned;
  as_tuned = without(as_tuned, dropped, bare, 0);
  return as_tuned.fit.cost * absurd < rest.fit.cost ? as_tuned : rest;
}

Explanation Sets::together(const Screened& first, const Screened& second, const VectorXd& known) const {
  const Explanation base = placed(task_, first, first.starts.front(), known);
  const Applied& wanted = second.candidate.own();
  const std::string behind = base.variant.effects.back().instance + ".";
  Explanation best{};
  for (Candidate& candidate : in_place_of(base.variant, wanted)) {
    const std::string& edge = candidate.own().edge;
    if (edge != wanted.edge && !edge.starts_with(behind)) {
      continue;
    }
    take_settings(candidate, wanted);
    candidate.variant.program = compiled(candidate.variant, top_);
    Screened there{.candidate = std::move(candidate), .unknowns = second.unknowns, .starts = second.starts};
    for (Unknown& unknown : there.unknowns) {
      unknown.path = there.candidate.own().instance + unknown.path.substr(wanted.instance.size());
    }
    for (Start& start : there.starts) {
      start.about_calibration = false;
    }
    Explanation here = begun_from(task_, there, base, {});
    if (here.fit.cost < best.fit.cost) {
      best = std::move(here);
    }
  }
  return best;
}

}  // namespace hysteron::diagnosis
