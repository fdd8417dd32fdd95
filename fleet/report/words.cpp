#include "fleet/report/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fleet/when.hpp"

namespace hysteron::fleet {
namespace {

std::string of_change(const Track& track, const Parameter& parameter) {
  const Trend& trend = track.trend;
  const auto [from, to] = distinct_texts(trend.from, trend.to, 3);
  const bool up = trend.to > trend.from;
  const std::string values = quantity(fmt::format("{} to {}", from, to), parameter.unit);
  if (trend.change == Change::Step) {
    return fmt::format("{} {} on {}, from {}.", parameter.name, up ? "jumps up" : "drops", date_text(trend.since),
                       values);
  }
  return fmt::format("{} {} since {}, from {}.", parameter.name,
                     !up                 ? "falls"
                     : trend.from >= 0.0 ? "grows"
                                         : "rises",
                     date_text(trend.since), values);
}

std::string of_level(const Track& track, const Parameter& parameter) {
  const auto [own, theirs] = distinct_texts(track.level, parameter.median, 3);
  return fmt::format("{} is {}; the median of {} siblings is {}, their standard deviation {}.", parameter.name,
                     quantity(own, parameter.unit), parameter.tracks.size() - 1, theirs,
                     quantity(fmt::format("{:.2g}", parameter.deviation), parameter.unit));
}

std::string of_effect(const Presence& one) {
  return fmt::format("{} is named in {} of {} records{}; of its siblings' records {:.2g} % name it.", one.effect,
                     one.named, one.records, std::isnan(one.since) ? "" : ", since " + date_text(one.since),
                     100.0 * one.sibling_share);
}

}  // namespace

std::string quantity(const std::string& number, const std::string& unit) {
  return unit.empty() || unit == "1" ? number : number + " " + unit;
}

std::vector<std::string> headline(const Analysis& all, const std::vector<Row>& rows) {
  std::vector<std::string> text;
  const std::size_t n = all.machines.size();
  if (all.tests == 0) {
    text.push_back(
        fmt::format("Nothing can be said of {} machine{} yet: a change needs {} records at different times, a "
                    "comparison {} machines.",
                    n, n == 1 ? "" : "s", least_records, least_siblings));
  } else if (all.machines_found == 0) {
    text.push_back(fmt::format("None of {} machines drifts or stands out.", n));
  } else {
    text.push_back(
        fmt::format("{} of {} machines {} out.", all.machines_found, n, all.machines_found == 1 ? "stands" : "stand"));
  }
  if (!all.failures.empty()) {
    text.push_back(fmt::format("{} of {} records {} no result.", all.failures.size(), rows.size(),
                               all.failures.size() == 1 ? "has" : "have"));
  }
  return text;
}

std::string sentence(const Analysis& all, const Finding& finding) {
  if (finding.what == Finding::What::Effect) {
    return of_effect(all.presences[finding.index]);
  }
  const Track& track = all.tracks[finding.index];
  const Parameter& parameter = all.parameters[track.parameter];
  return finding.what == Finding::What::Change ? of_change(track, parameter) : of_level(track, parameter);
}

std::vector<std::string> method(const Analysis& all) {
  return {
      fmt::format(
          "{} tests were made. On average at most {:g} % of the findings are false: they are chosen over all tests by "
          "Benjamini and Hochberg (1995). The share is --false-share.",
          all.tests, 100.0 * all.false_share),
      fmt::format(
          "A change is a ramp or a step that a parameter shows in {} records or more, at different times. Each record "
          "weighs by the largest of three standard deviations: that of its fit, that of the records of all siblings "
          "about their lines of Theil and Sen, and that of the machine about the form. The change must stay without "
          "any one of the records. So four is the least: three are left.",
          least_records),
      fmt::format(
          "A machine stands out by its distance from the median of {} siblings or more, itself among them. Its scale "
          "is "
          "1.4826 times their median absolute deviation, or the error of the machine's own median where that is "
          "larger. Student's distribution has 0.37 degrees of freedom a machine, the efficiency of that scale "
          "(Rousseeuw and Croux 1993). With fewer than five machines, two could hide each other.",
          least_siblings),
      "An effect stands out where it is named more often than at the share of its siblings' records (binomial "
      "distribution)."};
}

}  // namespace hysteron::fleet
