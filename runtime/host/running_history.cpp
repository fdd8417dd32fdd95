#include "runtime/host/running_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <random>
#include <utility>

#include "runtime/history/tables.hpp"
#include "runtime/task/clock.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::int64_t patience = 30'000'000'000;
constexpr std::size_t most_bytes = 16'000'000;

std::size_t index_of_point(std::span<const Point> points, const std::string& name) {
  const auto found = std::ranges::find(points, name, &Point::name);
  return static_cast<std::size_t>(found - points.begin());
}

std::optional<HistoryLock> lock_of(const HistoryConfig& config) {
  try {
    if (kind_of_history(config.file) == HistoryKind::Foreign) {
      throw InputError(error::foreign_history, config.place,
                       fmt::format("{} is there already, and is no history.", config.file),
                       "name another file in [history], or one that is not there: it is made.");
    }
    return HistoryLock(config.file);
  } catch (const database::DatabaseError& problem) {
    if (problem.trouble() == database::Trouble::Held) {
      throw InputError(error::file_of_another_task, config.place,
                       fmt::format("Another task that runs writes its history to {}.", config.file),
                       "end that task first, or name another file.");
    }
  }
  return std::nullopt;
}

std::string random_key() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", random(), random(), random(), random());
}

}  // namespace

BesideClocks clocks_beside(PointDoor& door) {
  const std::size_t at = index_of_point(door.points(), "task.elapsed");
  const auto utc = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const auto elapsed = [&door, at, snapshot = Snapshot{}]() mutable {
    door.read(snapshot);
    return static_cast<std::uint64_t>(snapshot.values[at]);
  };
  return {.utc = utc, .steady = monotonic_now, .elapsed = elapsed};
}

std::vector<std::size_t> points_named(const std::vector<std::string>& names, std::span<const Point> points) {
  std::vector<std::size_t> result;
  result.reserve(names.size());
  for (const std::string& name : names) {
    result.push_back(index_of_point(points, name));
  }
  return result;
}

std::size_t waiting_rows(std::int64_t period, std::uint64_t step, std::size_t points) {
  const auto rows = static_cast<std::size_t>(patience / (period * static_cast<std::int64_t>(step)));
  return std::clamp<std::size_t>(rows, 64, most_bytes / (sizeof(double) * (points + 2)));
}

RunningHistory::RunningHistory(const HistoryConfig& config, const ProgramShape& shape, Task& task, bool virtual_time)
    : settings_{.plan =
                    {.file = config.file,
                     .bytes = config.bytes,
                     .run = {.key = random_key(), .title = shape.name, .period = shape.period, .step = config.step}},
                .keep = config.keep,
                .virtual_time = virtual_time},
      door_(&task.door()),
      tap_(points_named(config.points, door_->points()), config.step,
           waiting_rows(shape.period, config.step, config.points.size()), counter_) {
  settings_.lock = lock_of(config);  // not among the initialisers: GCC 12 frees those twice where a later one throws
  for (const std::size_t point : tap_.points()) {
    settings_.plan.points.push_back(door_->points()[point]);
  }
}

void RunningHistory::start() {
  history_ = std::make_unique<History>(std::move(settings_), tap_, counter_, clocks_beside(*door_));
}

}  // namespace hysteron::runtime
