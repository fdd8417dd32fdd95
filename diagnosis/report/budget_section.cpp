// The gap by kinds: what of it a filter, a curve, a memory, the time could close, whatever it is called.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnosis/evidence/gap_kinds.hpp"
#include "diagnosis/report/html.hpp"
#include "diagnosis/report/sections.hpp"

namespace hysteron::diagnosis::report {

namespace {

/// A narrow screen breaks an interval between its ends alone.
std::string in_one_piece(std::string text) {
  for (auto at = text.find(' '); at != std::string::npos; at = text.find(' ', at)) {
    text.replace(at, 1, "&nbsp;");
  }
  return text;
}

}  // namespace

std::string budget_section(const Diagnosis& diagnosis) {
  if (!diagnosis.budget) {
    return {};
  }
  const GapBudget& budget = *diagnosis.budget;
  const double open = std::max(0.0, 1.0 - budget.closed);
  std::vector<double> shares;
  for (const KindFinding& one : budget.kinds) {
    shares.push_back(one.share);
  }
  shares.push_back(open);
  const std::vector<std::string> parts = percents_of_whole(shares);
  std::string rows;
  for (std::size_t i = 0; i < budget.kinds.size(); ++i) {
    const KindFinding& one = budget.kinds[i];
    const GapKindText& text = *std::ranges::find(gap_kinds, one.kind, &GapKindText::name);
    rows += fmt::format(
        "<tr><td>{}<br><small>{}</small></td><td class=\"bar\">{} {}</td><td class=\"number\">{} … {}</td>"
        "<td class=\"number\">{}</td></tr>\n",
        escaped(text.words), escaped(text.effects), share_bar(one.share, "before"), parts[i],
        in_one_piece(percent(one.low)), in_one_piece(percent(one.high)), percent(std::max(0.0, one.only)));
  }
  rows += fmt::format(
      "<tr><td>no kind<br><small>noise, and what no function of the measured signals tells</small></td>"
      "<td class=\"bar\">{} {}</td><td></td><td></td></tr>\n",
      share_bar(open, "before"), parts.back());
  const std::string noise = budget.noise > 0.0 ? fmt::format(" The noise of the sensor is a part of that, {} at most.",
                                                             percent(std::min(open, budget.noise)))
                                               : std::string();
  return fmt::format(
      "<section class=\"budget\"><h2>The gap by kind of function</h2>\n"
      "<p>Functions of the measured signals close <strong>{}</strong> of the gap at {} on stretches that their fit did "
      "not see. No name of an effect was needed for that. {} stays open, whatever the kind.{} Kinds overlap, so what "
      "they close alone does not add up.</p>\n"
      "<table><thead><tr><th>kind</th><th>its part, 100 % in all</th><th class=\"number\">closes alone</th>"
      "<th class=\"number\">nothing else closes</th></tr></thead><tbody>\n{}</tbody></table>\n</section>\n",
      percent(budget.closed), escaped(budget.at), percent(open), noise, rows);
}

}  // namespace hysteron::diagnosis::report
