#include "fleet/report/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "fleet/report/statistics.hpp"
#include "support/median.hpp"

namespace hysteron::fleet {

Kind kind_of(const Unit& unit) {
  return {.group = unit.group.empty() ? unit.diagram : unit.group, .command = unit.command};
}

namespace {

// Asymptotic efficiency of the median absolute deviation at the normal distribution.
constexpr double efficiency_of_mad = 0.37;

// Standard deviation of a median over that of a mean, √(π/2).
constexpr double widening_of_median = 1.2533;

auto key_of(const Kind& kind) {
  return std::pair(kind.group, kind.command);
}

/// The rows of all machines by time; in the order of the manifest where they have none.
std::vector<std::size_t> by_time(const std::vector<Row>& rows) {
  std::vector<std::size_t> order(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    order[i] = i;
  }
  std::ranges::stable_sort(
      order, {}, [&](std::size_t i) { return std::isnan(rows[i].unit.time) ? -infinity : rows[i].unit.time; });
  return order;
}

void collect_tracks(Analysis& all, const std::vector<Row>& rows) {
  std::map<std::tuple<std::string, Command, std::string, std::string>, std::size_t> parameters;
  std::map<std::pair<std::size_t, std::string>, std::size_t> tracks;
  for (const std::size_t i : by_time(rows)) {
    const Kind kind = kind_of(rows[i].unit);
    for (const FoundParameter& one : rows[i].outcome.parameters) {
      if (one.source == "initial state" || !std::isfinite(one.value)) {
        continue;  // where a record begins is none of the machine's
      }
      const auto [parameter, is_new] =
          parameters.try_emplace({kind.group, kind.command, one.name, one.unit}, all.parameters.size());
      if (is_new) {
        all.parameters.push_back({.kind = kind, .name = one.name, .unit = one.unit});
      }
      const auto [place, is_first] = tracks.try_emplace({parameter->second, rows[i].unit.machine}, all.tracks.size());
      if (is_first) {
        all.parameters[parameter->second].tracks.push_back(all.tracks.size());
        all.tracks.push_back({.machine = rows[i].unit.machine, .parameter = parameter->second});
      }
      Track& track = all.tracks[place->second];
      track.rows.push_back(i);
      track.value.push_back(one.value);
      track.error.push_back(one.standard_error);
      if (!std::isnan(rows[i].unit.time)) {
        track.series.time.push_back(rows[i].unit.time);
        track.series.value.push_back(one.value);
        track.series.error.push_back(one.standard_error);
      }
    }
  }
}

/// Of the level: by the fits, or by the scatter from record to record.
double error_of_level(const Track& track, const Scatter& scatter) {
  std::vector<double> known;
  for (const double error : track.error) {
    if (std::isfinite(error)) {
      known.push_back(error);
    }
  }
  const double one = std::max(median(known), std::isfinite(scatter.deviation) ? scatter.deviation : 0.0);
  return widening_of_median * one / std::sqrt(static_cast<double>(track.value.size()));
}

void ask_parameter(Analysis& all, Parameter& parameter) {
  std::vector<Series> series;
  std::vector<double> levels;
  for (const std::size_t i : parameter.tracks) {
    series.push_back(all.tracks[i].series);
    all.tracks[i].level = median(all.tracks[i].value);
    levels.push_back(all.tracks[i].level);
  }
  parameter.scatter = scatter_of(series);
  parameter.median = median(levels);
  if (levels.size() >= least_siblings) {
    std::vector<double> distances;
    distances.reserve(levels.size());
    for (const double level : levels) {
      distances.push_back(std::abs(level - parameter.median));
    }
    parameter.deviation = deviation_of_median * median(distances);
  }
  for (const std::size_t i : parameter.tracks) {
    Track& track = all.tracks[i];
    track.trend = trend_of(track.series, parameter.scatter);
    track.has_trend = track.trend.change != Change::None;
    track.has_siblings = levels.size() >= least_siblings;
    if (track.has_siblings) {
      const double distance = track.level - parameter.median;
      const double sigma = std::max(parameter.deviation, error_of_level(track, parameter.scatter));
      track.sibling_p =
          distance == 0.0
              ? 1.0
              : student_both_tails(distance / sigma, efficiency_of_mad * static_cast<double>(levels.size() - 1));
    }
  }
}

/// The record from which on it is named: most records before do not name it, most from there on do.
double onset_of(const std::vector<std::pair<double, bool>>& named) {
  std::size_t best = 0;
  std::size_t most = 0;
  for (std::size_t k = 0; k < named.size(); ++k) {
    std::size_t right = 0;
    for (std::size_t i = 0; i < named.size(); ++i) {
      right += named[i].second == (i >= k) ? 1 : 0;
    }
    if (right > most) {
      most = right;
      best = k;
    }
  }
  return best == 0 ? not_a_number : named[best].first;
}

void collect_effects(Analysis& all, const std::vector<Row>& rows) {
  using Records = std::vector<std::size_t>;
  std::map<std::pair<std::string, Command>, std::map<std::string, Records>> kinds;
  for (const std::size_t i : by_time(rows)) {
    if (rows[i].unit.command == Command::Diagnose && rows[i].result.status == Status::Done) {
      kinds[key_of(kind_of(rows[i].unit))][rows[i].unit.machine].push_back(i);
    }
  }
  for (const auto& [kind, machines] : kinds) {
    std::map<std::string, std::map<std::string, std::set<std::size_t>>> named;
    std::size_t records = 0;
    for (const auto& [machine, of_machine] : machines) {
      records += of_machine.size();
      for (const std::size_t i : of_machine) {
        for (const FoundEffect& effect : rows[i].outcome.effects) {
          if (effect.named) {
            named[fmt::format("{} at {}", effect.effect, effect.edge)][machine].insert(i);
          }
        }
      }
    }
    for (const auto& [effect, by_machine] : named) {
      std::size_t total = 0;
      for (const auto& [machine, in] : by_machine) {
        total += in.size();
      }
      for (const auto& [machine, in] : by_machine) {
        const Records& own = machines.at(machine);
        std::vector<std::pair<double, bool>> over_time;
        for (const std::size_t i : own) {
          over_time.emplace_back(rows[i].unit.time, in.contains(i));
        }
        Presence one{.machine = machine,
                     .kind = {.group = kind.first, .command = kind.second},
                     .effect = effect,
                     .named = in.size(),
                     .records = own.size(),
                     .since = onset_of(over_time),
                     .has_siblings = machines.size() >= least_siblings};
        const auto others = static_cast<double>(records - own.size());
        const auto others_named = static_cast<double>(total - in.size());
        one.sibling_share = others > 0.0 ? others_named / others : 0.0;
        // Jeffreys: a share of no records is not known to be none.
        one.p = one.has_siblings ? binomial_tail(in.size(), own.size(), (others_named + 0.5) / (others + 1.0)) : 1.0;
        all.presences.push_back(std::move(one));
      }
    }
  }
}

void choose_findings(Analysis& all) {
  std::vector<double> p;
  for (const Track& track : all.tracks) {
    if (track.has_trend) {
      p.push_back(track.trend.p);
    }
    if (track.has_siblings) {
      p.push_back(track.sibling_p);
    }
  }
  for (const Presence& one : all.presences) {
    if (one.has_siblings) {
      p.push_back(one.p);
    }
  }
  all.tests = p.size();
  all.threshold = threshold_of(std::move(p), all.false_share);
  std::map<std::string, double> surest;
  const auto add = [&](Finding::What what, std::size_t index, const std::string& machine, double chance) {
    all.findings.push_back({.what = what, .index = index, .machine = machine, .p = chance});
    const auto [place, is_new] = surest.emplace(machine, chance);
    place->second = std::min(place->second, chance);
  };
  for (std::size_t i = 0; i < all.tracks.size(); ++i) {
    Track& track = all.tracks[i];
    track.changes = track.has_trend && track.trend.p <= all.threshold;
    track.stands_out = track.has_siblings && track.sibling_p <= all.threshold;
    if (track.changes) {
      add(Finding::What::Change, i, track.machine, track.trend.p);
    }
    if (track.stands_out) {
      add(Finding::What::Level, i, track.machine, track.sibling_p);
    }
  }
  for (std::size_t i = 0; i < all.presences.size(); ++i) {
    Presence& one = all.presences[i];
    one.stands_out = one.has_siblings && one.p <= all.threshold;
    if (one.stands_out) {
      add(Finding::What::Effect, i, one.machine, one.p);
    }
  }
  all.machines_found = surest.size();
  std::ranges::stable_sort(all.findings, {},
                           [&](const Finding& one) { return std::tuple(surest.at(one.machine), one.machine, one.p); });
}

}  // namespace

Analysis analysed(const std::vector<Row>& rows, double false_share) {
  Analysis all{.false_share = false_share};
  std::set<std::string> seen;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (seen.insert(rows[i].unit.machine).second) {
      all.machines.push_back(rows[i].unit.machine);
    }
    if (rows[i].result.status != Status::Done) {
      all.failures.push_back(i);
    }
  }
  collect_tracks(all, rows);
  for (Parameter& parameter : all.parameters) {
    ask_parameter(all, parameter);
  }
  collect_effects(all, rows);
  choose_findings(all);
  return all;
}

}  // namespace hysteron::fleet
