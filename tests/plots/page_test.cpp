// A page of figures: it stands alone, runs without a fault, and is zoomed by drags and by keys.
#include "plots/page.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/numbers.hpp"
#include "tests/support/in_browser.hpp"

namespace hysteron::plots {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using PageOfFigures = hysteron::test::InBrowser;
using hysteron::test::expect_no_fault;
using hysteron::test::shown;
using hysteron::test::Shown;

/// Two panels over time with a gap and steps, a loop, and points with bars over names.
std::string rich_page() {
  std::vector<double> t(1001);
  std::vector<double> u(t.size());
  std::vector<double> y(t.size());
  std::vector<double> b(t.size());
  for (std::size_t k = 0; k < t.size(); ++k) {
    t[k] = 0.01 * static_cast<double>(k);
    u[k] = std::sin(t[k]);
    y[k] = std::sin(t[k] - 0.3);
    b[k] = k < 500 ? 0.0 : 1.0;
  }
  y[300] = not_a_number;
  const Figure over_time{.title = "log.csv",
                         .panels = {{.title = "Y",
                                     .x_label = "t [s]",
                                     .y_label = "Y [um]",
                                     .curves = {{.name = "measured", .x = t, .y = y, .colour = 7},
                                                {.name = "model", .x = t, .y = u, .colour = 1}}},
                                    {.title = "B",
                                     .x_label = "t [s]",
                                     .y_label = "B",
                                     .curves = {{.name = "measured", .x = t, .y = b, .stroke = Stroke::Steps}}}},
                         .stretches = {{.begin = 0.0, .end = 5.0, .name = "train"}}};
  const Figure loop{.title = "Y over U",
                    .panels = {{.x_label = "U [V]", .y_label = "Y [um]", .curves = {{.name = "log", .x = u, .y = y}}}},
                    .over_time = false};
  const Figure named{
      .title = "Parameters",
      .panels = {
          {.title = "K",
           .y_label = "K",
           .curves = {{.name = "K", .x = {1.0, 2.0}, .y = {3.0, 3.1}, .stroke = Stroke::Dots, .errors = {0.1, 0.2}}},
           .x_names = {{"a.toml", 1.0}, {"b.toml", 2.0}}}}};
  FigurePage page;
  std::string body;
  for (const Figure& figure : {over_time, loop, named}) {
    body += page.place(figure);
  }
  return page.text("A <page>", body);
}

TEST(PageText, StandsAloneAndIsEscaped) {
  const std::string page = rich_page();
  EXPECT_THAT(page, AllOf(HasSubstr("A &lt;page&gt;"), HasSubstr("default-src 'none'"), Not(HasSubstr("A <page>")),
                          Not(HasSubstr("src=")), Not(HasSubstr("nan"))));
}

TEST(PageText, OfVeryManyRowsThePageHoldsTheExtremes) {
  std::vector<double> t(1000000);
  std::vector<double> y(t.size());
  for (std::size_t k = 0; k < t.size(); ++k) {
    t[k] = static_cast<double>(k);
    y[k] = k == 765432 ? 12345.5 : std::sin(static_cast<double>(k));
  }
  Figure figure{.panels = {{.curves = {{.x = t, .y = y}, {.x = t, .y = y}, {.x = t, .y = y}}}}};
  FigurePage page;
  const std::string text = page.text("large", page.place(figure));
  EXPECT_LT(text.size(), 30'000'000U);
  EXPECT_THAT(text, AllOf(HasSubstr("12345.5"), HasSubstr("So many rows")));
}

TEST_F(PageOfFigures, IsDrawnWithoutAFault) {
  const Shown page = shown(rich_page());
  expect_no_fault(page);
  EXPECT_THAT(page.page, AllOf(HasSubstr("data-figures=\"3\""), HasSubstr(">a.toml<"), HasSubstr(">train<"),
                               HasSubstr(">t [s]<"), HasSubstr(">Y [um]<")));
  for (const char* text : {"MNaN", "LNaN", "=\"NaN\"", ">undefined"}) {
    EXPECT_THAT(page.page, Not(HasSubstr(text))) << text;
  }
  FigurePage empty;
  expect_no_fault(shown(empty.text("nothing", "")));
}

/// A switch that stands until a gap is drawn until there.
TEST_F(PageOfFigures, StepsHoldUntilAGap) {
  FigurePage page;
  const Figure figure{.panels = {{.curves = {{.x = {0.0, 1.0, 2.0, 2.5, 3.0, 4.0},
                                              .y = {0.0, 1.0, 1.0, not_a_number, 0.0, 0.0},
                                              .stroke = Stroke::Steps}}}}};
  const Shown drawn = shown(page.text("steps", page.place(figure)), R"(
    const path = document.querySelector("path.curve").getAttribute("d");
    document.body.dataset.path = path.replace(/[-0-9. ]+/g, "");)");
  EXPECT_THAT(drawn.page, HasSubstr("data-path=\"MHVHMH\""));
}

TEST_F(PageOfFigures, IsZoomedByDragsAndByKeys) {
  const Shown page = shown(rich_page(), R"(
    const host = document.getElementById("figure-0"), area = host.querySelector(".zoomed");
    const texts = () => [...host.querySelectorAll("svg text")].map(text => text.textContent).join();
    const key = name => area.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
    const before = texts(), said = [];
    key("+"); said.push(texts() !== before);
    const near = texts();
    key("ArrowRight"); said.push(texts() !== near && texts() !== before);
    key("ArrowLeft"); said.push(texts() === near);
    key("Home"); said.push(texts() === before);
    key("-"); said.push(texts() === before);
    key("ArrowLeft"); said.push(texts() === before);
    const plane = document.getElementById("figure-1"), svg = () => plane.querySelector("svg");
    const whole = plane.textContent;
    const send = (name, x, y) => {
      const box = svg().getBoundingClientRect();
      svg().dispatchEvent(new PointerEvent(name, { clientX: box.left + x * box.width, clientY: box.top + y * box.height,
                                                   button: 0, bubbles: true }));
    };
    send("pointerdown", 0.4, 0.4); send("pointermove", 0.6, 0.6);
    said.push(plane.querySelector(".readout").textContent.includes("U [V] = "));
    send("pointerup", 0.6, 0.6);
    said.push(plane.querySelector(".zoomed").textContent !== whole);
    svg().dispatchEvent(new MouseEvent("dblclick"));
    host.querySelector(".keys button").click();
    said.push(host.querySelectorAll("path.c7").length === 0);
    document.body.dataset.said = said.join();)");
  expect_no_fault(page);
  EXPECT_THAT(page.page, HasSubstr("data-said=\"true,true,true,true,true,true,true,true,true\""));
}

}  // namespace
}  // namespace hysteron::plots
