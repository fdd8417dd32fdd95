// The report as text: self-contained, well formed, escaped, with the numbers in it, and sound where parts are missing.
#include "diagnosis/report/page.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "support/numbers.hpp"
#include "tests/diagnosis/report/fixture.hpp"

namespace hysteron::diagnosis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What is wrong with the nesting of the tags; empty where nothing is.
std::string unbalanced(const std::string& html) {
  const std::set<std::string> alone{"meta", "!DOCTYPE"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
    const std::size_t end = html.find('>', at);
    const bool closes = html[at + 1] == '/';
    const std::size_t begin = at + (closes ? 2 : 1);
    const std::string name = html.substr(begin, html.find_first_of(" >/\n", begin) - begin);
    if (end == std::string::npos || name.empty()) {
      return "a < that begins no tag: " + html.substr(at, 40);
    }
    if (closes) {
      if (open.empty() || open.back() != name) {
        return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
      }
      open.pop_back();
    } else if (html[end - 1] != '/' && !alone.contains(name)) {
      open.push_back(name);
    }
    at = end;
    if (!closes && (name == "script" || name == "style")) {
      at = html.find("</" + name, end);
    }
  }
  return open.empty() ? "" : open.back() + " is not closed";
}

std::string data_of(const std::string& page) {
  const std::string begin = "id=\"data\">\n";
  const std::size_t from = page.find(begin) + begin.size();
  return page.substr(from, page.find("</script>", from) - from);
}

TEST(ReportPage, NeedsNothingBesideItself) {
  const std::string page = report_page(fixture::rich_diagnosis(), fixture::rich_program());
  EXPECT_THAT(page, Not(HasSubstr("http://")));
  EXPECT_THAT(page, Not(HasSubstr("https://")));
  EXPECT_THAT(page, Not(HasSubstr(" src=")));
  EXPECT_THAT(page, Not(HasSubstr("url(//")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(ReportPage, TagsAreBalancedInRichEmptyAndRefusedPages) {
  EXPECT_EQ(unbalanced(report_page(fixture::rich_diagnosis(), fixture::rich_program())), "");
  EXPECT_EQ(unbalanced(report_page(fixture::refused_diagnosis(), fixture::rich_program())), "");
  EXPECT_EQ(unbalanced(report_page({}, {})), "");
  EXPECT_EQ(unbalanced("<p><b>x</p></b>"), "</p> closes b");
}

TEST(ReportPage, SaysTheVerdictTheEffectsAndTheGap) {
  const std::string page = report_page(fixture::rich_diagnosis(), fixture::rich_program());
  for (const char* text :
       {"Creep of the stage explains two thirds", "86 %</strong> confidence", "on PLANT.HYST.XOUT", "0.0198 … 0.0223",
        "gentler reference", "1.83 um", "0.842 um", "0.0192 um", "floor 0.0161 um", "97 % (95 % … 98 %)",
        "effect: creep", "AMPLIFIER.XOUT, U", "coulomb friction on PLANT.BODY.XIN", "clipped at 31.5 um", "14 times",
        "REF to 30 um", "412 candidates"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
}

TEST(ReportPage, SaysWhichPartTheGapBelongsTo) {
  Diagnosis found = fixture::rich_diagnosis();
  found.split = {.input_output = 0.25, .plant = 0.7, .open = 0.05};
  found.cuts = {{.signal = "AMP_XOUT_MEASURED", .agrees = true}};
  found.controller = ControllerFinding{.steps = 600, .outputs = {{.name = "U", .unit = "V", .limited_rms = 0.5}}};
  const std::string page = report_page(found, fixture::rich_program());
  EXPECT_THAT(page, HasSubstr("Which part"));
  EXPECT_THAT(page, HasSubstr("none: 600 steps replayed, the same bits; limits and safe values change U by 0.5 V RMS"));
  EXPECT_THAT(page, HasSubstr("25 %"));
  EXPECT_THAT(page, HasSubstr("AMP_XOUT_MEASURED"));
  EXPECT_EQ(unbalanced(page), "");
}

TEST(ReportPage, AHysteresisIsDrawnOverItsInput) {
  Diagnosis found = fixture::rich_diagnosis(50);
  EXPECT_THAT(report_page(found, fixture::rich_program()), Not(HasSubstr("Output over input")));
  found.traces[0].over = {.name = "U", .unit = "V", .values = found.traces[1].measured};
  const std::string page = report_page(found, fixture::rich_program());
  EXPECT_THAT(page, HasSubstr("run 3, triangles: Y [um] over U [V]"));
  EXPECT_EQ(unbalanced(page), "");
  const nlohmann::json data = nlohmann::json::parse(data_of(page));
  EXPECT_EQ(data["traces"][0]["over"]["values"].size(), found.traces[1].measured.size());
  EXPECT_FALSE(data["traces"][1].contains("over"));
}

TEST(ReportPage, ARefusedRecordHasItsReasonsAndNoConfidence) {
  const std::string page = report_page(fixture::refused_diagnosis(), fixture::rich_program());
  EXPECT_THAT(page, HasSubstr("Record refused"));
  EXPECT_THAT(page, HasSubstr("nothing was excited"));
  EXPECT_THAT(page, Not(HasSubstr("</strong> confidence")));
  EXPECT_THAT(page, Not(HasSubstr("How far")));
}

/// The text of a page without its tags, so far as it stands before the data of the plots.
std::string words_on(const std::string& page) {
  const std::string shown = page.substr(0, page.find("id=\"data\""));
  return std::regex_replace(shown, std::regex("<[^>]*>"), "");
}

std::size_t count_of(const std::string& text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(ReportPage, ARefusalSaysEachReasonOnceAndHasNoEmptySections) {
  Diagnosis found = fixture::refused_diagnosis();
  found.summary = "No diagnosis: " + found.refusals[0];
  found.cannot_tell = found.refusals;
  const std::string page = report_page(found, fixture::rich_program());
  EXPECT_EQ(count_of(words_on(page), found.refusals[0]), 1U);
  EXPECT_THAT(page, Not(HasSubstr("What else the data allow")));
}

TEST(ReportPage, AWarningIsSaidOnce) {
  Diagnosis found = fixture::rich_diagnosis(50);
  found.cannot_tell.push_back(found.warnings[0]);
  const std::string words = words_on(report_page(found, fixture::rich_program()));
  EXPECT_EQ(count_of(words, found.warnings[0]), 1U);
  EXPECT_EQ(count_of(words, found.cannot_tell[0]), 1U);
}

TEST(ReportPage, AnEffectWithoutABlockStandsOnItsWire) {
  Diagnosis found = fixture::rich_diagnosis(50);
  found.effects.push_back({.id = "glitches", .edge = "SENSOR.XOUT", .share = 0.1});
  const std::string page = report_page(found, fixture::rich_program());
  EXPECT_THAT(page, HasSubstr("<title>glitches: on SENSOR.XOUT</title>"));
  EXPECT_EQ(count_of(page, "on-wire added"), 1U);
}

TEST(ReportPage, ALongNameOfABlockIsReadWhole) {
  const std::string text =
      "FUNCTION_BLOCK LONG (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR "
      "POSITION_VISCOUS_FRICTION : HY_LAG; END_VAR POSITION_VISCOUS_FRICTION(XIN := U); Y := "
      "POSITION_VISCOUS_FRICTION.XOUT; END_FUNCTION_BLOCK";
  const std::string page = report_page(fixture::rich_diagnosis(50), compile_text(text));
  EXPECT_THAT(page, HasSubstr(">POSITION_VISCOUS_</text>"));
  EXPECT_THAT(page, HasSubstr(">FRICTION</text>"));
}

TEST(ReportPage, SaysWhyAnInvertibleEffectHasNoFeedforward) {
  Diagnosis found = fixture::rich_diagnosis(50);
  ASSERT_EQ(found.effects[0].inverse, Inverse::Exact);
  found.feedforward_text = "FUNCTION_BLOCK FEEDFORWARD";
  found.feedforward_notes = {"AMP is left as it is"};
  EXPECT_THAT(report_page(found, fixture::rich_program()), Not(HasSubstr("No feedforward was written")));
  found.feedforward_text.clear();
  found.feedforward_notes = {"SUM takes 2 signals that depend on REF: no series chain"};
  EXPECT_THAT(report_page(found, fixture::rich_program()),
              HasSubstr("No feedforward was written all the same: SUM takes 2 signals that depend on REF"));
}

TEST(ReportPage, SpeaksOfRivalsWhereThereAreSome) {
  Diagnosis found = fixture::rich_diagnosis(50);
  EXPECT_THAT(report_page(found, fixture::rich_program()), HasSubstr("The rivals' outputs will then differ"));
  found.rivals.resize(1);
  EXPECT_THAT(report_page(found, fixture::rich_program()), Not(HasSubstr("rivals' outputs")));
  found.next = {.reason = "no excitation would show creep"};
  EXPECT_THAT(report_page(found, fixture::rich_program()),
              AllOf(HasSubstr("Next experiment: none"), HasSubstr("no excitation would show creep")));
}

TEST(ReportPage, AnIntervalOfTheClosedShareEndsAtTheWhole) {
  Diagnosis found = fixture::rich_diagnosis(50);
  found.gap.closed_high = 1.03;
  EXPECT_THAT(report_page(found, fixture::rich_program()), HasSubstr("97 % (95 % … 100 %)"));
}

TEST(ReportPage, NamesOfAnyKindAreEscaped) {
  const std::string evil = "</script><img onerror=\"x\">&'";
  Diagnosis found = fixture::rich_diagnosis(50);
  found.summary = found.warnings[0] = found.effects[0].edge = found.effects[0].same_edges[0] = evil;
  found.effects[0].parameters[0].name = found.effects[0].parameters[0].unit = evil;
  found.rivals[0].effects[0] = found.rivals[0].edges[0] = found.edges[0].edge = found.edges[0].group[0] = evil;
  found.gap.signal = found.gap.unit = found.gap.floor.evidence = found.gaps[0].signal = evil;
  found.maps[0].over = found.maps[0].unit = found.cannot_tell[0] = found.improved_text = evil;
  found.next.title = found.next.reason = found.next.input = found.next.steps[0].first = evil;
  found.traces[0].record = found.traces[0].signal = found.traces[0].unit = evil;
  found.calibration[0].name = found.calibration[0].unit = evil;
  const std::string page = report_page(found, fixture::rich_program());
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_EQ(unbalanced(page), "");
  const nlohmann::json data = nlohmann::json::parse(data_of(page));
  EXPECT_EQ(data["traces"][0]["record"], evil);
  EXPECT_EQ(data["maps"][0]["over"], evil);
}

TEST(ReportPage, TheDataAreTheTracesAsResiduals) {
  const Diagnosis found = fixture::rich_diagnosis(200);
  const nlohmann::json data = nlohmann::json::parse(data_of(report_page(found, fixture::rich_program())));
  ASSERT_EQ(data["traces"].size(), found.traces.size());
  ASSERT_EQ(data["traces"][0]["improved"].size(), 200U);
  EXPECT_EQ(data["traces"][0]["time"]["count"], 200);
  EXPECT_DOUBLE_EQ(data["traces"][0]["floor"], 0.0161);
  for (std::size_t k = 0; k < 200; ++k) {
    const double residual = found.traces[0].calibrated[k] - found.traces[0].measured[k];
    EXPECT_NEAR(data["traces"][0]["calibrated"][k].get<double>(), residual, 1e-6 * std::fabs(residual));
  }
}

TEST(ReportPage, AFrictionIsDrawnOverItsVelocity) {
  Diagnosis found = fixture::rich_diagnosis(50);
  EXPECT_THAT(report_page(found, fixture::rich_program()), Not(HasSubstr("Friction over velocity")));
  found.frictions = {
      {.block = "DRY", .force_unit = "N", .velocity_unit = "m/s", .velocity = {-1.0, 1.0}, .force = {-0.2, 0.2}}};
  const std::string page = report_page(found, fixture::rich_program());
  EXPECT_EQ(unbalanced(page), "");
  EXPECT_THAT(page, HasSubstr("<h2>Friction over velocity</h2>"));
  EXPECT_THAT(page, HasSubstr("id=\"friction-0\""));
  const nlohmann::json data = nlohmann::json::parse(data_of(page));
  EXPECT_EQ(data["frictions"][0]["velocityUnit"], "m/s");
  EXPECT_DOUBLE_EQ(data["frictions"][0]["force"][1], 0.2);
}

TEST(ReportPage, WhatIsNotFiniteIsNullOrADash) {
  Diagnosis found = fixture::rich_diagnosis(50);
  found.traces[0].improved[3] = std::nan("");
  found.traces[0].time[7] = 0.0071;  // no longer even
  found.effects[0].parameters[0].low = -infinity;
  found.effects[0].parameters[0].high = infinity;
  found.rivals[1].improved_rms = std::nan("");
  const std::string page = report_page(found, fixture::rich_program());
  const nlohmann::json data = nlohmann::json::parse(data_of(page));
  EXPECT_TRUE(data["traces"][0]["improved"][3].is_null());
  EXPECT_DOUBLE_EQ(data["traces"][0]["time"]["values"][7], 0.0071);
  EXPECT_THAT(page, HasSubstr("not determined"));
  EXPECT_THAT(page, Not(HasSubstr(">nan<")));
}

}  // namespace
}  // namespace hysteron::diagnosis
