#include "plots/page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plots/json_text.hpp"
#include "plots/thinned.hpp"
#include "support/markup.hpp"

namespace hysteron::plots {
namespace {

constexpr const char* content_policy = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// Numbers in a figure: some ten bytes each. Above it, a curve is thinned to its extremes.
constexpr std::size_t most_numbers = 1'500'000;

std::string_view word_of(Stroke stroke) {
  return stroke == Stroke::Steps ? "steps" : stroke == Stroke::Dots ? "dots" : "line";
}

std::vector<double> picked(const std::vector<double>& values, const std::vector<std::size_t>& rows) {
  std::vector<double> result;
  result.reserve(rows.size());
  for (const std::size_t k : rows) {
    result.push_back(values[k]);
  }
  return result;
}

/// Thinned where the figure would be too large, so that each of its curves has its share.
Figure fitting(const Figure& figure, bool& was_thinned) {
  std::size_t numbers = 0;
  std::size_t curves = 0;
  for (const FigurePanel& panel : figure.panels) {
    for (const Curve& curve : panel.curves) {
      numbers += curve.y.size();
      ++curves;
    }
  }
  Figure result = figure;
  was_thinned = numbers > most_numbers;
  for (std::size_t i = 0; was_thinned && i < result.panels.size(); ++i) {
    for (Curve& curve : result.panels[i].curves) {
      const auto rows = thinned(curve.x, curve.y, most_numbers / (12 * curves));  // six rows a group, x and y
      curve.x = picked(curve.x, rows);
      curve.y = picked(curve.y, rows);
    }
  }
  return result;
}

std::string curve_json(const Curve& curve, std::vector<const std::vector<double>*>& grids) {
  const auto known = std::ranges::find_if(grids, [&](const auto* grid) { return *grid == curve.x; });
  const auto grid = known - grids.begin();
  if (known == grids.end()) {
    grids.push_back(&curve.x);
  }
  return fmt::format(R"({{"name":{},"kind":"c{}","stroke":"{}","x":{},"y":{}{}}})", text_of(curve.name),
                     curve.colour % 8, word_of(curve.stroke), grid, array_of(curve.y),
                     curve.errors.empty() ? std::string() : ",\"errors\":" + array_of(curve.errors));
}

std::string figure_json(const Figure& figure) {
  std::vector<const std::vector<double>*> grids;
  const std::string panels = json_list(figure.panels, [&](const FigurePanel& panel) {
    return fmt::format(R"({{"title":{},"xLabel":{},"yLabel":{},"curves":{}}})", text_of(panel.title),
                       text_of(panel.x_label), text_of(panel.y_label),
                       json_list(panel.curves, [&](const Curve& curve) { return curve_json(curve, grids); }));
  });
  const std::vector<std::pair<std::string, double>> none;
  return fmt::format(
      R"({{"title":{},"plane":{},"panels":{},"grids":{},"names":{},"shades":{}}})", text_of(figure.title),
      !figure.over_time, panels, json_list(grids, [](const auto* grid) { return time_of(*grid); }),
      json_list(figure.panels.empty() ? none : figure.panels.front().x_names,
                [](const auto& name) { return fmt::format("[{},{}]", text_of(name.first), number_of(name.second)); }),
      json_list(figure.stretches, [](const Stretch& stretch) {
        return fmt::format(R"({{"begin":{},"end":{},"name":{}}})", number_of(stretch.begin), number_of(stretch.end),
                           text_of(stretch.name));
      }));
}

}  // namespace

std::string page_text(const Page& page) {
  const std::string drawing =
      page.script.empty() ? std::string()
                          : fmt::format("<svg id=\"pen\" hidden=\"hidden\"></svg>\n{}<script>\n{}{}{}</script>\n",
                                        page.data, plot_script(), zoom_script(), page.script);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{}</title>\n<style>\n{}{}</style></head>\n<body><main>\n<h1>{}</h1>\n{}"
      "{}</main>\n{}</body></html>\n",
      content_policy, escaped(page.title), style(), page.style, escaped(page.title),
      page.script.empty()
          ? ""
          : "<p id=\"fault\" hidden=\"hidden\"></p>\n<noscript><p class=\"box warnings\">The plots need "
            "JavaScript; text and tables do not.</p></noscript>\n",
      page.body, drawing);
}

std::string FigurePage::place(const Figure& figure) {
  bool was_thinned = false;
  const Figure fit = fitting(figure, was_thinned);
  figures_ += (count_ == 0 ? "" : ",\n") + figure_json(fit);
  return fmt::format(
      "<section>{}{}<div class=\"plot\" id=\"figure-{}\"></div></section>\n",
      figure.title.empty() ? std::string() : fmt::format("<h2>{}</h2>\n", escaped(figure.title)),
      was_thinned
          ? "<p class=\"note\">So many rows that the page holds their extremes alone: the least and the largest "
            "value of neighbours.</p>\n"
          : "",
      count_++);
}

std::string FigurePage::text(const std::string& title, const std::string& body) const {
  return page_text({.title = title,
                    .body = body,
                    .data = "<script type=\"application/json\" id=\"figures\">\n[" + figures_ + "]\n</script>\n",
                    .script = std::string(figure_script())});
}

}  // namespace hysteron::plots
