#include "fleet/report/fleet_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fleet/report/small_plot.hpp"
#include "fleet/report/words.hpp"
#include "fleet/when.hpp"
#include "plots/figure.hpp"
#include "plots/page.hpp"
#include "support/markup.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view sheet = R"css(
.machines { display: grid; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); gap: .5rem; }
.machine, article.found { background: var(--card); border: 1px solid var(--line); border-radius: .3rem; padding: .5rem .7rem; }
article.found { margin: 0 0 .8rem; }
article.found h3, .machine h3 { margin: 0 0 .2rem; overflow-wrap: anywhere; }
.machine.marked { border-left: 4px solid var(--before); }
.plots { display: flex; flex-wrap: wrap; gap: .6rem 1.2rem; }
figure { margin: 0; max-width: 100%; } figure svg { max-width: 100%; height: auto; display: block; }
figcaption { font-size: .87rem; color: var(--soft); overflow-wrap: anywhere; }
.spark { display: flex; align-items: center; gap: .5rem; font-size: .82rem; font-variant-numeric: tabular-nums; }
.spark svg { flex: none; } .spark span { overflow-wrap: anywhere; }
.bars { fill: none; stroke: var(--soft); stroke-width: 1; } .dots { stroke: var(--after); stroke-width: 4.5; stroke-linecap: round; fill: none; }
figure svg text { font-size: 11px; }
a { color: var(--after); } ul.summary { list-style: none; padding: 0; font-size: 1.05rem; font-weight: 400; }
ul.summary b { font-weight: 600; } ul.summary li { margin: .15rem 0; }
.records { font-size: .82rem; } td { overflow-wrap: anywhere; }
)css";

/// Of more machines than this the top names the surest; the section below has all.
constexpr std::size_t most_at_the_top = 10;

/// A smaller one is a number of the formula, not a chance that anyone knows.
constexpr double least_p = 1e-9;

class FleetPage {
 public:
  FleetPage(const Analysis& all, const std::vector<Row>& rows, fs::path folder)
      : all_(all), rows_(rows), folder_(std::move(folder)) {
    for (const Finding& finding : all.findings) {
      if (found_.empty() || found_.back().front()->machine != finding.machine) {
        found_.emplace_back();
      }
      found_.back().push_back(&finding);
    }
    for (std::size_t i = 0; i < all.tracks.size(); ++i) {
      tracks_[all.tracks[i].machine].push_back(i);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      records_[rows[i].unit.machine].push_back(i);
    }
  }

  [[nodiscard]] std::string body() const { return top() + findings() + failures() + parameters() + machines() + how(); }

 private:
  [[nodiscard]] std::string link(std::size_t row) const {
    const fs::path unit = folder_of(folder_, rows_[row].key);
    const bool has_page = rows_[row].result.status == Status::Done && rows_[row].unit.command != Command::Check;
    return (unit / (has_page ? "report.html" : "messages.txt")).generic_string();
  }

  [[nodiscard]] std::string records_of(const std::string& machine) const {
    std::string html;
    std::size_t number = 0;
    for (const std::size_t row : records_.at(machine)) {
      ++number;
      const Unit& unit = rows_[row].unit;
      html += fmt::format("{}<a href=\"{}\">{}</a>", html.empty() ? "" : ", ", escaped(link(row)),
                          unit.when.empty() ? std::to_string(number) : escaped(unit.when));
    }
    return html;
  }

  [[nodiscard]] std::string top() const {
    std::string html = "<section><p class=\"summary\">";
    for (const std::string& one : headline(all_, rows_)) {
      html += escaped(one) + " ";
    }
    html += "</p>\n<ul class=\"summary\">\n";
    for (std::size_t i = 0; i < std::min(found_.size(), most_at_the_top); ++i) {
      html += fmt::format("<li><b>{}:</b> {}</li>\n", escaped(found_[i].front()->machine),
                          escaped(sentence(all_, *found_[i].front())));
    }
    html += "</ul>\n";
    if (found_.size() > most_at_the_top) {
      html += fmt::format("<p class=\"note\">These are the {} surest; all {} follow.</p>\n", most_at_the_top,
                          found_.size());
    }
    return html + "</section>\n";
  }

  [[nodiscard]] std::string large_plot(std::size_t index) const {
    const Track& track = all_.tracks[index];
    const Parameter& parameter = all_.parameters[track.parameter];
    std::vector<std::string> links;
    for (const std::size_t row : track.rows) {
      links.push_back(link(row));
    }
    return fmt::format("<figure><figcaption>{}</figcaption>{}</figure>\n",
                       escaped(plots::axis_label(parameter.name, parameter.unit)),
                       small_plot(track, parameter, 360, 140, links));
  }

  [[nodiscard]] std::string findings() const {
    if (found_.empty()) {
      return "";
    }
    std::string html =
        "<section><h2>What drifts or stands out</h2>\n<p class=\"note\">The shaded band is that of the siblings: "
        "median ± 3 "
        "standard deviations. Bars are intervals of 95 %. A dot leads to the report of its record.</p>\n";
    for (const auto& of_machine : found_) {
      const std::string& machine = of_machine.front()->machine;
      html += fmt::format("<article class=\"found\"><h3>{}</h3>\n", escaped(machine));
      std::vector<std::size_t> shown;
      for (const Finding* finding : of_machine) {
        html += fmt::format("<p>{} <span class=\"note\">p {}</span></p>\n", escaped(sentence(all_, *finding)),
                            finding->p < least_p ? std::string("&lt; 1e-9") : fmt::format("= {:.1g}", finding->p));
        if (finding->what != Finding::What::Effect && std::ranges::find(shown, finding->index) == shown.end()) {
          shown.push_back(finding->index);
        }
      }
      html += "<div class=\"plots\">\n";
      for (const std::size_t index : shown) {
        html += large_plot(index);
      }
      html += fmt::format("</div>\n<p class=\"records\">Records: {}</p></article>\n", records_of(machine));
    }
    return html + "</section>\n";
  }

  [[nodiscard]] std::string failures() const {
    if (all_.failures.empty()) {
      return "";
    }
    std::string html =
        "<section><h2>Records without a result</h2>\n<table><thead><tr><th>machine</th><th>when</th><th>command</th>"
        "<th>status</th><th>reason</th></tr></thead><tbody>\n";
    for (const std::size_t row : all_.failures) {
      const Unit& unit = rows_[row].unit;
      const Result& result = rows_[row].result;
      const bool is_open = result.status == Status::Open;
      html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", escaped(unit.machine),
                          escaped(unit.when), name_of(unit.command),
                          is_open ? std::string("open")
                                  : fmt::format("<a href=\"{}\">{}</a>", escaped(link(row)), name_of(result.status)),
                          is_open ? std::string("not worked yet") : escaped(result.reason));
    }
    return html + "</tbody></table></section>\n";
  }

  [[nodiscard]] std::string parameters() const {
    if (all_.parameters.empty()) {
      return "";
    }
    std::string html =
        "<section><h2>Parameters of the fleet</h2>\n<p class=\"note\">A dot is a machine, by the median of its "
        "records; "
        "orange ones have a finding.</p>\n<div class=\"plots\">\n";
    for (const Parameter& one : all_.parameters) {
      html += fmt::format(
          "<figure><figcaption>{}, {}: median {}{} of {} machine{}</figcaption>{}</figure>\n", escaped(one.kind.group),
          escaped(plots::axis_label(one.name, one.unit)), fmt::format("{:.4g}", one.median),
          std::isfinite(one.deviation) ? fmt::format(", standard deviation {:.2g}", one.deviation) : std::string(),
          one.tracks.size(), one.tracks.size() == 1 ? "" : "s", strip_plot(all_, one, 360, 60));
    }
    return html + "</div></section>\n";
  }

  [[nodiscard]] std::string machines() const {
    std::string html = fmt::format("<section><details{}><summary>All {} machines</summary>\n<div class=\"machines\">\n",
                                   all_.machines.size() <= 50 ? " open" : "", all_.machines.size());
    for (const std::string& machine : all_.machines) {
      std::string lines;
      bool marked = false;
      const auto known = tracks_.find(machine);
      for (const std::size_t i : known == tracks_.end() ? std::vector<std::size_t>() : known->second) {
        const Track& track = all_.tracks[i];
        const Parameter& parameter = all_.parameters[track.parameter];
        marked = marked || track.changes || track.stands_out;
        lines +=
            fmt::format("<div class=\"spark\">{}<span>{} {}</span></div>\n", small_plot(track, parameter, 110, 28),
                        escaped(parameter.name), escaped(quantity(fmt::format("{:.4g}", track.level), parameter.unit)));
      }
      html += fmt::format(
          "<div class=\"machine{}\"><h3>{}</h3>{}<details><summary class=\"records\">{} record{}</summary>"
          "<p class=\"records\">{}</p></details></div>\n",
          marked ? " marked" : "", escaped(machine), lines, records_.at(machine).size(),
          records_.at(machine).size() == 1 ? "" : "s", records_of(machine));
    }
    return html + "</div></details></section>\n";
  }

  [[nodiscard]] std::string how() const {
    std::string html = "<section><h2>How this was decided</h2>\n<ul>\n";
    for (const std::string& one : method(all_)) {
      html += fmt::format("<li>{}</li>\n", escaped(one));
    }
    return html + "</ul></section>\n";
  }

  const Analysis& all_;
  const std::vector<Row>& rows_;
  fs::path folder_;
  std::vector<std::vector<const Finding*>> found_;  ///< by machine
  std::map<std::string, std::vector<std::size_t>> tracks_;
  std::map<std::string, std::vector<std::size_t>> records_;
};

}  // namespace

std::string fleet_page(const Analysis& all, const std::vector<Row>& rows, const fs::path& folder) {
  return plots::page_text(
      {.title = "Report of the fleet", .style = std::string(sheet), .body = FleetPage(all, rows, folder).body()});
}

}  // namespace hysteron::fleet
