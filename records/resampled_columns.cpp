#include "records/resampled_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "records/statistics.hpp"
#include "records/time/time_grid.hpp"
#include "records/time/time_unit.hpp"
#include "records/uneven_record.hpp"
#include "support/counted.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/option_words.hpp"
#include "support/rounded_text.hpp"

namespace hysteron::records {
namespace {

/// What stands in these rows, which rise, is taken away.
void leave_out(const std::vector<std::size_t>& rows, std::vector<double>& values) {
  std::size_t kept = 0;
  auto next = rows.begin();
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (next != rows.end() && *next == k) {
      ++next;
    } else {
      values[kept++] = values[k];
    }
  }
  values.resize(kept);
}

/// Rows that are further apart than ten of the new ones would be nine tenths invention; most often the unit of the time
/// is another.
void refuse_inventing(const Table& table, const Times& times, double sample_time) {
  const double usual = median_step(times.seconds);
  constexpr double most = 10.0;
  if (usual <= most * sample_time) {
    return;
  }
  const std::optional<MistakenUnit> mistaken = mistaken_unit(usual / sample_time);
  throw InputError(
      error::two_readings, table.place,
      fmt::format("The record has a row every {} s: brought to {} s, most rows would be made up.", rounded_text(usual),
                  rounded_text(sample_time)),
      !mistaken ? fmt::format("let the diagram run at the rate of the record, or state its time, as --rate {}Hz.",
                              rounded_text(1.0 / sample_time))
                : fmt::format("if its times are in {}, say so: --time {}.", mistaken->unit,
                              option_value(fmt::format("{}[{}]", times.column, mistaken->unit))));
}

/// s: from row to row where the times are uneven, with the rows that are missing; a plain number where one is near.
double usual_step(std::span<const double> seconds) {
  const TimeSurvey found = survey_of(seconds);
  const auto steps = static_cast<double>(seconds.size() - 1 + found.missing);
  const double mean = (seconds.back() - seconds.front()) / steps;
  constexpr double near = 0.02;  // else rows are missing or too many of which no gap tells
  constexpr double plain = 1e-3;
  const double step = std::abs(mean - found.usual) < near * found.usual ? mean : found.usual;
  return plainest_near(step, plain * step);
}

std::string option_of(std::string_view column, Resampling way) {
  return "--resample " + option_value(fmt::format("{}={}", column, name_of(way)));
}

/// The columns that a name means: as the diagram calls it, or the file, by a number, or a vector with all its elements.
std::vector<std::size_t> columns_meant(const Table& table, const std::string& name) {
  std::vector<std::size_t> found = columns_called(table, name);
  const auto take = [&](const auto& is_meant) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (is_meant(table.columns[i])) {
        found.push_back(i);
      }
    }
  };
  if (found.empty()) {
    take([&](const TableColumn& one) { return equal_ignoring_case(one.in_file, name); });
  }
  if (found.empty()) {
    take([&](const TableColumn& one) { return is_or_is_element_of(one.name, name); });
  }
  return found;
}

bool is_same(const ResamplingCost& one, const ResamplingCost& other) {
  return one.made_up == other.made_up && one.farthest == other.farthest && one.delay == other.delay;
}

}  // namespace

ResampledColumns::ResampledColumns(Table& table, const Times& times, const ReadOptions& options)
    : table_(table), times_(times), options_(options) {
  state_ways();
  find_grid();
}

void ResampledColumns::state_ways() {
  ways_.assign(table_.columns.size(), {.way = options_.resampling});
  std::vector<const ColumnWay*> stated(table_.columns.size());
  for (const ColumnWay& one : options_.ways) {
    const std::vector<std::size_t> meant = columns_meant(table_, one.name);
    if (meant.empty() && one.is_general) {
      table_.notes.push_back(fmt::format("there is no column {}, which the parameter file resamples", one.name));
    } else if (meant.empty()) {
      const std::vector<std::string> names = names_of(table_);
      const auto near = nearest_name(one.name, names);
      throw InputError(error::missing_column, table_.place,
                       fmt::format("There is no column {}, which is to be resampled; the columns are {}.", one.name,
                                   fmt::join(names, ", ")),
                       near.empty() ? fmt::format("name one of these, as {}.", option_of(names.back(), one.way))
                                    : fmt::format("did you mean {}?", option_of(near, one.way)));
    }
    for (const std::size_t i : meant) {
      if (times_.uses(i)) {
        throw InputError(error::bad_usage, table_.columns[i].place,
                         fmt::format("{} is the time, which is no signal to be resampled.", table_.columns[i].name),
                         "name a signal, or leave this --resample out.");
      }
      if (stated[i] != nullptr) {
        throw InputError(error::two_readings, table_.columns[i].place,
                         fmt::format("{} is to be resampled in two ways, {} and {}.", table_.columns[i].name,
                                     name_of(stated[i]->way), name_of(one.way)),
                         "state one of them.");
      }
      stated[i] = &one;
      ways_[i].way = one.way;
    }
  }
  // A switch is on or off, a counter goes from number to number: nothing lies between.
  for (std::size_t i = 0; i < table_.columns.size(); ++i) {
    const TableColumn& column = table_.columns[i];
    const bool is_named = std::ranges::any_of(
        options_.stepping, [&](const std::string& name) { return is_or_is_element_of(column.name, name); });
    if (column.kind != CellKind::Truth && !is_named) {
      continue;
    }
    if (stated[i] != nullptr && stated[i]->way != Resampling::Hold) {
      throw InputError(error::bad_usage, column.place,
                       fmt::format("{} is to be resampled by {}, and is {}: nothing lies between two of its values.",
                                   column.name, name_of(stated[i]->way),
                                   column.kind == CellKind::Truth ? "TRUE or FALSE" : "no REAL in the diagram"),
                       fmt::format("hold the last one: {}.", option_of(column.name, Resampling::Hold)));
    }
    ways_[i] = {.way = Resampling::Hold, .steps = options_.resampling != Resampling::Hold && stated[i] == nullptr};
  }
}

void ResampledColumns::find_grid() {
  double first = times_.seconds.front();
  double last = times_.seconds.back();
  for (const Times::Own& own : times_.own) {
    first = std::max(first, own.seconds.front());
    last = std::min(last, own.seconds.back());
  }
  sample_time_ =
      options_.sample_time.value_or(times_.grid.fault ? usual_step(times_.seconds) : times_.grid.sample_time);
  if (options_.origin) {
    constexpr double rounding = 1e-6;
    first = *options_.origin + sample_time_ * std::ceil((first - *options_.origin) / sample_time_ - rounding);
  }
  seconds_ = first <= last ? even_times(first, last, sample_time_) : std::vector<double>();
  refuse_inventing(table_, times_, sample_time_);
  if (seconds_.size() < 2) {
    throw InputError(error::record_too_short, table_.place, "Resampled, the record has less than two rows.",
                     "resample to a shorter sample time.");
  }
}

bool ResampledColumns::bridges(std::size_t index) const {
  const TableColumn& column = table_.columns[index];
  return ways_[index].way != Resampling::None && column.is_gappy && column.missing.size() + 1 < table_.rows;
}

ResampledColumns::Brought ResampledColumns::bring(std::size_t index) {
  const TableColumn& column = table_.columns[index];
  const Way& stated = ways_[index];
  const auto own = std::ranges::find(times_.own, index, &Times::Own::column);
  std::vector<double> at = own != times_.own.end() ? own->seconds : times_.seconds;
  Brought result{.values = column.values};
  result.values.resize(at.size());  // a signal at a rate of its own has fewer rows
  if (bridges(index)) {
    leave_out(column.missing, at);
    leave_out(column.missing, result.values);
  }
  // A line between two values is no finer than they are; a mean of many may be.
  result.step = stated.way == Resampling::Average ? 0.0 : statistics_of(result.values).resolution;
  ResamplingCost cost;
  const Resampling way = stated.way == Resampling::None ? Resampling::Hold : stated.way;
  result.values = resampled(at, result.values, seconds_, way, cost);
  constexpr double rounding = 1e-6;
  if (stated.way != Resampling::None) {
    keep(column.name, stated, cost);
  } else if (cost.farthest > rounding * sample_time_) {  // else its own times are the new ones
    result.fault =
        Diagnostic{.number = error::uneven_time,
                   .place = column.place,
                   .cause = fmt::format("Nothing says how column {} is brought to the even times.", column.name),
                   .mend = fmt::format("say it: {}, or hold where it steps; of all that are not named, --resample "
                                       "linear.",
                                       option_of(column.name, Resampling::Linear))};
  }
  return result;
}

void ResampledColumns::keep(const std::string& name, const Way& way, const ResamplingCost& cost) {
  const auto found = std::ranges::find_if(groups_, [&](const Group& group) {
    return group.way.way == way.way && group.way.steps == way.steps && is_same(group.cost, cost);
  });
  if (found != groups_.end()) {
    found->names.push_back(name);
  } else {
    groups_.push_back({.way = way, .cost = cost, .names = {name}});
  }
}

std::vector<std::string> ResampledColumns::said() const {
  const auto what_it_did = [](const ResamplingCost& cost) {
    return fmt::format(
        "a row lies up to {:.3g} s from its sample{}", cost.farthest,
        cost.delay > 0.0 ? fmt::format(", and signals are late by {:.3g} s in the mean", cost.delay) : std::string());
  };
  const std::string rows = fmt::format("to {} s: {} rows", rounded_text(sample_time_), seconds_.size());
  if (groups_.size() == 1 && !groups_.front().way.steps && options_.ways.empty()) {
    const Group& all = groups_.front();
    return {fmt::format("resampled ({}) {}, {} of them in gaps; {}", name_of(all.way.way), rows, all.cost.made_up,
                        what_it_did(all.cost))};
  }
  std::vector<std::string> result{"resampled " + rows};
  for (const Group& group : groups_) {
    result.push_back(fmt::format("{}: {}{}; {} made up in gaps; {}", fmt::join(group.names, ", "),
                                 name_of(group.way.way), group.way.steps ? ", as nothing lies between two values" : "",
                                 counted(group.cost.made_up, "row"), what_it_did(group.cost)));
  }
  return result;
}

}  // namespace hysteron::records
