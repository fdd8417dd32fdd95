// The report in a browser without a screen: the script runs without fault, and drags and double clicks zoom.
#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "diagnosis/report/page.hpp"
#include "tests/diagnosis/report/fixture.hpp"
#include "tests/support/in_browser.hpp"

namespace hysteron::diagnosis {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using ReportInBrowser = hysteron::test::InBrowser;
using hysteron::test::expect_no_fault;
using hysteron::test::Shown;
using hysteron::test::shown;

TEST_F(ReportInBrowser, AllFiguresAreDrawnWithoutAFault) {
  const Shown rich = shown(report_page(fixture::rich_diagnosis(), fixture::rich_program()));
  expect_no_fault(rich);
  EXPECT_THAT(rich.page, HasSubstr("data-figures=\"10\""));  // the first trace, eight maps, the command
  for (const char* text : {"Residual, model − measured", "time since branch [s]", "mean explains 61 %", "REF [um]"}) {
    EXPECT_THAT(rich.page, HasSubstr(text));
  }
  for (const char* text : {"MNaN", "LNaN", "=\"NaN\""}) {
    EXPECT_THAT(rich.page, Not(HasSubstr(text)));
  }
}

TEST_F(ReportInBrowser, AHysteresisIsDrawnOverItsInput) {
  Diagnosis found = fixture::rich_diagnosis();
  found.traces[0].over = {.name = "U", .unit = "V", .values = found.traces[1].measured};
  const Shown rich = shown(report_page(found, fixture::rich_program()), R"(
    const curves = [...document.querySelectorAll("#loop-0 path.curve")];
    document.body.dataset.curves = curves.map(curve => curve.getAttribute("class").replace("curve ", "")).join();
    document.body.dataset.empty = curves.filter(curve => !curve.getAttribute("d")).length;)");
  expect_no_fault(rich);
  EXPECT_THAT(rich.page, HasSubstr("data-figures=\"11\""));
  EXPECT_THAT(rich.page, HasSubstr("data-curves=\"measured,after\""));
  EXPECT_THAT(rich.page, HasSubstr("data-empty=\"0\""));
}

TEST_F(ReportInBrowser, AFrictionIsDrawnOverItsVelocity) {
  Diagnosis found = fixture::rich_diagnosis();
  found.frictions = {{.block = "DRY", .force_unit = "N", .velocity_unit = "m/s"}};
  for (int k = 0; k < 100; ++k) {
    found.frictions[0].velocity.push_back(std::sin(0.1 * k));
    found.frictions[0].force.push_back(std::copysign(0.2, found.frictions[0].velocity.back()));
  }
  const Shown rich = shown(report_page(found, fixture::rich_program()), R"(
    const curves = [...document.querySelectorAll("#friction-0 path.curve")];
    document.body.dataset.curves = curves.filter(curve => curve.getAttribute("d")).length;)");
  expect_no_fault(rich);
  EXPECT_THAT(rich.page, HasSubstr("data-curves=\"1\""));
  EXPECT_THAT(rich.page, HasSubstr("velocity [m/s]"));
  EXPECT_THAT(rich.page, HasSubstr("force of DRY [N]"));
}

/// A share that stands over a wire ends before the box to which the wire leads.
TEST_F(ReportInBrowser, SharesDoNotReachIntoBoxes) {
  Diagnosis found = fixture::rich_diagnosis();
  found.effects.clear();
  found.edges = {{.edge = "U", .share = 0.9995}, {.edge = "A.XOUT", .share = 0.9996}};
  const Program chain = compile_text(
      "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR A : HY_LAG; B : "
      "HY_COULOMB_FRICTION; END_VAR A(XIN := U); B(XIN := A.XOUT, V := U); Y := B.XOUT; END_FUNCTION_BLOCK");
  const Shown tried = shown(report_page(found, chain), R"(
    const of = selector => [...document.querySelectorAll("svg.diagram " + selector)].map(one => one.getBoundingClientRect());
    const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const boxes = of("rect"), shares = of("text.share");
    document.body.dataset.shares = shares.length;
    document.body.dataset.overlaps = shares.filter(share => boxes.some(box => overlap(share, box))).length;)");
  expect_no_fault(tried);
  EXPECT_THAT(tried.page, HasSubstr("data-shares=\"2\""));
  EXPECT_THAT(tried.page, HasSubstr("data-overlaps=\"0\""));
}

/// On a narrow screen the page does not slide sideways; a table that is wider than it does, and its edge shows that.
TEST_F(ReportInBrowser, WhatIsCutOnANarrowScreenHasASign) {
  Diagnosis found = fixture::rich_diagnosis();
  found.effects.front().parameters.front().name = std::string(70, 'W');
  const Shown narrow = shown(report_page(found, fixture::rich_program()), R"(
    const cut = [...document.querySelectorAll("table, .scroll")].filter(one => one.scrollWidth > one.clientWidth + 2);
    document.body.dataset.cut = cut.length > 0;
    document.body.dataset.unsigned = cut.filter(one => getComputedStyle(one).backgroundImage === "none").length;
    document.body.dataset.slides = document.documentElement.scrollWidth > innerWidth;)",
                             500);
  EXPECT_THAT(narrow.page, HasSubstr("data-cut=\"true\""));
  EXPECT_THAT(narrow.page, HasSubstr("data-unsigned=\"0\""));
  EXPECT_THAT(narrow.page, HasSubstr("data-slides=\"false\""));
}

TEST_F(ReportInBrowser, EmptyAndRefusedPagesRunWithoutAFault) {
  expect_no_fault(shown(report_page({}, {})));
  expect_no_fault(shown(report_page(fixture::refused_diagnosis(), fixture::rich_program())));
  Diagnosis odd = fixture::rich_diagnosis(1);  // one sample, no models, maps without places
  odd.traces[0].improved.clear();
  odd.traces[0].calibrated.clear();
  odd.traces[0].nominal.clear();
  odd.maps[0] = {.over = "nothing"};
  expect_no_fault(shown(report_page(odd, fixture::rich_program())));
}

/// Texts that overlap cannot be read.
TEST_F(ReportInBrowser, TheTitlesOfTheMapsDoNotOverlap) {
  Diagnosis found = fixture::rich_diagnosis();
  found.maps[0].over = "time since the branch of a long name";
  const Shown tried = shown(report_page(found, fixture::rich_program()), R"(
    const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const pairs = [...document.querySelectorAll(".map svg")].filter(svg => {
      const boxes = [...svg.querySelectorAll("text.title, text.explained")].map(text => text.getBoundingClientRect());
      return boxes.length === 2 && !overlap(boxes[0], boxes[1]);
    });
    document.body.dataset.apart = pairs.length;)");
  expect_no_fault(tried);
  EXPECT_THAT(tried.page, HasSubstr("data-apart=\"8\""));
}

/// Nothing is drawn over the name of an effect: at its middle it is what a click meets, or the box that it stands in.
TEST_F(ReportInBrowser, EffectsAreNotCovered) {
  Diagnosis found = fixture::rich_diagnosis();
  found.effects.push_back({.id = "glitches", .edge = "SENSOR.XOUT", .share = 0.1});
  const Shown tried = shown(report_page(found, fixture::rich_program()), R"(
    const diagram = document.querySelector("svg.diagram");
    const covered = [...diagram.querySelectorAll("text.effect, .on-wire text.name")].filter(text => {
      text.scrollIntoView({ block: "center", inline: "center" });
      const box = text.getBoundingClientRect();
      const hit = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
      return hit === null || hit.closest("g") !== text.closest("g");
    });
    document.body.dataset.covered = covered.length;
    document.body.dataset.effects = diagram.querySelectorAll("text.effect, .on-wire text.name").length;)");
  expect_no_fault(tried);
  EXPECT_THAT(tried.page, HasSubstr("data-covered=\"0\""));
  EXPECT_THAT(tried.page, HasSubstr("data-effects=\"4\""));
}

TEST_F(ReportInBrowser, SharesOfBranchesDoNotOverlap) {
  Diagnosis found = fixture::rich_diagnosis();
  found.effects.clear();
  found.edges = {{.edge = "A.XIN", .share = 0.6}, {.edge = "U", .share = 0.5}, {.edge = "A.XOUT", .share = 0.4}};
  const Program branched = compile_text(
      "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR A : HY_LAG; B : "
      "HY_LAG; END_VAR A(XIN := U); B(XIN := U); Y := A.XOUT + B.XOUT; END_FUNCTION_BLOCK");
  const Shown tried = shown(report_page(found, branched), R"(
    const boxes = [...document.querySelectorAll("svg.diagram text.share")].map(text => text.getBoundingClientRect());
    const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    document.body.dataset.shares = boxes.length;
    document.body.dataset.overlaps = boxes.filter((a, i) => boxes.some((b, k) => k < i && overlap(a, b))).length;)");
  expect_no_fault(tried);
  EXPECT_THAT(tried.page, HasSubstr("data-shares=\"3\""));
  EXPECT_THAT(tried.page, HasSubstr("data-overlaps=\"0\""));
}

/// Of very many samples the extremes in each pixel are drawn: two points a pixel at most, and the one sample that
/// stands out is among them.
TEST_F(ReportInBrowser, ManySamplesAreThinnedByTheirExtremes) {
  const Shown tried = shown(report_page({}, {}), R"(
    const times = Float64Array.from({ length: 100000 }, (_, k) => k);
    const values = times.map(k => k === 54321 ? 9 : Math.sin(k));
    const path = linePath(times, values, 0, times.length, t => t / 100, v => v);
    const points = path.split(/[ML]/).length - 1;
    document.body.dataset.points = points <= 2002 && points >= 1000 ? "few" : points;
    document.body.dataset.peak = path.includes(" 9.0") ? "kept" : "lost";)");
  expect_no_fault(tried);
  EXPECT_THAT(tried.page, HasSubstr("data-points=\"few\""));
  EXPECT_THAT(tried.page, HasSubstr("data-peak=\"kept\""));
}

TEST_F(ReportInBrowser, ADragZoomsAndADoubleClickResets) {
  const Shown zoomed = shown(report_page(fixture::rich_diagnosis(), fixture::rich_program()), R"(
    const host = document.getElementById("trace-0");
    const times = () => [...host.querySelectorAll("svg text")].map(text => text.textContent);
    const send = (name, share) => {
      const svg = host.querySelector("svg"), box = svg.getBoundingClientRect();
      svg.dispatchEvent(new PointerEvent(name, { clientX: box.left + share * box.width, button: 0, bubbles: true }));
    };
    const before = times().join();
    send("pointerdown", 0.5);
    send("pointermove", 0.55);
    send("pointerup", 0.55);
    const during = times().join();
    document.body.dataset.zoom = during !== before && during.includes("2.5") && !during.includes("4.5") ? "yes" : during;
    host.querySelector("svg").dispatchEvent(new MouseEvent("dblclick"));
    document.body.dataset.reset = times().join() === before ? "yes" : "no";)");
  expect_no_fault(zoomed);
  EXPECT_THAT(zoomed.page, HasSubstr("data-zoom=\"yes\""));
  EXPECT_THAT(zoomed.page, HasSubstr("data-reset=\"yes\""));
}

}  // namespace
}  // namespace hysteron::diagnosis
