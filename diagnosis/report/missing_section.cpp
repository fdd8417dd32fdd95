// The picture of the missing signal: what is missing over what it is a function of, with the law through it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "diagnosis/findings/evidence_findings.hpp"
#include "diagnosis/report/html.hpp"
#include "diagnosis/report/sections.hpp"
#include "plots/axis.hpp"

namespace hysteron::diagnosis::report {
namespace {

constexpr double width = 640.0;
constexpr double height = 320.0;
constexpr double left = 72.0;
constexpr double right = 16.0;
constexpr double top = 12.0;
constexpr double bottom = 46.0;
/// More points hide each other.
constexpr std::size_t most_points = 1500;
/// Of a scale: more crowd it.
constexpr int most_ticks = 6;

using plots::Reach;

/// From the first to the last percent of values, with room to both sides: single samples set no scale.
Reach range_of(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return Reach{.low = at(0.005), .high = at(0.995)}.with_room(0.06);
}

double across(const Reach& range, double value) {
  return left + (width - left - right) * (value - range.low) / (range.high - range.low);
}
double down(const Reach& range, double value) {
  return top + (height - top - bottom) * (range.high - value) / (range.high - range.low);
}
bool within(const Reach& range, double value) {
  return value >= range.low && value <= range.high;
}

/// The law as medians in narrow bins of what it is a function of: with a memory it has several values at one place.
std::string law_line(const MissingPicture& picture, const Reach& x, const Reach& y) {
  constexpr std::size_t bins = 120;
  std::vector<std::vector<double>> values(bins);
  for (std::size_t k = 0; k < picture.places.size(); ++k) {
    if (within(x, picture.places[k])) {
      const double share = (picture.places[k] - x.low) / (x.high - x.low);
      values[std::min(bins - 1, static_cast<std::size_t>(share * bins))].push_back(picture.law[k]);
    }
  }
  std::string points;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    std::vector<double>& here = values[bin];
    if (here.empty()) {
      continue;
    }
    std::ranges::nth_element(here, here.begin() + std::ssize(here) / 2);
    const double place = x.low + (x.high - x.low) * (static_cast<double>(bin) + 0.5) / bins;
    points +=
        fmt::format("{:.1f},{:.1f} ", across(x, place), down(y, std::clamp(here[here.size() / 2], y.low, y.high)));
  }
  return fmt::format("<polyline class=\"law\" points=\"{}\"/>\n", points);
}

std::string axes(const MissingPicture& picture, const Reach& x, const Reach& y) {
  std::string svg;
  for (const double at : plots::round_numbers(x, most_ticks)) {
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>"
        "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4}</text>\n",
        across(x, at), top, height - bottom, height - bottom + 16.0, figure(at, 3));
  }
  for (const double at : plots::round_numbers(y, most_ticks)) {
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        left, width - right, down(y, at), left - 6.0, down(y, at) + 4.0, figure(at, 3));
  }
  return svg + fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                           0.5 * (left + width - right), height - 8.0,
                           escaped(with_unit(picture.over, picture.over_unit)));
}

}  // namespace

std::string missing_section(const Diagnosis& diagnosis) {
  const MissingPicture& picture = diagnosis.evidence.picture;
  if (picture.places.size() < 2) {
    return {};
  }
  const Reach x = range_of(picture.places);
  std::vector<double> both = picture.missing;
  both.insert(both.end(), picture.law.begin(), picture.law.end());
  const Reach y = range_of(std::move(both));
  std::string dots;
  const std::size_t step = std::max<std::size_t>(1, picture.places.size() / most_points);
  for (std::size_t k = 0; k < picture.places.size(); k += step) {
    if (within(x, picture.places[k]) && within(y, picture.missing[k])) {
      dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.6\"/>", across(x, picture.places[k]),
                          down(y, picture.missing[k]));
    }
  }
  const FamilyFinding& family = diagnosis.evidence.families.front();
  return fmt::format(
      "<section class=\"missing\"><h2>What is missing at {}</h2>\n"
      "<p>Each point is the signal that the model lacks there{}, over {}. The line is the law that was found: {}.</p>\n"
      "<svg class=\"missing\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"missing signal over {}\">\n{}"
      "<g class=\"dots\">{}</g>\n{}</svg>\n</section>\n",
      escaped(picture.edge), picture.unit.empty() ? std::string() : " in " + escaped(picture.unit),
      escaped(picture.over), escaped(fmt::format("{}, {}", words_of_family(family.family), words_of(picture.effect))),
      width, height, escaped(picture.over), axes(picture, x, y), dots, law_line(picture, x, y));
}

std::string families_section(const Diagnosis& diagnosis) {
  constexpr double least_shown = 0.02;
  std::string rows;
  for (const FamilyFinding& one : diagnosis.evidence.families) {
    if (one.probability < least_shown) {
      continue;
    }
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{:.2f}</td><td class=\"number\">{}</td><td>{}</td><td class=\"number\">"
        "{:.2f}</td><td>{}</td></tr>\n",
        escaped(words_of_family(one.family)), one.probability, percent(std::clamp(one.closed, 0.0, 1.0)),
        escaped(words_of(one.effect)), one.member, escaped(one.edge));
  }
  if (rows.empty()) {
    return {};
  }
  return fmt::format(
      "<section class=\"families\"><h2>Which kinds of effect are there</h2>\n"
      "<p>The probability says that an effect of this kind is there. The share is what it closes of the gap, on "
      "stretches that its fit did not see.</p>\n"
      "<table><thead><tr><th>kind</th><th class=\"number\">probability</th><th class=\"number\">closes</th>"
      "<th>likeliest effect</th><th class=\"number\">of its "
      "kind</th><th>on</th></tr></thead><tbody>\n{}</tbody></table>\n"
      "</section>\n",
      rows);
}

}  // namespace hysteron::diagnosis::report
