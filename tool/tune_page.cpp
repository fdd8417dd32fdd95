#include "tool/tune_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "plots/page.hpp"
#include "plots/thinned.hpp"
#include "records/statistics.hpp"
#include "support/markup.hpp"
#include "tool/tune_words.hpp"
#include "tuning/fitted_program.hpp"
#include "tuning/friction_curves.hpp"

namespace hysteron::tool {
namespace {

using plots::Curve;
using plots::Figure;

/// A loop that is narrower than this share of the range is not seen in a picture.
constexpr double least_loop = 0.02;

constexpr std::size_t colour_measured = 7;
constexpr std::size_t colour_model = 1;
constexpr std::size_t colour_residual = 0;

const Port& port_of(const TuneReport& report, std::size_t output) {
  return report.problem.program.graph.outputs[report.problem.outputs[output]];
}

/// A command that breaks between words alone: a browser breaks behind each hyphen.
std::string words_of(std::string_view command) {
  std::string html;
  while (!command.empty()) {
    const auto end = std::min(command.find(' '), command.size());
    html += fmt::format("{}<span>{}</span>", html.empty() ? "" : " ", escaped(command.substr(0, end)));
    command.remove_prefix(std::min(end + 1, command.size()));
  }
  return html;
}

std::string head_of(const TuneReport& report) {
  const OutputErrorFit& fit = report.fit;
  std::string html = "<section class=\"verdict\">\n<p class=\"summary\">";
  for (const OutputScore& score : fit.scores) {
    html += escaped(fmt::format("{}: {:.3g}{} RMSE in train{}", score.output, score.train, unit_behind(score.unit),
                                share_of(score.train, score.range)));
    html += score.test_samples > 0 ? escaped(fmt::format("; {:.3g}{} in test{}. ", score.test, unit_behind(score.unit),
                                                         share_of(score.test, score.test_range)))
                                   : std::string(". No test interval is given in [tune]. ");
  }
  html +=
      fmt::format("</p>\n<p>{} {}, {:.2g} s.</p>\n", escaped(fit.solution.message), iterations_of(fit), fit.seconds);
  if (const std::string missing = unexplained(report); !missing.empty()) {
    html += fmt::format(
        "<div class=\"box warnings\"><h2>Something is not in the model</h2>\n<p>{}</p>\n<p>This looks for the "
        "cause:</p>\n<pre class=\"command\">{}</pre></div>\n",
        escaped(missing), words_of(report.diagnose_command));
  }
  if (!fit.covariance.warnings.empty()) {
    html += "<div class=\"box warnings\"><h2>What the record tells of the parameters</h2>\n<ul>\n";
    for (const std::string& warning : fit.covariance.warnings) {
      html += fmt::format("<li>{}</li>\n", escaped(warning));
    }
    html += "</ul></div>\n";
  }
  return html + "</section>\n";
}

std::string cost_text(double factor) {
  if (!std::isfinite(factor)) {
    return "–";
  }
  return factor > 10.0 ? "more than × 10" : factor < 1.005 ? "× 1.00" : fmt::format("× {:.3g}", factor);
}

std::string start_text(const TuneReport& report, std::size_t unknown) {
  const auto& free = report.problem.parameters;
  return unknown < free.size() ? fmt::format("{:.6g}", free[unknown].start) : std::string("–");
}

std::string parameter_table(const TuneReport& report) {
  const OutputErrorFit& fit = report.fit;
  std::string html =
      "<section><h2>Parameters</h2>\n<table><thead><tr><th>parameter</th><th class=\"number\">value</th>"
      "<th class=\"number\">standard error</th><th>unit</th><th class=\"number\">at the start</th>"
      "<th class=\"number\">RMSE if it had stayed there</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < fit.names.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{:.6g}</td><td class=\"number\">{}</td><td>{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        escaped(fit.names[i]), fit.solution.x[j], error_text(fit.solution, fit.covariance.standard_errors[j], i),
        escaped(fit.units[i]), start_text(report, i), cost_text(cost_at_start(report, i)));
  }
  return html +
         "</tbody></table>\n<p class=\"note\">The last column is the cost of each parameter: the others are fitted "
         "again "
         "without it, by the parabola at the solution.</p></section>\n";
}

std::string output_table(const TuneReport& report) {
  std::string html =
      "<section><h2>Train and test</h2>\n<table><thead><tr><th>output</th><th class=\"number\">before the fit</th>"
      "<th class=\"number\">in train</th><th class=\"number\">samples</th><th class=\"number\">in test</th>"
      "<th class=\"number\">samples</th><th class=\"number\">range</th></tr></thead><tbody>\n";
  for (const OutputScore& score : report.fit.scores) {
    const auto cell = [&](double error, double range) {
      return std::isnan(error)
                 ? std::string("–")
                 : escaped(fmt::format("{:.4g}{}{}", error, unit_behind(score.unit), share_of(error, range)));
    };
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{:.4g}{}</td></tr>\n",
        escaped(score.output), cell(score.before, score.range), cell(score.train, score.range), score.train_samples,
        cell(score.test, score.test_range), score.test_samples, score.range, escaped(unit_behind(score.unit)));
  }
  return html + "</tbody></table></section>\n";
}

/// Where the rows of train and test lie in time.
std::vector<plots::Stretch> stretches_of(const Experiment& experiment) {
  std::vector<plots::Stretch> stretches;
  const auto add = [&](const std::vector<records::RowRange>& ranges, const char* name) {
    for (const records::RowRange& rows : ranges) {
      if (rows.size() > 0 && rows.size() < experiment.time.size()) {
        stretches.push_back(
            {.begin = experiment.time[rows.first], .end = experiment.time[rows.last - 1], .name = name});
      }
    }
  };
  add(experiment.train, "train");
  add(experiment.test, "test");
  return stretches;
}

Figure over_time(const TuneReport& report, std::size_t record) {
  const Experiment& experiment = report.problem.experiments[record];
  Figure figure{.title = experiment.name, .stretches = stretches_of(experiment)};
  for (std::size_t output = 0; output < report.problem.outputs.size(); ++output) {
    const Port& port = port_of(report, output);
    const std::string label = plots::axis_label(port.name, port.unit);
    figure.panels.push_back(
        {.title = port.name,
         .x_label = "t [s]",
         .y_label = label,
         .curves = {
             {.name = "measured", .x = experiment.time, .y = experiment.measured[output], .colour = colour_measured},
             {.name = "model", .x = experiment.time, .y = report.fit.model[record][output], .colour = colour_model}}});
    figure.panels.push_back({.title = "Residual of " + port.name,
                             .x_label = "t [s]",
                             .y_label = label,
                             .curves = {{.name = "model − measured",
                                         .x = experiment.time,
                                         .y = residuals_of(report, record, output),
                                         .colour = colour_residual}}});
  }
  return figure;
}

/// Each output over each input with which it makes a loop.
std::vector<Figure> loops_of(const TuneReport& report, std::size_t record) {
  const Experiment& experiment = report.problem.experiments[record];
  const Graph& graph = report.problem.program.graph;
  std::vector<Figure> figures;
  for (std::size_t output = 0; output < report.problem.outputs.size(); ++output) {
    const Port& port = port_of(report, output);
    for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
      const Port& input = graph.inputs[i];
      const Signal& u = experiment.drive.inputs[i];
      const Signal& y = experiment.measured[output];
      if (input.type != Type::Real || u.size() != y.size() || records::loop_width(u, y) < least_loop) {
        continue;
      }
      figures.push_back(
          {.title = fmt::format("{} over {} in {}", port.name, input.name, experiment.name),
           .panels =
               {{.x_label = plots::axis_label(input.name, input.unit),
                 .y_label = plots::axis_label(port.name, port.unit),
                 .curves = {{.name = "measured", .x = u, .y = y, .colour = colour_measured},
                            {.name = "model", .x = u, .y = report.fit.model[record][output], .colour = colour_model}}}},
           .over_time = false});
    }
  }
  return figures;
}

/// The force of each friction of the fitted diagram over its velocity.
std::vector<Figure> frictions_of(const TuneReport& report) {
  std::vector<Figure> figures;
  const Experiment& experiment = report.problem.experiments.front();
  for (FrictionCurve& one : friction_curves(fitted_program(report.problem, report.fit.solution.x), experiment.drive)) {
    figures.push_back({.title = fmt::format("Force of {} over velocity in {}", one.block, experiment.name),
                       .panels = {{.x_label = plots::axis_label("velocity", one.velocity_unit),
                                   .y_label = plots::axis_label("force", one.force_unit),
                                   .curves = {{.name = "model",
                                               .x = std::move(one.velocity),
                                               .y = std::move(one.force),
                                               .colour = colour_model}}}},
                       .over_time = false});
  }
  return figures;
}

}  // namespace

std::string tune_page(const TuneReport& report) {
  plots::FigurePage page;
  std::string body = head_of(report) + parameter_table(report) + output_table(report);
  for (std::size_t record = 0; record < report.problem.experiments.size(); ++record) {
    body += page.place(over_time(report, record));
    for (const Figure& loop : loops_of(report, record)) {
      body += page.place(loop);
    }
  }
  for (const Figure& friction : frictions_of(report)) {
    body += page.place(friction);
  }
  return page.text("Fit of " + report.problem.program.graph.name, body);
}

}  // namespace hysteron::tool
