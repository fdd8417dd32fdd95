#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "diagnosis/effects/set_words.hpp"
#include "diagnosis/report/diagram_picture.hpp"
#include "diagnosis/report/html.hpp"
#include "diagnosis/report/sections.hpp"

namespace hysteron::diagnosis::report {
namespace {

constexpr std::size_t edges_at_once = 8;

std::string joined(const std::vector<std::string>& texts) {
  std::string result;
  for (const std::string& text : texts) {
    result += (result.empty() ? "" : ", ") + text;
  }
  return result;
}

std::string edge_rows(const Diagnosis& diagnosis, std::size_t first, std::size_t last) {
  std::string html =
      "<table><thead><tr><th>wire</th><th>share of the gap: spanned by test signals there, or closed by an effect</th>"
      "<th>this record cannot tell it from</th></tr></thead><tbody>\n";
  for (std::size_t i = first; i < last; ++i) {
    const EdgeFinding& edge = diagnosis.edges[i];
    html += fmt::format("<tr><td>{}</td><td class=\"bar\">{} {}</td><td>{}</td></tr>\n", escaped(edge.edge),
                        share_bar(edge.share, "before"), percent(edge.share), escaped(joined(edge.group)));
  }
  return html + "</tbody></table>\n";
}

std::string edge_table(const Diagnosis& diagnosis) {
  const std::size_t count = diagnosis.edges.size();
  if (count == 0) {
    return {};
  }
  std::string html = edge_rows(diagnosis, 0, std::min(count, edges_at_once));
  if (count > edges_at_once) {
    html += fmt::format("<details><summary>{} further wires</summary>\n{}</details>\n", count - edges_at_once,
                        edge_rows(diagnosis, edges_at_once, count));
  }
  return html;
}

std::string legend() {
  std::string html =
      "<p class=\"legend\">Share of the gap that test signals on the wire span, or an effect there closes; another "
      "change may explain more:";
  static constexpr const char* steps[] = {"not looked at", "0–20 %", "20–40 %", "40–60 %", "60–80 %", "80–100 %"};
  for (int step = 0; step < 6; ++step) {
    html += fmt::format(
        " <span><svg class=\"key\" viewBox=\"0 0 24 10\" aria-hidden=\"true\"><path class=\"wire s{}\" "
        "d=\"M0 5H24\"/></svg>{}</span>",
        step, steps[step]);
  }
  return html +
         " <span><svg class=\"key\" viewBox=\"0 0 24 12\" aria-hidden=\"true\"><path class=\"marked\" "
         "d=\"M0 6H24\"/></svg>effect of the verdict</span></p>\n";
}

std::string name_of_rival(const Rival& rival) {
  std::string text;
  for (std::size_t i = 0; i < rival.effects.size(); ++i) {
    text += (i == 0 ? "" : " + ") + words_of(rival.effects[i]);
    if (i < rival.edges.size() && !rival.edges[i].empty()) {
      text += " on " + rival.edges[i];
    }
  }
  return text.empty() ? std::string(no_effect) : text;
}

/// Whether a rival is the set of effects that the verdict names.
bool is_verdict(const Diagnosis& diagnosis, const Rival& rival) {
  return rival.effects.size() == diagnosis.effects.size() &&
         std::all_of(diagnosis.effects.begin(), diagnosis.effects.end(), [&](const EffectFinding& effect) {
           return std::find(rival.effects.begin(), rival.effects.end(), effect.id) != rival.effects.end();
         });
}

}  // namespace

std::string where_section(const Diagnosis& diagnosis, const Graph& graph) {
  const std::string picture = diagram_picture(diagnosis, graph);
  if (picture.empty() && diagnosis.edges.empty()) {
    return {};
  }
  std::string html = "<section class=\"where\"><h2>Where</h2>\n";
  if (!picture.empty()) {
    html += "<div class=\"scroll\">" + picture + "</div>\n" + (diagnosis.edges.empty() ? std::string() : legend());
  } else {
    html += "<p class=\"note\">The diagram has too many blocks to be drawn here.</p>\n";
  }
  return html + edge_table(diagnosis) + "</section>\n";
}

std::string rivals_section(const Diagnosis& diagnosis) {
  // Warnings stand beside the verdict; a refusal has nothing but its reasons, which stand there too.
  std::vector<std::string> reasons;
  std::copy_if(diagnosis.cannot_tell.begin(), diagnosis.cannot_tell.end(), std::back_inserter(reasons),
               [&](const std::string& reason) {
                 return std::find(diagnosis.warnings.begin(), diagnosis.warnings.end(), reason) ==
                        diagnosis.warnings.end();
               });
  if (!diagnosis.refusals.empty() || (diagnosis.rivals.empty() && reasons.empty())) {
    return {};
  }
  std::string html = "<section class=\"rivals\"><h2>What else the data allow</h2>\n";
  if (!diagnosis.rivals.empty()) {
    html += fmt::format(
        "<table><thead><tr><th></th><th>explanation</th><th>probability</th><th class=\"number\">RMS left{}</th>"
        "<th class=\"number\">log likelihood below the best</th></tr></thead><tbody>\n",
        escaped(diagnosis.gap.unit.empty() || diagnosis.gap.unit == "1" ? "" : " [" + diagnosis.gap.unit + "]"));
    bool marked = false;
    for (std::size_t i = 0; i < diagnosis.rivals.size(); ++i) {
      const Rival& rival = diagnosis.rivals[i];
      const bool own = !marked && is_verdict(diagnosis, rival);
      marked = marked || own;
      html += fmt::format(
          "<tr{}><td>{}</td><td>{}{}</td><td class=\"bar\">{} {}</td><td class=\"number\">{}</td><td class=\"number\">"
          "{}</td></tr>\n",
          own ? " class=\"own\"" : "", i + 1, escaped(name_of_rival(rival)),
          own ? " <span class=\"tag\">verdict</span>" : "", share_bar(rival.probability, "after"),
          percent(rival.probability), figure(rival.improved_rms), figure(-rival.support));
    }
    html += "</tbody></table>\n";
  }
  if (!reasons.empty()) {
    html += "<h3>What this record cannot tell apart, and why</h3>\n" + list_of(reasons, "plain");
  }
  return html + "</section>\n";
}

std::string next_section(const Diagnosis& diagnosis) {
  const NextExperiment& next = diagnosis.next;
  if (next.title.empty() && next.reason.empty() && next.steps.empty() && next.values.empty()) {
    return {};
  }
  const bool none = next.title.empty() && next.values.empty();
  std::string html = fmt::format("<section class=\"next\"><h2>Next experiment{}{}</h2>\n",
                                 next.title.empty() && !none ? "" : ": ", none ? "none" : escaped(next.title));
  if (!next.reason.empty()) {
    html += fmt::format("<p>{}</p>\n", escaped(next.reason));
  }
  if (next.separation > 0.0 && diagnosis.rivals.size() > 1) {
    html += fmt::format("<p>The rivals' outputs will then differ by <strong>{} times</strong> the noise, RMS.</p>\n",
                        figure(next.separation, 2));
  }
  if (!next.values.empty()) {
    html += "<div class=\"plot\" id=\"next\"></div>\n";
  }
  if (!next.steps.empty()) {
    html += "<table><thead><tr><th></th><th>command</th><th>how long</th></tr></thead><tbody>\n";
    for (std::size_t i = 0; i < next.steps.size(); ++i) {
      html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", i + 1, escaped(next.steps[i].first),
                          escaped(next.steps[i].second));
    }
    html += "</tbody></table>\n";
  }
  return html + "</section>\n";
}

std::string improved_section(const Diagnosis& diagnosis) {
  if (diagnosis.improved_text.empty()) {
    return {};
  }
  return fmt::format(
      "<section><details><summary>The improved diagram as text</summary>\n<pre>{}</pre></details>"
      "</section>\n",
      escaped(diagnosis.improved_text));
}

}  // namespace hysteron::diagnosis::report
