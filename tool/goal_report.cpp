#include "tool/goal_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "codegen/graph/port_t.hpp"
#include "plots/page.hpp"
#include "records/csv.hpp"
#include "support/markup.hpp"
#include "tool/goal_words.hpp"
#include "tuning/goal/goal_json.hpp"

namespace hysteron::tool {
namespace {

using plots::Curve;
using plots::Figure;

constexpr std::size_t colour_wished = 7;
/// Of the plane: beyond it nothing tells of stability.
constexpr double largest_open_loop = 3.0;

std::vector<double> times(const GoalProblem& problem) {
  std::vector<double> t(problem.drive.steps);
  for (std::size_t k = 0; k < t.size(); ++k) {
    t[k] = (static_cast<double>(k) - static_cast<double>(problem.begin)) * problem.drive.sample_time;
  }
  return t;
}

std::size_t colour_of(std::size_t plant) {
  return plant % colour_wished;
}

/// The response, and the effort below it.
Figure over_time(const GoalProblem& problem, const GoalResult& result) {
  const std::vector<double> t = times(problem);
  const Port& output = problem.graph().outputs[problem.output];
  plots::FigurePanel response{
      .title = "Response", .x_label = "t [s]", .y_label = plots::axis_label(output.name, output.unit)};
  plots::FigurePanel effort{
      .title = "Effort", .x_label = "t [s]", .y_label = plots::axis_label(problem.effort, problem.effort_unit)};
  response.curves.push_back({.name = "wished", .x = t, .y = problem.wished, .colour = colour_wished});
  for (std::size_t plant = 0; plant < result.plants.size(); ++plant) {
    const PlantResult& one = result.plants[plant];
    response.curves.push_back({.name = one.name, .x = t, .y = one.response.output, .colour = colour_of(plant)});
    effort.curves.push_back({.name = one.name,
                             .x = t,
                             .y = one.response.effort,
                             .stroke = plots::Stroke::Steps,
                             .colour = colour_of(plant)});
  }
  Figure figure{.title = "The tuned loop", .panels = {std::move(response)}};
  if (!problem.effort.empty()) {
    figure.panels.push_back(std::move(effort));
  }
  return figure;
}

/// L in the plane, with the critical point, the unit circle, and the circle about −1 that a limit of Ms keeps free.
Figure nyquist(const GoalProblem& problem, const GoalResult& result) {
  plots::FigurePanel plane{.title = "Open loop, Nyquist", .x_label = "Re L", .y_label = "Im L"};
  const auto circle = [](const std::string& name, double centre, double radius, std::size_t colour) {
    Curve curve{.name = name, .colour = colour};
    for (int k = 0; k <= 120; ++k) {
      curve.x.push_back(centre + radius * std::cos(k * std::numbers::pi / 60.0));
      curve.y.push_back(radius * std::sin(k * std::numbers::pi / 60.0));
    }
    return curve;
  };
  plane.curves.push_back(circle("unit circle", 0.0, 1.0, colour_wished));
  if (problem.settings.sensitivity) {
    plane.curves.push_back(circle("limit of Ms", -1.0, 1.0 / problem.settings.sensitivity->value, colour_wished - 1));
  }
  for (std::size_t plant = 0; plant < result.plants.size(); ++plant) {
    Curve curve{.name = result.plants[plant].name, .colour = colour_of(plant)};
    for (const FrequencyPoint& point : result.plants[plant].frequencies) {
      if (std::abs(point.open_loop()) <= largest_open_loop) {
        curve.x.push_back(point.open_loop().real());
        curve.y.push_back(point.open_loop().imag());
      }
    }
    plane.curves.push_back(std::move(curve));
  }
  return {.title = "How near the loop is to −1", .panels = {std::move(plane)}, .over_time = false};
}

Figure over_frequency(const GoalResult& result) {
  plots::FigurePanel sensitivity{
      .title = "Sensitivity |S|", .x_label = "log10 of the frequency in rad/s", .y_label = "|S| [dB]"};
  plots::FigurePanel open_loop{
      .title = "Open loop |L|", .x_label = "log10 of the frequency in rad/s", .y_label = "|L| [dB]"};
  for (std::size_t plant = 0; plant < result.plants.size(); ++plant) {
    Curve size{.name = result.plants[plant].name, .colour = colour_of(plant)};
    Curve loop = size;
    for (const FrequencyPoint& point : result.plants[plant].frequencies) {
      size.x.push_back(std::log10(point.frequency));
      size.y.push_back(20.0 * std::log10(std::abs(point.sensitivity)));
      loop.x.push_back(size.x.back());
      loop.y.push_back(20.0 * std::log10(std::abs(point.open_loop())));
    }
    sensitivity.curves.push_back(std::move(size));
    open_loop.curves.push_back(std::move(loop));
  }
  return {.title = "Over the frequency", .panels = {std::move(sensitivity), std::move(open_loop)}};
}

std::string table_html(const std::string& title, const TextTable& table) {
  std::string html = fmt::format("<section><h2>{}</h2>\n<table><thead><tr>", escaped(title));
  for (const std::string& head : table.heads) {
    html += fmt::format("<th>{}</th>", escaped(head));
  }
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) {
      html += fmt::format("<td>{}</td>", escaped(cell));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></section>\n";
}

std::string ended(const GoalResult& result) {
  return fmt::format("{} {} iteration{}, {} runs of the loop, {:.2f} s.", result.message, result.iterations,
                     result.iterations == 1 ? "" : "s", result.evaluations, result.seconds);
}

std::string goal_page(const GoalProblem& problem, const GoalResult& result) {
  plots::FigurePage page;
  std::string body = fmt::format("<section class=\"verdict\">\n<p class=\"summary\">{}</p>\n<p>{}</p>\n",
                                 escaped(ended(result)), escaped(goal_sentence(problem)));
  for (const std::string& remark : goal_remarks(problem, result)) {
    body += fmt::format("<p>{}</p>\n", escaped(remark));
  }
  body += "</section>\n" + table_html("Parameters", tuned_table(problem, result)) +
          table_html("What the loop does", figure_table(problem, result));
  if (!result.limits.empty()) {
    body += table_html("Limits", limit_table(problem, result));
  }
  body += page.place(over_time(problem, result));
  if (!result.plants.front().frequencies.empty()) {
    body += page.place(nyquist(problem, result)) + page.place(over_frequency(result));
  }
  return page.text("Tuning of " + problem.graph().name, body);
}

}  // namespace

std::string goal_text(const GoalProblem& problem, const GoalResult& result) {
  std::string text = as_text(tuned_table(problem, result)) + "\n" + goal_sentence(problem) + "\n\n" +
                     as_text(figure_table(problem, result)) + "\n";
  if (!result.limits.empty()) {
    text += as_text(limit_table(problem, result)) + "\n";
  }
  for (const std::string& remark : goal_remarks(problem, result)) {
    text += remark + "\n";
  }
  return text + ended(result) + "\n";
}

std::vector<std::filesystem::path> goal_report_paths(const std::filesystem::path& folder, std::size_t plants) {
  std::vector<std::filesystem::path> paths{folder / "report.html", folder / "report.json"};
  for (std::size_t plant = 0; plant < plants; ++plant) {
    paths.push_back(folder / (plant == 0 ? std::string("response.csv") : fmt::format("response-{}.csv", plant + 1)));
  }
  return paths;
}

std::vector<OutputFile> goal_report_files(const std::filesystem::path& folder, const GoalProblem& problem,
                                          const GoalResult& result) {
  std::vector<std::string> contents{goal_page(problem, result), goal_json(problem, result).dump(2) + "\n"};
  const Port& input = problem.graph().inputs[problem.input];
  const Port& output = problem.graph().outputs[problem.output];
  for (const PlantResult& plant : result.plants) {
    std::vector<records::Column> columns{{input.name, input.unit, problem.drive.inputs[problem.input]},
                                         {output.name, output.unit, plant.response.output},
                                         {output.name + "_WISHED", output.unit, problem.wished}};
    if (!problem.effort.empty()) {
      columns.push_back({problem.effort, problem.effort_unit, plant.response.effort});
    }
    records::Record record(times(problem), problem.drive.sample_time, std::move(columns), {});
    record.set_beside_t(port_called_t(problem.graph()) != nullptr);
    contents.push_back(records::csv_text(record));
  }
  const auto paths = goal_report_paths(folder, problem.plants.size());
  std::vector<OutputFile> files;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    files.push_back({.path = paths[i], .contents = std::move(contents[i])});
  }
  return files;
}

}  // namespace hysteron::tool
