#include "runtime/task/task_door.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::size_t command_count = 4;
constexpr const char* owned =
    "Another client owns the writes, as own_writes under [modbus] has it; wait until it is gone.";
constexpr std::uint64_t percentile_every = 1024;  ///< cycles: looking through the histogram takes some microseconds

/// Points, a number for each input that says whether it is forced, inner signals.
std::size_t width_of(const ProgramShape& shape, std::size_t field_points) {
  return 2 * shape.inputs.size() + shape.outputs.size() + shape.parameters.size() + status_count + field_points +
         command_count + shape.inner.size();
}

TaskOrders first_orders(const StepProgram& program, const std::vector<InputSettings>& settings) {
  const std::vector<ProgramSignal>& inputs = program.shape().inputs;
  TaskOrders orders{
      .inputs = {}, .input_writes = std::vector<std::uint64_t>(inputs.size(), 0), .parameters = parameters_of(program)};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    orders.inputs.push_back(settings[i].start.value_or(inputs[i].preset));
  }
  orders.forces.resize(inputs.size());
  return orders;
}

Point point_of(const ProgramSignal& signal, PointKind kind, bool writable) {
  return {.name = signal.name,
          .kind = kind,
          .type = signal.type,
          .unit = signal.unit.empty() ? "1" : signal.unit,
          .low = signal.low,
          .high = signal.high,
          .writable = writable,
          .meaning = signal.meaning,
          .right = kind == PointKind::input ? WriteRight::inputs : WriteRight::parameters};
}

/// Parameters of a version that the first one has not, by their places in it: in the order of all.
std::vector<std::size_t> further_parameters(const RunningVersion& version, std::size_t first_count) {
  std::vector<std::size_t> own;
  for (std::size_t i = first_count; i < version.places.size(); ++i) {
    if (version.places[i]) {
      own.push_back(*version.places[i]);
    }
  }
  return own;
}

}  // namespace

TaskDoor::TaskDoor(const StepProgram& program, const std::vector<InputSettings>& inputs,
                   const std::vector<OutputSafety>& safety, const std::vector<Point>& field_points)
    : snapshots_(width_of(program.shape(), field_points.size())),
      published_(width_of(program.shape(), field_points.size())),
      judged_by_({.inputs = program.shape().inputs,
                  .parameters = program.shape().parameters,
                  .relations = program.shape().relations}),
      gone_(program.shape().parameters.size(), false),
      plant_(judged_by_, parameters_of(program)),
      page_(judged_by_, parameters_of(program)),
      wanted_(first_orders(program, inputs)),
      orders_(wanted_) {
  const ProgramShape& shape = program.shape();
  inputs_ = shape.inputs.size();
  for (std::size_t i = 0; i < inputs_; ++i) {
    Point point = point_of(shape.inputs[i], PointKind::input, !inputs[i].from_device);
    point.is_retained = inputs[i].is_retained;
    add(std::move(point));
  }
  for (std::size_t i = 0; i < shape.outputs.size(); ++i) {
    Point point = point_of(shape.outputs[i], PointKind::output, false);
    point.low = std::max(point.low, safety[i].low);
    point.high = std::min(point.high, safety[i].high);
    add(std::move(point));
    safe_.push_back(safe_value(safety[i]));
  }
  first_parameter_ = points_.size();
  for (const ProgramSignal& parameter : shape.parameters) {
    add(point_of(parameter, PointKind::parameter, true));
  }
  first_status_ = points_.size();
  for (Point& point : status_points()) {
    add(std::move(point));
  }
  for (const Point& point : field_points) {
    add(point);
  }
  first_command_ = points_.size();
  add_command("task.commit", WriteRight::parameters,
              "any number but 0: the staged parameters count from the next step on");
  add_command("task.discard", WriteRight::parameters, "any number but 0: the staged parameters are forgotten");
  add_command("task.reset", WriteRight::reset,
              "any number but 0: every state as after a start, and a fault is forgotten");
  add_command("task.heartbeat", WriteRight::inputs, "any number: the client lives");
  parameter_count_ = shape.parameters.size();
  make_view({.program = program, .places = {}, .parameters = shape.parameters, .live = {}, .number = 1});
}

void TaskDoor::add_command(const char* name, WriteRight right, const char* meaning) {
  add({.name = name,
       .kind = PointKind::command,
       .type = PointType::uint16,
       .unit = "1",
       .low = 0.0,
       .high = 65535.0,
       .writable = true,
       .meaning = meaning,
       .right = right});
}

TaskDoor::Row TaskDoor::read_row(std::uint64_t& cycle) {
  const std::size_t common = points_.size() + inputs_;
  row_.assign(live_ ? live_->width() : common + view_->inner.size(), not_a_number);
  if (!snapshots_.read(cycle, std::span(row_).first(live_ ? common : row_.size()))) {
    std::ranges::fill(row_, 0.0);
    std::ranges::copy(wanted_.inputs, row_.begin());
    std::ranges::copy(safe_, row_.begin() + static_cast<std::ptrdiff_t>(inputs_));
    return Row::none;
  }
  if (live_) {
    newer_.resize(row_.size());
    std::uint64_t newer = 0;
    // A row may be there from the time before the version was left.
    if (!live_->read(newer, newer_) || newer < cycle) {
      return Row::points;
    }
    std::swap(row_, newer_);
    cycle = newer;
  }
  return Row::whole;
}

void TaskDoor::read(Snapshot& into) {
  const std::lock_guard lock(servers_);
  const Row row = read_row(into.cycle);
  into.values.assign(row_.begin(), row_.begin() + static_cast<std::ptrdiff_t>(points_.size()));
  for (std::size_t i = 0; i < further_.size(); ++i) {
    into.values.push_back(row == Row::whole && further_[i] ? row_[*further_[i]]
                                                           : plant_.committed()[parameter_count_ + i]);
  }
  for (std::size_t i = 0; i < plant_.staged().size(); ++i) {
    if (row == Row::none || plant_.is_staged(i)) {
      into.values[place_of(i)] = plant_.staged()[i];
    }
  }
}

std::shared_ptr<const LiveView> TaskDoor::view() const {
  const std::lock_guard lock(servers_);
  return view_;
}

void TaskDoor::read_live(LiveValues& into) {
  const std::lock_guard lock(servers_);
  const Row row = read_row(into.cycle);
  into.version = view_->version;
  into.values.resize(view_->points.size());
  into.staged.clear();
  into.forced.clear();
  for (std::size_t i = 0; i < into.values.size(); ++i) {
    into.values[i] = row_[columns_[i]];
    const auto parameter = parameter_at(view_->places[i]);
    const bool is_there = row == Row::whole || (row == Row::points && view_->places[i] < points_.size());
    if (parameter && !is_there) {
      into.values[i] = page_.committed()[*parameter];
    }
    if (parameter && page_.is_staged(*parameter)) {
      into.staged.push_back({.point = i, .value = page_.staged()[*parameter]});
    }
    if (i < inputs_ && row_[points_.size() + i] != 0.0) {
      into.forced.push_back(i);
    }
  }
  const auto inner = row_.begin() + static_cast<std::ptrdiff_t>(points_.size() + inputs_);
  into.inner.assign(inner, inner + static_cast<std::ptrdiff_t>(view_->inner.size()));
}

/// The parameter that is written at a place, by all that any version had.
std::optional<std::size_t> TaskDoor::parameter_at(std::size_t place) const {
  if (place >= points_.size()) {
    return parameter_count_ + place - points_.size();
  }
  return place >= first_parameter_ && place < first_parameter_ + parameter_count_
             ? std::optional(place - first_parameter_)
             : std::nullopt;
}

std::size_t TaskDoor::place_of(std::size_t parameter) const {
  return parameter < parameter_count_ ? first_parameter_ + parameter : points_.size() + parameter - parameter_count_;
}

std::string TaskDoor::write(std::span<const PointWrite> writes) {
  const std::lock_guard lock(servers_);
  return carry_out(writes, plant_, page_);
}

std::string TaskDoor::write_from_page(std::span<const PointWrite> writes) {
  const std::lock_guard lock(servers_);
  return writes_are_owned_ ? owned : carry_out(writes, page_, plant_);
}

std::string TaskDoor::carry_out(std::span<const PointWrite> writes, StagedParameters& own, StagedParameters& others) {
  // On copies, which take the place of the originals where nothing was refused.
  StagedParameters parameters = own;
  TaskOrders wanted = wanted_;
  for (const PointWrite& one : writes) {
    if (const auto parameter = parameter_at(one.point)) {
      if (gone_.at(*parameter)) {
        return judged_by_.parameters[*parameter].name +
               " is not in the version of the diagram that runs since an online change.";
      }
      parameters.stage(*parameter, one.value);
      continue;
    }
    const Point& point = points_[one.point];
    if (point.kind == PointKind::input) {
      if (!point.writable) {
        return point.name + " is given by a device.";
      }
      wanted.inputs[one.point] = one.value;
      ++wanted.input_writes[one.point];
    } else if (point.kind != PointKind::command) {
      return point.name + " can only be read.";
    }
  }
  // Commands after values, whatever their order in the request: a commit counts for what came with it.
  for (const PointWrite& one : writes) {
    if (parameter_at(one.point) || points_[one.point].kind != PointKind::command) {
      continue;
    }
    const auto command = static_cast<Command>(one.point - first_command_);
    if (command == Command::heartbeat) {
      wanted.heartbeat = one.value;
    } else if (one.value == 0.0) {
      continue;
    } else if (command == Command::discard) {
      parameters.discard();
    } else if (command == Command::reset) {
      ++wanted.resets;
    } else if (commits_are_held_) {
      return "An online change is under way: commit again in a second.";
    } else {
      if (auto refusal = parameters.commit(); !refusal.empty()) {
        return refusal;
      }
      wanted.parameters = parameters.committed();
      ++wanted.commits;
    }
  }
  own = std::move(parameters);
  if (wanted.commits != wanted_.commits) {
    others.follow(own.committed());
  }
  wanted_ = std::move(wanted);
  order();
  return {};
}

void TaskDoor::order() {
  orders_.filling() = wanted_;
  orders_.publish();
}

std::string TaskDoor::force(std::span<const Force> inputs) {
  const std::lock_guard lock(servers_);
  if (writes_are_owned_) {
    return owned;
  }
  row_.resize(points_.size());
  std::uint64_t cycle = 0;
  if (snapshots_.read(cycle, row_) && row_[first_status_ + 1] == static_cast<double>(Fault::hang)) {
    return "The watchdog has stopped the task: reset it first.";
  }
  auto forces = forces_now();
  for (const Force& one : inputs) {
    if (one.point >= inputs_) {
      return "Inputs alone can be forced.";
    }
    if (one.value) {
      if (auto refusal = refusal_of(judged_by_.inputs[one.point], *one.value); !refusal.empty()) {
        return refusal;
      }
    }
    forces[one.point] = one.value;
  }
  order_forces(std::move(forces));
  return {};
}

void TaskDoor::end_forces() {
  const std::lock_guard lock(servers_);
  order_forces(std::vector<std::optional<double>>(inputs_));
}

void TaskDoor::order_forces(std::vector<std::optional<double>> forces) {
  if (forces == wanted_.forces && ended_forcing_.load(std::memory_order_relaxed) != wanted_.forcing) {
    return;
  }
  wanted_.forces = std::move(forces);
  ++wanted_.forcing;
  was_forced_.store(true, std::memory_order_relaxed);
  order();
}

/// Those that were ordered last, where the task has not ended them since.
std::vector<std::optional<double>> TaskDoor::forces_now() const {
  return ended_forcing_.load(std::memory_order_relaxed) == wanted_.forcing ? std::vector<std::optional<double>>(inputs_)
                                                                           : wanted_.forces;
}

std::vector<std::string> TaskDoor::forced() {
  std::vector<std::string> texts;
  if (!was_forced_.load(std::memory_order_relaxed)) {
    return texts;  // as most tasks for ever, and this is asked all the time: without a lock
  }
  LiveValues now;
  read_live(now);
  for (const std::size_t input : now.forced) {
    texts.push_back(points_[input].name + " = " + number_text(now.values[input]));
  }
  return texts;
}

void TaskDoor::writes_are_owned(bool are_owned) {
  const std::lock_guard lock(servers_);
  if (are_owned && !writes_are_owned_) {
    order_forces(std::vector<std::optional<double>>(inputs_));
  }
  writes_are_owned_ = are_owned;
}

void TaskDoor::hold_commits(bool held) {
  const std::lock_guard lock(servers_);
  commits_are_held_ = held;
}

std::vector<Point> TaskDoor::points_of(const RunningVersion& version) const {
  const std::vector<ProgramSignal>& own = version.program.shape().parameters;
  const std::lock_guard lock(servers_);
  const std::size_t all = std::max(version.places.size(), judged_by_.parameters.size());
  std::vector<Point> points = points_;
  points.resize(points_.size() + all - parameter_count_);
  for (std::size_t i = 0; i < all; ++i) {
    const auto place = i < version.places.size() ? version.places[i] : std::nullopt;
    points[place_of(i)] = point_of(place ? own[*place] : judged_by_.parameters[i], PointKind::parameter, true);
  }
  return points;
}

std::shared_ptr<LiveRow> TaskDoor::live_row(const RunningVersion& version) const {
  return std::make_shared<LiveRow>(points_.size() + inputs_, version.program.shape().inner.size(),
                                   further_parameters(version, parameter_count_));
}

/// `version.places` is empty for the first.
void TaskDoor::make_view(const RunningVersion& version) {
  const ProgramShape& shape = version.program.shape();
  auto view = std::make_shared<LiveView>();
  view->version = version.number;
  view->picture = shape.picture;
  columns_.clear();
  further_.assign(gone_.size() - parameter_count_, std::nullopt);
  const auto show = [&](Point point, std::size_t place, std::size_t column) {
    view->points.push_back(std::move(point));
    view->places.push_back(place);
    columns_.push_back(column);
  };
  std::size_t further = points_.size() + inputs_ + shape.inner.size();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto parameter = parameter_at(i);
    if (!parameter) {
      show(points_[i], i, i);
    } else if (!gone_[*parameter]) {
      show(point_of(judged_by_.parameters[*parameter], PointKind::parameter, true), i, i);
    }
    if (i + 1 == first_parameter_ + parameter_count_) {
      for (std::size_t own = parameter_count_; own < gone_.size(); ++own) {
        if (!gone_[own]) {
          further_[own - parameter_count_] = further;
          show(point_of(judged_by_.parameters[own], PointKind::parameter, true), place_of(own), further++);
        }
      }
    }
  }
  for (const ProgramSignal& signal : shape.inner) {
    view->inner.push_back(point_of(signal, PointKind::output, false));
  }
  view_ = std::move(view);
  live_ = version.live;
}

void TaskDoor::version_changed(const RunningVersion& version) {
  const ProgramShape& shape = version.program.shape();
  const std::lock_guard lock(servers_);
  std::vector<double> values = plant_.committed();
  values.resize(version.parameters.size());
  gone_.assign(version.parameters.size(), true);
  judged_by_.parameters.assign(version.parameters.begin(), version.parameters.end());
  std::vector<std::size_t> backwards(shape.parameters.size());
  for (std::size_t i = 0; i < version.places.size(); ++i) {
    if (const auto own = version.places[i]) {
      gone_[i] = false;
      backwards[*own] = i;
      judged_by_.parameters[i] = shape.parameters[*own];
      values[i] = version.program.parameter(*own);
    }
  }
  judged_by_.relations = shape.relations;
  const auto translate = [&](RelatedNumber& one) {
    if (one.parameter) {
      one.parameter = backwards[*one.parameter];
    }
  };
  for (ProgramRelation& relation : judged_by_.relations) {
    std::ranges::for_each(relation.numbers, translate);
    if (relation.count) {
      translate(*relation.count);
    }
  }
  const auto moved = [&](const StagedParameters& before) {
    StagedParameters after(judged_by_, values);
    for (std::size_t i = 0; i < before.staged().size(); ++i) {
      if (!gone_[i] && before.is_staged(i)) {
        after.stage(i, before.staged()[i]);
      }
    }
    return after;
  };
  plant_ = moved(plant_);
  page_ = moved(page_);
  make_view(version);
}

void TaskDoor::shortage(Shortage what, bool is_there) noexcept {
  const auto bit = static_cast<std::uint16_t>(what);
  if (is_there) {
    shortages_.fetch_or(bit, std::memory_order_relaxed);
  } else {
    shortages_.fetch_and(static_cast<std::uint16_t>(~bit), std::memory_order_relaxed);
  }
}

void TaskDoor::publish(const StepProgram& program, std::span<const double> inputs, std::span<const double> outputs,
                       const TaskStatus& status, const LoopStatistics& statistics,
                       std::span<const std::optional<double>> forces, const LiveVersion& live) noexcept {
  auto at = std::ranges::copy(inputs, published_.begin()).out;
  at = std::ranges::copy(outputs, at).out;
  for (std::size_t i = 0; i < parameter_count_; ++i) {
    *at++ = program.parameter(i);
  }
  if (statistics.run % percentile_every == 0) {
    high_lateness_ = statistics.lateness.percentile(0.9999);
  }
  at = std::ranges::copy(status_values(status, statistics, high_lateness_, shortages_.load(std::memory_order_relaxed)),
                         at)
           .out;
  at = std::ranges::copy(status.field, at).out;
  at = std::fill_n(at, 3, 0.0);
  *at++ = status.heartbeat;
  for (std::size_t i = 0; i < inputs_; ++i) {
    *at++ = i < forces.size() && forces[i] ? 1.0 : 0.0;
  }
  program.inner_values(std::span(at, published_.end()));
  if (live.row != nullptr) {  // before the common one: who has that finds this one at least as new
    live.row->publish(statistics.run, published_, *live.program);
  }
  snapshots_.publish(statistics.run, published_);
  for (SampleTap* const tap : taps_) {
    tap->offer(statistics.run, statistics.elapsed, published_);
  }
}

}  // namespace hysteron::runtime
