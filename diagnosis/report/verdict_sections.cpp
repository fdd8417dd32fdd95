#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/findings/control_loop.hpp"
#include "diagnosis/report/html.hpp"
#include "diagnosis/report/sections.hpp"

namespace hysteron::diagnosis::report {
namespace {

std::string label_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::None:
      return "No material gap";
    case Verdict::Calibration:
      return "A matter of calibration";
    case Verdict::Named:
      return "Cause named";
    case Verdict::Group:
      return "One of a group";
    case Verdict::Partial:
      return "Partly named";
    case Verdict::Unknown:
      return "Cause unknown";
  }
  return {};
}

std::string inverse_of(Inverse inverse) {
  switch (inverse) {
    case Inverse::Exact:
      return "invertible: a feedforward can take it back";
    case Inverse::Avoidable:
      return "not invertible, but a gentler reference avoids it";
    case Inverse::None:
      return "not invertible: no feedforward can take it back";
  }
  return {};
}

bool is_determined(const ParameterFinding& parameter) {
  return std::isfinite(parameter.low) || std::isfinite(parameter.high);
}

std::string interval_of(const ParameterFinding& parameter) {
  if (!is_determined(parameter)) {
    return "not determined";
  }
  const auto [low, high] = interval_ends(parameter.low, parameter.high);
  return fmt::format("{} … {}", low, high);
}

std::string parameter_table(const EffectFinding& effect) {
  if (effect.parameters.empty() && effect.settings.empty()) {
    return {};
  }
  std::string html =
      "<table><thead><tr><th>parameter</th><th class=\"number\">value</th><th class=\"number\">95 % interval</th>"
      "<th>unit</th></tr></thead><tbody>\n";
  for (const ParameterFinding& parameter : effect.parameters) {
    html += fmt::format("<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td></tr>\n",
                        escaped(parameter.name), is_determined(parameter) ? figure(parameter.value, 4) : "–",
                        interval_of(parameter), escaped(parameter.unit));
  }
  for (const SettingFinding& setting : effect.settings) {
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">chosen, not fitted</td><td>{}</td></tr>\n",
        escaped(setting.name), figure(setting.value, 4), escaped(setting.unit));
  }
  return html + "</tbody></table>\n";
}

std::string effect_card(const EffectFinding& effect, const Diagnosis& diagnosis) {
  std::string html = fmt::format(
      "<article class=\"effect\"><h3>{} <span class=\"at\">on {}</span></h3>\n<p><strong>{}</strong> of the gap "
      "that calibration leaves{}; {}.</p>\n",
      escaped(words_of(effect.id)), escaped(effect.edge), percent(effect.share),
      effect.around_plant ? " at the outputs, in the loop around the plant. That is beside the 100 % which the "
                            "other effects and what stays open make of what the plant lacks"
                          : "",
      inverse_of(effect.inverse));
  const auto list = [](const std::vector<std::string>& names) {
    return escaped(fmt::format("{}", fmt::join(names, ", ")));
  };
  if (!effect.drivers.empty()) {
    html += fmt::format("<p>Driven by {}.</p>\n", list(effect.drivers));
  }
  if (!effect.same_edges.empty()) {
    html += fmt::format("<p class=\"note\">This record cannot tell it from the same effect on {}.</p>\n",
                        list(effect.same_edges));
  }
  if (effect.inverse == Inverse::Exact && diagnosis.feedforward_text.empty()) {
    for (const std::string& reason : diagnosis.feedforward_notes) {
      html += fmt::format("<p class=\"note\">No feedforward was written all the same: {}.</p>\n", escaped(reason));
    }
  }
  return html + parameter_table(effect) + "</article>\n";
}

struct Bar {
  const char* name;
  const char* css_class;
  double rms;
};

/// Three bars and the floor as a line across them.
std::string gap_picture(const GapFinding& gap) {
  const std::array bars{Bar{"nominal", "nominal", gap.nominal}, Bar{"calibrated", "before", gap.calibrated},
                        Bar{"improved", "after", gap.improved}};
  constexpr double left = 84.0;
  constexpr double length = 300.0;
  constexpr double width = 480.0;
  double longest = gap.floor.value;
  for (const Bar& bar : bars) {
    longest = std::max(longest, std::isfinite(bar.rms) ? bar.rms : 0.0);
  }
  if (!(longest > 0.0)) {
    return {};
  }
  std::string svg = fmt::format(
      "<svg class=\"gap\" viewBox=\"0 0 {:.0f} 150\" role=\"img\" aria-label=\"RMS of the gap, nominal, calibrated and "
      "improved, against the floor\">\n",
      width);
  double y = 6.0;
  for (const Bar& bar : bars) {
    const double size = std::isfinite(bar.rms) ? length * bar.rms / longest : 0.0;
    svg += fmt::format(
        "<text class=\"row\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text><rect class=\"{}\" x=\"{:.0f}\" y=\"{:.0f}\" "
        "width=\"{:.1f}\" height=\"26\"/><text class=\"value\" x=\"{:.1f}\" y=\"{:.0f}\">{}</text>\n",
        left - 8.0, y + 18.0, bar.name, bar.css_class, left, y, std::max(size, 1.0), left + size + 8.0, y + 18.0,
        escaped(quantity(bar.rms, gap.unit)));
    y += 36.0;
  }
  const double floor = left + length * gap.floor.value / longest;
  const bool far = floor > left + 0.6 * length;
  svg += fmt::format(
      "<path class=\"floor\" d=\"M{0:.1f} 0V122\"/><text class=\"floor\" x=\"{1:.1f}\" y=\"138\" "
      "text-anchor=\"{2}\">floor {3}{4}</text>\n",
      floor, far ? floor + 4.0 : floor - 4.0, far ? "end" : "start", escaped(quantity(gap.floor.value, gap.unit)),
      gap.floor.evidence.empty() ? std::string() : ", from " + escaped(gap.floor.evidence));
  return svg + "</svg>\n";
}

std::string closed_text(const GapFinding& gap) {
  const bool interval = std::isfinite(gap.closed_low) && std::isfinite(gap.closed_high);
  const auto part = [](double share) { return percent(std::min(share, 1.0)); };  // an interval may end above 1
  return part(gap.closed) +
         (interval ? fmt::format(" ({} … {})", part(gap.closed_low), part(gap.closed_high)) : std::string());
}

std::string next_text(const GapFinding& gap) {
  if (!gap.next) {
    return {};
  }
  return fmt::format(
      " On a further record whose inputs stay where these were it will be <strong>{}</strong>, with 95 % between {} "
      "and {}.",
      escaped(quantity(gap.next->rms, gap.unit)), escaped(quantity(gap.next->low, gap.unit)),
      escaped(quantity(gap.next->high, gap.unit)));
}

std::string gap_table(const std::vector<GapFinding>& gaps) {
  if (gaps.size() < 2) {
    return {};
  }
  std::string html =
      "<table><thead><tr><th>output, RMS</th><th class=\"number\">nominal</th><th class=\"number\">calibrated</th>"
      "<th class=\"number\">improved</th><th class=\"number\">floor</th><th class=\"number\">closed</th></tr></thead>"
      "<tbody>\n";
  for (const GapFinding& gap : gaps) {
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}"
        "</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        escaped(with_unit(gap.signal, gap.unit)), figure(gap.nominal), figure(gap.calibrated), figure(gap.improved),
        figure(gap.floor.value), percent(gap.closed));
  }
  return html + "</tbody></table>\n";
}

std::string controller_row(const ControllerFinding& controller) {
  std::string text;
  if (controller.different == 0) {
    text = fmt::format("none: {} steps replayed, the same bits", controller.steps);
  } else {
    text = fmt::format("{} of {} steps give other bits than its diagram, the first is step {}", controller.different,
                       controller.steps, controller.first_different);
  }
  for (const ControllerFinding::Output& output : controller.outputs) {
    if (output.difference_rms > 0.0) {
      text += fmt::format("; {} differs by {} RMS", output.name, quantity(output.difference_rms, output.unit));
    }
    if (output.limited_rms > 0.0) {
      text += fmt::format("; limits and safe values change {} by {} RMS", output.name,
                          quantity(output.limited_rms, output.unit));
    }
  }
  return fmt::format("<tr><td>controller</td><td class=\"bar\"></td><td>{}</td></tr>\n", escaped(text));
}

std::string split_row(const char* part, double share, const std::string& percent, const char* css_class,
                      const char* what) {
  return fmt::format("<tr><td>{}</td><td class=\"bar\">{} {}</td><td>{}</td></tr>\n", part, share_bar(share, css_class),
                     percent, what);
}

}  // namespace

std::string verdict_section(const Diagnosis& diagnosis) {
  const bool refused = !diagnosis.refusals.empty();
  std::string html = "<section class=\"verdict\">\n";
  html += fmt::format("<p class=\"label {}\">{}</p>\n", refused ? "refused" : "found",
                      refused ? "Record refused" : label_of(diagnosis.verdict));
  if (!refused && !diagnosis.summary.empty()) {  // of a refusal it is the first of the reasons
    html += fmt::format("<p class=\"summary\">{}</p>\n", escaped(diagnosis.summary));
  }
  if (diagnosis.loop) {
    html += fmt::format("<p class=\"note\">{}</p>\n", escaped(sentence_of(*diagnosis.loop)));
  }
  if (!refused) {
    html += fmt::format(
        "<p class=\"confidence\"><strong>{}</strong> confidence {}</p>\n<p class=\"note\">Score of a cause outside the "
        "library: {}</p>\n",
        percent(diagnosis.confidence), share_bar(diagnosis.confidence, "after"), figure(diagnosis.unknown_score, 2));
  } else {
    html += "<div class=\"box refusals\"><h2>Why the record could not be diagnosed</h2>\n" +
            list_of(diagnosis.refusals, "refusals") + "</div>\n";
  }
  if (!diagnosis.warnings.empty()) {
    html += "<div class=\"box warnings\"><h2>Warnings</h2>\n" + list_of(diagnosis.warnings, "warnings") + "</div>\n";
  }
  return html + "</section>\n";
}

std::string effects_section(const Diagnosis& diagnosis) {
  if (diagnosis.effects.empty()) {
    return {};
  }
  std::string html = "<section class=\"effects\"><h2>Which</h2>\n<div class=\"cards\">\n";
  for (const EffectFinding& effect : diagnosis.effects) {
    html += effect_card(effect, diagnosis);
  }
  return html + "</div></section>\n";
}

std::string split_section(const Diagnosis& diagnosis) {
  if (diagnosis.effects.empty() && diagnosis.cuts.empty() && !diagnosis.controller) {
    return {};
  }
  std::string html = "<section class=\"split\"><h2>Which part</h2>\n<table><tbody>\n";
  if (diagnosis.controller) {
    html += controller_row(*diagnosis.controller);
  }
  if (!diagnosis.effects.empty()) {
    const GapSplit& split = diagnosis.split;
    const auto percents = percents_of_whole({split.input_output, split.plant, split.open});
    html += split_row("inputs and outputs", split.input_output, percents[0], "after",
                      "delay, clock, quantum and glitches on the measured wires");
    html += split_row("plant", split.plant, percents[1], "after", "all other effects");
    html += split_row("open", split.open, percents[2], "before", "no effect closes it");
  }
  for (const CutFinding& cut : diagnosis.cuts) {
    html += fmt::format("<tr><td>{}</td><td class=\"bar\"></td><td>{}</td></tr>\n", escaped(cut.signal),
                        cut.agrees ? "agrees with its column: the gap lies behind it"
                                   : "does not agree with its column: a gap lies before it");
  }
  return html + "</tbody></table></section>\n";
}

std::string gap_section(const Diagnosis& diagnosis) {
  const GapFinding& gap = diagnosis.gap;
  const std::string picture = diagnosis.refusals.empty() ? gap_picture(gap) : std::string();
  if (picture.empty()) {
    return {};
  }
  return fmt::format(
      "<section class=\"far\"><h2>How far</h2>\n<p>Gap of <strong>{}</strong>, RMS: <strong>{}</strong> of what lay "
      "above the floor is closed, on held-out blocks with 95 % interval.{}</p>\n{}{}</section>\n",
      escaped(gap.signal), closed_text(gap), next_text(gap), picture, gap_table(diagnosis.gaps));
}

std::string calibration_section(const Diagnosis& diagnosis) {
  if (diagnosis.calibration.empty()) {
    return {};
  }
  std::string html =
      "<section><h2>Known parameters, refitted</h2>\n<table><thead><tr><th>parameter</th><th "
      "class=\"number\">given</th>"
      "<th class=\"number\">refitted</th><th class=\"number\">95 % interval</th><th>unit</th></tr></thead><tbody>\n";
  for (const ParameterFinding& parameter : diagnosis.calibration) {
    const auto given = std::find_if(diagnosis.nominal.begin(), diagnosis.nominal.end(),
                                    [&](const ParameterFinding& one) { return one.name == parameter.name; });
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td>{}</td></tr>\n",
        escaped(parameter.name), given == diagnosis.nominal.end() ? std::string("–") : figure(given->value, 4),
        figure(parameter.value, 4), interval_of(parameter), escaped(parameter.unit));
  }
  return html + "</tbody></table></section>\n";
}

}  // namespace hysteron::diagnosis::report
