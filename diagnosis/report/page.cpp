#include "diagnosis/report/page.hpp"

#include <fmt/format.h>

#include <utility>

#include "diagnosis/report/html.hpp"
#include "diagnosis/report/page_data.hpp"
#include "diagnosis/report/parts.hpp"
#include "diagnosis/report/sections.hpp"
#include "plots/page.hpp"

namespace hysteron::diagnosis {
namespace {

using report::escaped;

/// A place for what the script draws once it is open; the first of a section is.
std::string folded(bool is_open, const std::string& summary, const std::string& id) {
  return fmt::format(
      "<details class=\"trace\"{}><summary>{}</summary>\n<div class=\"plot\" id=\"{}\"></div></details>\n",
      is_open ? " open" : "", escaped(summary), id);
}

std::string traces_section(const Diagnosis& diagnosis) {
  if (diagnosis.traces.empty()) {
    return {};
  }
  std::string html = "<section class=\"traces\"><h2>Residual over time</h2>\n";
  for (std::size_t i = 0; i < diagnosis.traces.size(); ++i) {
    const Trace& trace = diagnosis.traces[i];
    html += folded(i == 0, fmt::format("{}: {}", trace.record, report::with_unit(trace.signal, trace.unit)),
                   fmt::format("trace-{}", i));
  }
  return html + "</section>\n";
}

/// Where a hysteresis lies between an input and an output: the one over the other.
std::string loops_section(const Diagnosis& diagnosis) {
  std::string html;
  for (std::size_t i = 0; i < diagnosis.traces.size(); ++i) {
    const Trace& trace = diagnosis.traces[i];
    if (!trace.over.name.empty()) {
      html += folded(html.empty(),
                     fmt::format("{}: {} over {}", trace.record, report::with_unit(trace.signal, trace.unit),
                                 report::with_unit(trace.over.name, trace.over.unit)),
                     fmt::format("loop-{}", i));
    }
  }
  return html.empty() ? html : "<section class=\"loops\"><h2>Output over input</h2>\n" + html + "</section>\n";
}

/// A friction is known by its force over the velocity.
std::string frictions_section(const Diagnosis& diagnosis) {
  std::string html;
  for (std::size_t i = 0; i < diagnosis.frictions.size(); ++i) {
    html += folded(i == 0, diagnosis.frictions[i].block, fmt::format("friction-{}", i));
  }
  return html.empty() ? html : "<section class=\"frictions\"><h2>Friction over velocity</h2>\n" + html + "</section>\n";
}

std::string maps_section(const Diagnosis& diagnosis) {
  if (diagnosis.maps.empty()) {
    return {};
  }
  return "<section class=\"maps\"><h2>What the residual depends on</h2>\n<div id=\"maps\"></div></section>\n";
}

}  // namespace

std::string report_page(const Diagnosis& diagnosis, const Program& improved) {
  const std::string& name = improved.graph.name;
  const std::string title = "Diagnosis of " + (name.empty() ? std::string("a diagram") : name);
  std::string html;
  const std::string gap = report::gap_section(diagnosis);
  html += fmt::format("<div class=\"{}\">\n{}{}</div>\n", gap.empty() ? "head" : "head two",
                      report::verdict_section(diagnosis), gap);
  html += report::missing_section(diagnosis);
  html += report::families_section(diagnosis);
  html += report::budget_section(diagnosis);
  html += report::effects_section(diagnosis);
  html += report::split_section(diagnosis);
  html += report::where_section(diagnosis, improved.graph);
  html += traces_section(diagnosis);
  html += loops_section(diagnosis);
  html += frictions_section(diagnosis);
  html += maps_section(diagnosis);
  html += report::rivals_section(diagnosis);
  html += report::next_section(diagnosis);
  html += report::calibration_section(diagnosis);
  html += report::improved_section(diagnosis);
  html += fmt::format("<footer>{} candidates tried in {} s.</footer>\n", diagnosis.tried,
                      report::figure(diagnosis.seconds, 2));
  return plots::page_text({.title = title,
                           .style = std::string(report::style()),
                           .body = std::move(html),
                           .data = fmt::format("<script type=\"application/json\" id=\"data\">\n{}\n</script>\n",
                                               report::page_data(diagnosis)),
                           .script = std::string(report::page_script())});
}

}  // namespace hysteron::diagnosis
