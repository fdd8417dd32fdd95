// A figure as SVG: names and units, gaps, steps, and pictures of records that are too large to draw whole.
#include "plots/figure_svg.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/numbers.hpp"

namespace hysteron::plots {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Figure figure_of(std::vector<double> x, std::vector<double> y, Stroke stroke = Stroke::Line) {
  return {.title = "log.csv",
          .panels = {{.title = "Y",
                      .x_label = "t [s]",
                      .y_label = "Y [um]",
                      .curves = {{.name = "log.csv", .x = std::move(x), .y = std::move(y), .stroke = stroke}}}}};
}

std::string svg_of(const Figure& figure) {
  return figures_svg(std::vector{figure});
}

/// The d of the curves: paths without a fill that are not axes.
std::string curve_of(const std::string& svg) {
  const auto at = svg.find("stroke-linejoin");
  const auto begin = svg.rfind("d=\"", at) + 3;
  return svg.substr(begin, svg.find('"', begin) - begin);
}

TEST(FigureSvg, AxesHaveNamesUnitsAndRoundNumbers) {
  const std::string svg = svg_of(figure_of({0.0, 1.0, 2.0}, {0.0, 10.0, 5.0}));
  EXPECT_THAT(svg, AllOf(HasSubstr(">t [s]<"), HasSubstr(">Y [um]<"), HasSubstr(">0.4<"), HasSubstr(">10<")));
  EXPECT_EQ(svg, svg_of(figure_of({0.0, 1.0, 2.0}, {0.0, 10.0, 5.0}))) << "same input, same bytes";
}

TEST(FigureSvg, NotANumberIsAGapAndALonePointADot) {
  const std::string curve = curve_of(svg_of(figure_of({0, 1, 2, 3, 4, 5}, {0, 1, not_a_number, 2, infinity, 1})));
  EXPECT_EQ(std::ranges::count(curve, 'M'), 3);
  EXPECT_THAT(curve, AllOf(HasSubstr("h0"), Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
}

TEST(FigureSvg, StepsAreHeldUntilTheNextValue) {
  const auto corners = [](Stroke stroke) {
    const std::string curve = curve_of(svg_of(figure_of({0, 1, 2, 3}, {0, 1, 1, 0}, stroke)));
    return std::ranges::count(curve, 'L');
  };
  EXPECT_EQ(corners(Stroke::Line), 3);
  EXPECT_EQ(corners(Stroke::Steps), 4);  // across, up, across, down
}

TEST(FigureSvg, ALargeRecordIsSmallAndKeepsItsPeak) {
  std::vector<double> x(1000000);
  std::vector<double> y(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = static_cast<double>(k);
    y[k] = k == 543210 ? 100.0 : std::sin(0.01 * static_cast<double>(k));
  }
  Figure figure = figure_of(x, y);
  EXPECT_LT(svg_of(figure).size(), 200000U);
  EXPECT_THAT(svg_of(figure), HasSubstr(">100<"));
  // A loop that is passed a thousand times is drawn once.
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = std::cos(0.001 * 6.283185307179586 * static_cast<double>(k));
    y[k] = std::sin(0.001 * 6.283185307179586 * static_cast<double>(k));
  }
  figure = figure_of(x, y);
  figure.over_time = false;
  EXPECT_LT(svg_of(figure).size(), 60000U);
}

TEST(FigureSvg, NamesOfAFileBreakNothing) {
  Figure figure = figure_of({0, 1}, {0, 1});
  figure.title = figure.panels[0].title = figure.panels[0].y_label = "<a&\"\x01\xff";
  const std::string svg = svg_of(figure);
  EXPECT_THAT(svg,
              AllOf(HasSubstr("&lt;a&amp;"), Not(HasSubstr("<a&")), Not(HasSubstr("\x01")), Not(HasSubstr("\xff"))));
}

TEST(FigureSvg, NothingToDrawIsNoFault) {
  EXPECT_THAT(svg_of({}), HasSubstr("</svg>"));
  EXPECT_THAT(svg_of(figure_of({}, {})), HasSubstr("</svg>"));
  EXPECT_THAT(svg_of(figure_of({1.0}, {not_a_number})), Not(HasSubstr("nan")));
  EXPECT_THAT(figures_svg(std::vector{figure_of({0, 1}, {0, 1}), Figure()}), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace hysteron::plots
