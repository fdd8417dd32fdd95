#include "diagnosis/findings/left_out_findings.hpp"

#include <algorithm>
#include <utility>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/findings/shares.hpp"
#include "diagnosis/noise/remainder.hpp"

namespace hysteron::diagnosis {

void add_left_out(const Findings& findings, const LeftOutOfFits& from, const std::vector<Edge>& edges,
                  Diagnosis& result) {
  const std::vector<std::string>& outputs = findings.task.outputs;
  const VectorXd& residuals = findings.search.calibrated.fit.residuals;
  const double rows = static_cast<double>(residuals.size()) / static_cast<double>(outputs.size());
  double gap = gap_energy(findings);
  for (const LeftOut& one : from.left_out) {
    const NoiseFloor& floor = from.floors[one.output];
    const double ratio = one.rms / floor.value;
    const double closes = 0.5 * rows * ratio * ratio;
    const bool alone = result.effects.empty();
    result.warnings.push_back(one.remark);
    // Beside two or more it would be there for what their formulas leave, as any other effect.
    const bool is_notable =
        result.effects.size() < 2 ||
        closes > least_gain(findings.search.calibrated.fit.cost, findings.floor_cost, result.effects.size() + 1);
    if (one.rms < least_excess(floor) || !is_notable || !is_tried(from.tried, one.effect)) {
      continue;
    }
    const Edge* const edge = find_edge(edges, outputs[one.output]);
    EffectFinding finding{
        .id = one.effect, .edge = edge == nullptr ? outputs[one.output] : edge->name, .parameters = one.parameters};
    gap = add_share(result.effects, gap, std::move(finding), closes);
    for (Rival& rival : result.rivals) {
      rival.effects.push_back(one.effect);
      rival.edges.push_back(result.effects.back().edge);
    }
    if (alone) {
      result.verdict = result.verdict == Verdict::Unknown ? Verdict::Partial : Verdict::Named;
      result.rivals = {{.effects = {one.effect},
                        .edges = {result.effects.back().edge},
                        .improved_rms = result.gap.improved,
                        .probability = 1.0}};
      result.unknown_score = excess_of(result.gaps[one.output].improved / (floor.value * from.noise[one.output]));
      result.confidence = 0.9 * (1.0 - result.unknown_score);
    }
  }
  if (!from.left_out.empty()) {
    std::ranges::stable_sort(result.effects,
                             [](const EffectFinding& x, const EffectFinding& y) { return x.share > y.share; });
  }
}

}  // namespace hysteron::diagnosis
