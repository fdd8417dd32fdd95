// The gap by kinds: what of it a filter, a curve, a memory, the time could close, whatever it is called.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "diagnosis/evidence/gap_kinds.hpp"
#include "diagnosis/report/html.hpp"
#include "diagnosis/report/sections.hpp"

namespace hysteron::diagnosis::report {

std::string budget_section(const Diagnosis& diagnosis) {
  if (!diagnosis.budget) {
    return {};
  }
  const GapBudget& budget = *diagnosis.budget;
  std::string rows;
  for (const KindFinding& one : budget.kinds) {
    const GapKindText& text = *std::ranges::find(gap_kinds, one.kind, &GapKindText::name);
    rows += fmt::format(
        "<tr><td>{}<br><small>{}</small></td><td class=\"bar\">{} {}</td><td class=\"number\">{} … {}</td>"
        "<td class=\"number\">{}</td></tr>\n",
        escaped(text.words), escaped(text.effects), share_bar(one.share, "before"), percent(one.share),
        percent(one.low), percent(one.high), percent(std::max(0.0, one.only)));
  }
  const double open = std::max(0.0, 1.0 - budget.closed);
  const std::string noise = budget.noise > 0.0 ? fmt::format(" The noise of the sensor is {} of the gap, at most.",
                                                             percent(std::min(open, budget.noise)))
                                               : std::string();
  return fmt::format(
      "<section class=\"budget\"><h2>The gap by kind of function</h2>\n"
      "<p>Functions of the measured signals close <strong>{}</strong> of the gap at {} on stretches that their fit did "
      "not see. No name of an effect was needed for that. {} stays open, whatever the kind.{}</p>\n"
      "<table><thead><tr><th>kind</th><th>its part</th><th class=\"number\">closes alone</th>"
      "<th class=\"number\">nothing else closes</th></tr></thead><tbody>\n{}</tbody></table>\n</section>\n",
      percent(budget.closed), escaped(budget.at), percent(open), noise, rows);
}

}  // namespace hysteron::diagnosis::report
