#include "runtime/config/history_reading.hpp"

#include <algorithm>
#include <utility>

#include "runtime/task/task_door.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::int64_t usual_step = 1'000'000'000;
constexpr std::size_t most_points = 1000;

/// What a history may keep: inputs and outputs, `ports` of them, parameters, and what the task says of itself.
std::vector<std::string> all_points(const ProgramShape& shape) {
  std::vector<std::string> names;
  for (const auto* const signals : {&shape.inputs, &shape.outputs, &shape.parameters}) {
    for (const ProgramSignal& signal : *signals) {
      names.push_back(signal.name);
    }
  }
  for (const char* const status : status_names()) {
    names.emplace_back(status);
  }
  return names;
}

}  // namespace

HistoryConfig HistoryReading::read(TomlReader table) {
  HistoryConfig history{.place = table.place()};
  if (!table.has("file")) {
    found_->error(error::wrong_run_value, table.place(), table.name() + " needs the key file.",
                  "write it as in file = \"history.sqlite\", or remove the table.");
  }
  table.read("file", history.file);
  history.step = read_step(table);
  history.points = read_points(table);
  table.read_duration("keep", history.keep);
  std::uint64_t megabytes = history.bytes / 1'000'000;
  table.read_whole("megabytes", megabytes);
  history.bytes = megabytes * 1'000'000;
  return history;
}

/// A time as a whole number of periods.
std::uint64_t HistoryReading::read_step(TomlReader& table) {
  const std::int64_t period = shape_->period;
  std::int64_t every = std::max(usual_step / period, std::int64_t{1}) * period;
  table.read_duration("every", every);
  if (every < period || every % period != 0) {
    const std::int64_t near = std::max((every + period / 2) / period, std::int64_t{1}) * period;
    found_->error(error::wrong_run_value, table.place("every"),
                  time_text(static_cast<double>(every)) + " is no whole number of periods, which are " +
                      time_text(static_cast<double>(period)) + ".",
                  "write every = \"" + time_text(static_cast<double>(near)) + "\", or another multiple.");
    return 1;
  }
  return static_cast<std::uint64_t>(every / period);
}

/// Inputs and outputs where none are named. In the words of the door, whatever case they are written in.
std::vector<std::string> HistoryReading::read_points(TomlReader& table) {
  std::vector<std::string> all = all_points(*shape_);
  if (!table.has("points")) {
    all.resize(shape_->inputs.size() + shape_->outputs.size());
    return all;
  }
  std::vector<std::string> wanted;
  std::vector<std::string> points;
  table.read("points", wanted);
  for (const std::string& name : wanted) {
    const auto found =
        std::ranges::find_if(all, [&](const std::string& one) { return equal_ignoring_case(one, name); });
    if (found == all.end()) {
      const auto near = nearest_name(name, all);
      found_->error(error::unknown_port_in_run_file, table.place("points"),
                    shape_->name + " has no point " + name + ".",
                    near.empty() ? "name inputs, outputs, parameters as HYST.C1, or what the task says of itself, as "
                                   "task.fault."
                                 : "did you mean " + std::string(near) + "?");
    } else if (std::ranges::find(points, *found) == points.end()) {
      points.push_back(*found);
    }
  }
  if (wanted.empty() || points.size() > most_points) {
    found_->error(
        error::run_value_out_of_range, table.place("points"),
        "There are " + std::to_string(points.size()) + " points in the list.",
        "name 1 to " + std::to_string(most_points) + " points, or leave the key out for all inputs and outputs.");
  }
  return points;
}

}  // namespace hysteron::runtime
