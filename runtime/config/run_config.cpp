#include "runtime/config/run_config.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "runtime/config/device_field.hpp"
#include "runtime/config/device_reader.hpp"
#include "runtime/config/history_reading.hpp"
#include "runtime/config/idle_keys.hpp"
#include "runtime/config/modbus_reader.hpp"
#include "runtime/config/mqtt_reader.hpp"
#include "runtime/config/tls_reader.hpp"
#include "runtime/config/toml_reader.hpp"
#include "runtime/config/web_reader.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::int64_t second = 1'000'000'000;
constexpr TomlKind run_file{error::run_file_syntax, error::run_key_twice,
                            "a table as [outputs.U] and a value as safe = 0.0"};

std::vector<std::string> names_of(const std::vector<ProgramSignal>& signals) {
  std::vector<std::string> names;
  names.reserve(signals.size());
  for (const ProgramSignal& signal : signals) {
    names.push_back(signal.name);
  }
  return names;
}

/// The signal of that name, or the elements of the vector.
std::vector<std::size_t> indices_of(std::string_view name, const std::vector<ProgramSignal>& signals) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (is_or_is_element_of(signals[i].name, name)) {
      indices.push_back(i);
    }
  }
  return indices;
}

class Reader {
 public:
  Reader(const std::string& file, std::string_view text, const ProgramShape& shape)
      : file_(file), shape_(shape), root_(parse_toml(file, text, run_file)) {}

  RunConfig read() {
    const TomlReader top(file_, "a run file", root_, top_keys(), found_);
    config_.task.loop.period = shape_.period;
    config_.task.loop.tolerance = shape_.period / 10;
    config_.task.inputs.resize(shape_.inputs.size());
    config_.task.outputs.resize(shape_.outputs.size());
    has_safe_value_.resize(shape_.outputs.size(), false);
    output_places_.resize(shape_.outputs.size(), {.file = file_});
    if (const auto* const table = table_at(root_, "task")) {
      read_task({file_, "[task]", *table, run_table("task").keys, found_});
    }
    if (const auto* const table = table_at(root_, "watchdog")) {
      read_watchdog({file_, "[watchdog]", *table, run_table("watchdog").keys, found_});
    }
    each_below("devices", [&](const toml::key& key, const toml::table& table) {
      const std::string name(key.str());
      devices_.read_device(name, {file_, "[devices." + name + "]", table, run_table("devices").keys, found_});
    });
    each_below("outputs", [&](const toml::key& key, const toml::table& table) { read_output(key, table); });
    each_below("inputs", [&](const toml::key& key, const toml::table& table) { read_input(key, table); });
    devices_.finish();
    config_.task.field_points = device_points(config_);
    if (const auto* const table = table_at(root_, "retain")) {
      read_retain({file_, "[retain]", *table, run_table("retain").keys, found_});
    }
    check_retained_inputs();
    if (const auto* const table = table_at(root_, "trace")) {
      read_trace({file_, "[trace]", *table, run_table("trace").keys, found_});
    }
    if (const auto* const table = table_at(root_, "online_change")) {
      read_online_change({file_, "[online_change]", *table, run_table("online_change").keys, found_});
    }
    if (const auto* const table = table_at(root_, "history")) {
      config_.history = HistoryReading(shape_, config_.task.field_points, found_)
                            .read({file_, "[history]", *table, run_table("history").keys, found_});
    }
    MqttReader(file_, shape_, config_, found_).read(table_at(root_, "mqtt"), table_at(root_, "dead_bands"));
    ModbusReader modbus(file_, config_, found_);
    modbus.read(table_at(root_, "modbus"), root_.contains("tls"));
    TlsReader(file_, config_, found_).read(table_at(root_, "tls"), table_at(root_, "roles"));
    modbus.read_line_of(table_at(root_, "modbus_rtu"));
    modbus.read_points(table_at(root_, "addresses"), table_at(root_, "registers"));
    if (const auto* const table = table_at(root_, "web")) {
      config_.web = read_web({file_, "[web]", *table, run_table("web").keys, found_}, found_);
    }
    for (std::size_t i = 0; i < has_safe_value_.size(); ++i) {
      if (!has_safe_value_[i]) {
        const std::string& name = shape_.outputs[i].name;
        found_.error(error::no_safe_value, output_places_[i], "The output " + name + " has no safe value.",
                     "write what it shall be when something is wrong: [outputs." + toml_key(name) +
                         "], and below it safe = 0.0.");
      }
    }
    if (found_.has_errors()) {
      throw InputError(sorted());
    }
    warn_of_idle_keys(file_, root_, config_, found_);
    config_.warnings = sorted();
    return std::move(config_);
  }

 private:
  const toml::table* table_at(const toml::table& parent, std::string_view key) {
    const auto* const node = parent.get(key);
    if (node != nullptr && !node->is_table()) {
      found_.error(error::wrong_run_value, place_of(file_, node->source()), std::string(key) + " must be a table.",
                   "write it as [" + std::string(key) + "], and its keys below.");
    }
    return node == nullptr ? nullptr : node->as_table();
  }

  template <class Read>
  void each_below(std::string_view group, const Read& read) {
    const auto* const parent = table_at(root_, group);
    if (parent == nullptr) {
      return;
    }
    for (const auto& [key, node] : *parent) {
      if (const auto* const table = table_at(*parent, key.str())) {
        read(key, *table);
      }
    }
  }

  void read_task(TomlReader table) {
    std::int64_t period = shape_.period;
    table.read_duration("period", period);
    if (period != shape_.period) {
      found_.error(error::wrong_period, table.place("period"),
                   "The period is not the sample time of " + shape_.name + ", which is " +
                       time_text(static_cast<double>(shape_.period)) + ".",
                   "leave the key out, or state another sample time in the diagram: (* @ts 1ms *).");
    }
    std::size_t policy = 0;
    table.read_choice("missed", policy);
    config_.task.loop.policy = static_cast<MissedPolicy>(policy);
    table.read_whole("catch_up", config_.task.loop.catch_up);
    table.read_duration("tolerance", config_.task.loop.tolerance, 1, shape_.period);
    table.read("load", config_.task.most_load);
    std::size_t overload = 0;
    table.read_choice("on_overload", overload);
    config_.task.overload_is_a_fault = overload == 1;
    std::size_t scheduling = 0;
    table.read_choice("scheduling", scheduling);
    constexpr std::array classes{Scheduling::fifo, Scheduling::deadline, Scheduling::other};
    config_.scheduling.scheduling = classes[scheduling];
    table.read_whole("priority", config_.scheduling.priority);
    table.read_whole("processor", config_.scheduling.processor);
    table.read("lock_memory", config_.scheduling.lock_memory);
  }

  void read_watchdog(TomlReader table) {
    table.read_duration("time", config_.task.watchdog.time);
    table.read_whole("sensitivity", config_.task.watchdog.sensitivity);
    table.read("guard", config_.guard);
    table.read_duration("guard_wait", config_.guard_wait);
    table.read_duration("silence", config_.silence, std::max<std::int64_t>(2 * shape_.period, 1'000'000),
                        1000 * second);
  }

  /// The ports that a table is about: one, or each element of a vector. None, with an error, where the diagram has no
  /// such name, or where a key can be of one element alone.
  std::vector<std::size_t> ports_of(const toml::key& key, const toml::table& node, std::string_view kind,
                                    const std::vector<ProgramSignal>& signals) {
    auto indices = indices_of(key.str(), signals);
    if (indices.empty()) {
      const auto names = names_of(signals);
      const auto near = nearest_name(key.str(), names);
      found_.error(error::unknown_port_in_run_file, place_of(file_, key.source()),
                   shape_.name + " has no " + std::string(kind) + " " + std::string(key.str()) + ".",
                   near.empty() ? "name one that the diagram declares, or remove the table."
                                : "did you mean " + std::string(near) + "?");
    }
    const bool is_vector = !indices.empty() && !equal_ignoring_case(signals[indices.front()].name, key.str());
    if (const auto* const device = node.get("device"); is_vector && device != nullptr) {
      const std::string heading = "[" + std::string(kind) + "s." + toml_key(signals[indices.front()].name) + "]";
      found_.error(error::wrong_run_value, place_of(file_, device->source()),
                   std::string(key.str()) + " is a vector, and each of its elements lies at a register of its own.",
                   "give each element a table: " + heading + ", with device and register below it.");
      return {};
    }
    for (const std::size_t index : indices) {
      if (!ports_seen_.insert(&signals[index]).second) {
        found_.error(error::run_key_twice, place_of(file_, key.source()),
                     "The " + std::string(kind) + " " + signals[index].name + " has been given before.",
                     is_vector || element_of(signals[index].name)
                         ? "keep one of the two; the name of a vector is each of its elements."
                         : "keep one of the two; case makes no difference.");
        break;
      }
    }
    return indices;
  }

  /// What is wrong with a table of a vector is said once, of its first element.
  template <class Read>
  void read_each(const std::vector<std::size_t>& ports, const Read& read) {
    const std::size_t before = found_.all().size();
    for (const std::size_t port : ports) {
      if (found_.all().size() == before) {
        read(port);
      }
    }
  }

  void read_output(const toml::key& key, const toml::table& node) {
    for (const std::size_t port : indices_of(key.str(), shape_.outputs)) {
      has_safe_value_[port] = has_safe_value_[port] || node.contains("safe");
      output_places_[port] = place_of(file_, key.source());
    }
    read_each(ports_of(key, node, "output", shape_.outputs), [&](std::size_t port) { read_output(port, key, node); });
  }

  void read_output(std::size_t port, const toml::key& key, const toml::table& node) {
    TomlReader table(file_, "[outputs." + std::string(key.str()) + "]", node, run_table("outputs").keys, found_);
    OutputSafety& output = config_.task.outputs[port];
    output.low = shape_.outputs[port].low;
    output.high = shape_.outputs[port].high;
    table.read("low", output.low);
    table.read("high", output.high);
    table.read("safe", output.value);
    table.read("slew", output.slew);
    table.read("ramp", output.ramp);
    table.read_whole("hold_cycles", output.hold_cycles);
    if (table.has("bump")) {
      table.read("bump", config_.bumps[port]);
    }
    std::size_t action = 0;
    table.read_choice("on_fault", action);
    output.action = static_cast<SafeAction>(action);
    devices_.read_output(port, read_longest_age(table), table);
    check_safe_value(port, table);
    if (output.action == SafeAction::ramp && !table.has("ramp")) {
      found_.error(error::unfit_safe_value, table.place("on_fault"), "A ramp is asked for, and no rate is given.",
                   "write the change a second: ramp = 20.0.");
    }
  }

  /// Held against the types first: no limit makes an integer hold a half.
  void check_safe_value(std::size_t port, const TomlReader& table) {
    const std::string& name = shape_.outputs[port].name;
    const OutputSafety& output = config_.task.outputs[port];
    if (!table.has("safe")) {
      return;  // which is said of it
    }
    const auto refuse = [&](const std::string& why, const std::string& mend) {
      found_.error(error::unfit_safe_value, table.place("safe"),
                   "The safe value " + number_text(output.value) + " of " + name + why, mend);
    };
    const auto is_held = [&](const modbus::PointFormat& format, const std::string& where, const std::string& mend) {
      const bool held = modbus::holds(format, output.value);
      const auto [low, high] = modbus::limits_of(format);
      if (!held) {
        refuse(" is none that the type of " + where + " holds, " + modbus::name_of(format.type) + ".",
               std::string("choose a ") + (modbus::is_real(format.type) || format.is_scaled() ? "" : "whole ") +
                   "number from " + number_text(low) + " to " + number_text(high) +
                   (format.is_scaled() && !modbus::is_real(format.type)
                        ? " in steps of " + number_text(std::abs(format.scale))
                        : "") +
                   mend + ".");
      }
      return held;
    };
    if (!is_held({.type = shape_.outputs[port].type}, "the output", "")) {
      return;
    }
    const auto on_device = std::ranges::find(config_.device_outputs, port, &DeviceOutput::port);
    if (on_device != config_.device_outputs.end()) {
      const modbus::DeviceOptions& device = config_.devices[on_device->link.device];
      if (!is_held(device.values[on_device->link.value].format, "its place on " + device.name, ", or another type")) {
        return;
      }
    }
    if (!(output.low <= output.high)) {
      found_.error(error::run_value_out_of_range, table.place(table.has("low") ? "low" : "high"),
                   "The limits of " + name + " leave no value: low is " + number_text(output.low) + ", and high " +
                       number_text(output.high) + ".",
                   "choose a low that is at most high; what is left out here counts as the diagram or the type of the "
                   "register has it.");
    } else if (output.value < output.low || output.value > output.high) {
      refuse(" is not within its limits, " + number_text(output.low) + " to " + number_text(output.high) + ".",
             "choose a safe value that the output may have, or widen the limits.");
    }
  }

  void read_input(const toml::key& key, const toml::table& node) {
    read_each(ports_of(key, node, "input", shape_.inputs), [&](std::size_t port) {
      TomlReader table(file_, "[inputs." + std::string(key.str()) + "]", node, run_table("inputs").keys, found_);
      devices_.read_input(port, read_longest_age(table), table);
    });
  }

  std::int64_t read_longest_age(TomlReader& table) const {
    std::int64_t age = 0;
    table.read_duration("longest_age", age, shape_.period, 1000 * second);
    return age;
  }

  void read_online_change(TomlReader table) {
    ChangeConfig change{.place = table.place("socket")};
    table.read("socket", change.socket);
    table.read("load", change.most_load);
    if (!table.has("socket")) {
      found_.error(error::wrong_run_value, change.place, "[online_change] needs the key socket, a file's name.",
                   "write it as in socket = \"online-change.socket\", or remove the table.");
    }
    config_.online_change = std::move(change);
  }

  void read_retain(TomlReader table) {
    RetainConfig retain{.place = table.place("folder")};
    table.require("folder", "\"retained\"");
    table.read("folder", retain.folder);
    if (table.is_whole("every") && root_["retain"]["every"].value_or(std::int64_t{0}) < 1) {
      found_.error(error::run_value_out_of_range, table.place("every"),
                   "A whole number at every counts cycles, and there is none of less than 1.",
                   "write every = 1 for each cycle, or a time as every = \"1s\"; what a client commits is written at "
                   "once besides.");
    } else if (table.is_whole("every")) {
      table.read_whole("every", config_.task.retain_every);
    } else {
      std::int64_t every = 1'000'000'000;
      table.read_duration("every", every);
      config_.task.retain_every =
          static_cast<std::uint64_t>(std::max<std::int64_t>(1, every / std::max<std::int64_t>(1, shape_.period)));
    }
    auto mismatch = static_cast<std::size_t>(retain.mismatch);
    table.read_choice("mismatch", mismatch);
    retain.mismatch = static_cast<MismatchPolicy>(mismatch);
    config_.retain = std::move(retain);
  }

  void read_trace(TomlReader table) {
    TraceSettings trace;
    std::string file;
    table.require("file", "\"run.trace\"");
    table.read("file", file);
    trace.file = file;
    std::uint64_t megabytes = 1024;
    table.read_whole("megabytes", megabytes);
    table.read_whole("files", trace.files);
    trace.file_bytes = std::max<std::uint64_t>(1, megabytes * 1'000'000 / trace.files);
    std::string trigger;
    table.read("trigger", trigger);
    TraceTrigger kept;
    table.read_whole("before", kept.before);
    table.read_whole("after", kept.after);
    table.read_whole("captures", kept.captures);
    if (trigger.empty()) {
      for (const char* const key : {"before", "after", "captures"}) {
        if (table.has(key)) {
          found_.error(error::wrong_run_value, table.place(key),
                       std::string(key) + " is of a trigger, and none is given.",
                       "write one as in trigger = \"fault\", or remove the key.");
        }
      }
    } else {
      trace.trigger = parse_trigger(trigger, shape_);
      if (!trace.trigger) {
        found_.error(error::wrong_run_value, table.place("trigger"),
                     "The trigger \"" + trigger + "\" is not understood.",
                     "write an input or output, < or >, and a number: \"U > 5.0\"; or \"fault\".");
      } else {
        trace.trigger->before = kept.before;
        trace.trigger->after = kept.after;
        trace.trigger->captures = kept.captures;
        check_trigger(*trace.trigger, trace.files, table);
      }
    }
    config_.trace = std::move(trace);
    config_.trace_place = table.place("file");
  }

  /// Of the first key with which an input asks to be retained.
  [[nodiscard]] Place place_of_retain() const {
    Place first{.file = file_};
    for (const auto& [name, input] : *root_["inputs"].as_table()) {
      const auto* const asked = input.is_table() ? input.as_table()->get("retain") : nullptr;
      if (asked != nullptr && asked->value_or(false)) {
        const Place place = place_of(file_, asked->source());
        first = first.line == 0 || place.line < first.line ? place : first;
      }
    }
    return first;
  }

  void check_retained_inputs() {
    const auto is_any =
        std::ranges::any_of(config_.task.inputs, [](const InputSettings& one) { return one.is_retained; });
    if (is_any && !root_.contains("retain")) {
      found_.error(error::wrong_run_value, place_of_retain(), "An input has retain = true, and nothing is retained.",
                   "add [retain] with folder = \"retained\", or remove the key.");
    }
  }

  /// What is kept before it has room in memory, and what it captures on the disk.
  void check_trigger(const TraceTrigger& trigger, std::size_t files, const TomlReader& table) {
    constexpr std::uint64_t most_memory = 256'000'000;
    const std::uint64_t memory = memory_before(trigger, shape_.inputs.size(), shape_.outputs.size());
    if (memory > most_memory) {
      found_.error(
          error::run_value_out_of_range, table.place("before"),
          "What is kept of " + std::to_string(trigger.before) + " cycles before the trigger takes up to " +
              std::to_string(memory / 1'000'000) + " MB of memory.",
          "choose " + std::to_string(trigger.before / (memory / most_memory + 1)) + " or fewer: 256 MB are the most.");
    }
    if (trigger.captures > files) {
      found_.error(error::run_value_out_of_range, table.place("captures"),
                   "Each capture takes a file, and files = " + std::to_string(files) + " lets the first of " +
                       std::to_string(trigger.captures) + " go.",
                   "choose captures = " + std::to_string(files) + " or fewer, or more files.");
    }
  }

  /// In the order of the file; the library gives keys in that of their names.
  [[nodiscard]] Diagnostics sorted() const {
    auto list = found_.all();
    std::ranges::stable_sort(list, {},
                             [](const Diagnostic& one) { return std::tuple(one.place.line, one.place.column); });
    Diagnostics result;
    for (Diagnostic& one : list) {
      result.add(std::move(one));
    }
    return result;
  }

  std::string file_;
  const ProgramShape& shape_;
  toml::table root_;
  RunConfig config_{};
  std::vector<bool> has_safe_value_{};
  std::vector<Place> output_places_{};  ///< of its table; of the file where it has none
  std::set<const ProgramSignal*> ports_seen_{};
  Diagnostics found_{};
  DeviceReader devices_{file_, shape_, config_, found_};
};

}  // namespace

RunConfig parse_run_config(const std::string& file, std::string_view text, const ProgramShape& shape) {
  return Reader(file, text, shape).read();
}

std::optional<ChangeConfig> change_config_of(const std::string& file, std::string_view text) {
  const toml::table root = parse_toml(file, text, run_file);
  const auto* const table = root["online_change"].as_table();
  const auto* const socket = table == nullptr ? nullptr : table->get("socket");
  const auto path = socket == nullptr ? std::nullopt : socket->value<std::string>();
  return path ? std::optional(ChangeConfig{.socket = *path, .place = place_of(file, socket->source())}) : std::nullopt;
}

}  // namespace hysteron::runtime
