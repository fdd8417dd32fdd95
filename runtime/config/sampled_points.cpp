#include "runtime/config/sampled_points.hpp"

#include <algorithm>
#include <iterator>

#include "runtime/task/task_door.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::int64_t usual_step = 1'000'000'000;
constexpr std::size_t most_points = 1000;

/// What may be named: inputs and outputs, parameters, and what the task says of itself and of its devices.
std::vector<std::string> all_points(const ProgramShape& shape, std::span<const Point> field_points) {
  std::vector<std::string> names;
  for (const auto* const signals : {&shape.inputs, &shape.outputs, &shape.parameters}) {
    for (const ProgramSignal& signal : *signals) {
      names.push_back(signal.name);
    }
  }
  for (const char* const status : status_names()) {
    names.emplace_back(status);
  }
  for (const Point& point : field_points) {
    names.push_back(point.name);
  }
  return names;
}

}  // namespace

std::uint64_t read_step(TomlReader& table, const ProgramShape& shape, Diagnostics& found) {
  const std::int64_t period = shape.period;
  std::int64_t every = std::max(usual_step / period, std::int64_t{1}) * period;
  table.read_duration("every", every);
  if (every < period || every % period != 0) {
    const std::int64_t near = std::max((every + period / 2) / period, std::int64_t{1}) * period;
    found.error(error::wrong_run_value, table.place("every"),
                time_text(static_cast<double>(every)) + " is no whole number of periods, which are " +
                    time_text(static_cast<double>(period)) + ".",
                "write every = \"" + time_text(static_cast<double>(near)) + "\", or another multiple.");
    return 1;
  }
  return static_cast<std::uint64_t>(every / period);
}

std::vector<std::string> read_points(TomlReader& table, const ProgramShape& shape, std::span<const Point> field_points,
                                     Diagnostics& found) {
  std::vector<std::string> all = all_points(shape, field_points);
  if (!table.has("points")) {
    all.resize(shape.inputs.size() + shape.outputs.size());
    return all;
  }
  std::vector<std::string> wanted;
  std::vector<std::string> points;
  table.read("points", wanted, R"(["NAME", "task.fault"])");
  for (const std::string& name : wanted) {
    // The name of a vector is each of its elements.
    std::vector<std::string> known;
    std::ranges::copy_if(all, std::back_inserter(known),
                         [&](const std::string& one) { return is_or_is_element_of(one, name); });
    if (known.empty()) {
      const auto near = nearest_name(name, all);
      found.error(error::unknown_port_in_run_file, table.place("points"), shape.name + " has no point " + name + ".",
                  near.empty() ? "name inputs, outputs, parameters as HYST.C1, or what the task says of itself, as "
                                 "task.fault, and of its devices, as device.NAME.timeouts."
                               : "did you mean " + std::string(near) + "?");
    }
    for (const std::string& one : known) {
      if (std::ranges::find(points, one) == points.end()) {
        points.push_back(one);
      }
    }
  }
  if (wanted.empty() || points.size() > most_points) {
    found.error(
        error::run_value_out_of_range, table.place("points"),
        "There are " + std::to_string(points.size()) + " points in the list.",
        "name 1 to " + std::to_string(most_points) + " points, or leave the key out for all inputs and outputs.");
  }
  return points;
}

}  // namespace hysteron::runtime
