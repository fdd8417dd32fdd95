#include "codegen/parameters/goal_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/parameters/parameter_names.hpp"
#include "codegen/parameters/settings_reader.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::parameters {
namespace {

using Number = std::optional<PlacedNumber> GoalSettings::*;
using Text = std::optional<PlacedText> GoalSettings::*;

/// Which values make sense of a number.
struct Range {
  double least = -infinity;
  bool is_above = false;  ///< the least itself does not
  double below = infinity;

  [[nodiscard]] bool holds(double value) const { return (is_above ? value > least : value >= least) && value < below; }
};
constexpr Range any{};
constexpr Range from_zero{.least = 0.0};
constexpr Range above_zero{.least = 0.0, .is_above = true};

struct NumberKey {
  std::string_view name;
  Number place;
  Range range;
};
constexpr std::array<NumberKey, 9> number_keys{{{"from", &GoalSettings::from, any},
                                                {"size", &GoalSettings::size, any},
                                                {"duration", &GoalSettings::duration, above_zero},
                                                {"rise_time", &GoalSettings::rise_time, above_zero},
                                                {"settling_time", &GoalSettings::settling_time, above_zero},
                                                {"order", &GoalSettings::order, any},
                                                {"damping", &GoalSettings::damping, above_zero},
                                                {"dead_time", &GoalSettings::dead_time, from_zero},
                                                {"effort_weight", &GoalSettings::effort_weight, from_zero}}};

struct TextKey {
  std::string_view name;
  Text place;
  std::string_view example;
  bool (*is_name)(std::string_view);
};
constexpr std::array<TextKey, 5> text_keys{{{"input", &GoalSettings::input, R"(input = "SP")", is_path},
                                            {"output", &GoalSettings::output, R"(output = "Y")", is_path},
                                            {"wished", &GoalSettings::wished, R"(wished = "Y_WISHED")", is_column},
                                            {"loop", &GoalSettings::loop, R"(loop = "PID.XOUT")", is_path},
                                            {"effort", &GoalSettings::effort, R"(effort = "PID.XOUT")", is_path}}};

/// In the order of GoalSettings::Signal and GoalSettings::Robust.
constexpr std::array<std::string_view, 3> signal_words{"step", "ramp", "record"};
constexpr std::array<std::string_view, 2> robust_words{"worst", "mean"};

/// All keys of a table, of whatever kind.
template <class... Kinds>
std::vector<std::string_view> keys_of(std::vector<std::string_view> keys, const Kinds&... kinds) {
  (std::ranges::transform(kinds, std::back_inserter(keys), [](const auto& key) { return key.name; }), ...);
  return keys;
}

class GoalReader : private SettingsReader {
 public:
  using SettingsReader::SettingsReader;

  GoalSettings read(const toml::table& table, const Place& place) {
    goal_.place = place;
    const auto known = keys_of({"signal", "robust", "plants", "limits"}, number_keys, text_keys);
    for (const auto& [key, node] : table) {
      if (!known_key(key, node, known, "[goal]")) {
        continue;
      }
      if (key.str() == "signal") {
        goal_.signal = static_cast<GoalSettings::Signal>(word_of(key, node, signal_words).value_or(0));
      } else if (key.str() == "robust") {
        goal_.robust = static_cast<GoalSettings::Robust>(word_of(key, node, robust_words).value_or(0));
      } else if (key.str() == "plants") {
        goal_.plants = names_of(key, node, R"(plants = ["light.toml", "heavy.toml"])", is_column);
      } else if (key.str() == "limits") {
        read_limits(key, node);
      } else if (const auto* const text = std::ranges::find(text_keys, key.str(), &TextKey::name);
                 text != text_keys.end()) {
        goal_.*text->place = name_of(key, node, text->example, text->is_name);
      } else {
        read_number(key, node, *std::ranges::find(number_keys, key.str(), &NumberKey::name));
      }
    }
    check();
    return std::move(goal_);
  }

 private:
  void read_limits(const toml::key& key, const toml::node& node) {
    const auto* const table = as_table(key, node);
    if (table == nullptr) {
      return;
    }
    const auto known = keys_of({}, goal_limit_keys);
    for (const auto& [name, value] : *table) {
      if (known_key(name, value, known, "[goal.limits]")) {
        const GoalLimitKey& limit = *std::ranges::find(goal_limit_keys, name.str(), &GoalLimitKey::name);
        read_number(name, value,
                    {limit.name,
                     limit.setting,
                     {.least = limit.above.value_or(0.0), .is_above = limit.above.has_value(), .below = limit.below}});
      }
    }
  }

  void read_number(const toml::key& key, const toml::node& node, const NumberKey& known) {
    const auto number = finite(key, node);
    if (!number) {
      return;
    }
    if (const auto& [least, is_above, below] = known.range; !known.range.holds(number->value)) {
      contradiction(number->place, fmt::format("{} is {}.", key.str(), number_text(number->value)),
                    fmt::format("write {}a number above {}{}.", is_above ? "" : number_text(least) + ", or ",
                                number_text(least), below < infinity ? " and below " + number_text(below) : ""));
      return;
    }
    goal_.*known.place = number;
  }

  void lacks(const Place& place, std::string cause, std::string mend) {
    diagnostics_.error(error::goal_lacks, place, std::move(cause), std::move(mend));
  }

  /// What stands beside each other, and what has a meaning only beside something else.
  void check() {
    if (goal_.rise_time && goal_.settling_time) {
      contradiction(goal_.rise_time->place, "The wished response has a rise_time and a settling_time.",
                    "keep one of the two: either fixes the response of a given order and damping.");
    }
    const bool has_model = goal_.rise_time || goal_.settling_time;
    if (goal_.wished && has_model) {
      contradiction(goal_.wished->place, "The wished response is a column of a record, and a model as well.",
                    "keep wished, or rise_time or settling_time.");
    }
    if (!goal_.wished && !has_model) {
      lacks(goal_.place, "[goal] does not say which response is wished.",
            "write settling_time = 0.5 (seconds to 2 %), rise_time = 0.2 (10 to 90 %), or the column of a record as in "
            "wished = \"Y_WISHED\".");
    }
    if (goal_.wished && goal_.signal != GoalSettings::Signal::Record) {
      contradiction(goal_.wished->place, "A wished response from a record needs the record's input.",
                    "write signal = \"record\".");
    }
    if (goal_.size && goal_.size->value == 0.0) {
      contradiction(goal_.size->place, "size is 0: nothing would be asked of the loop.", "write the size of the step.");
    }
    if (goal_.order && goal_.order->value != 1.0 && goal_.order->value != 2.0) {
      contradiction(goal_.order->place, fmt::format("order is {}.", number_text(goal_.order->value)), "write 1 or 2.");
    }
    if (goal_.damping && goal_.order && goal_.order->value == 1.0) {
      contradiction(goal_.damping->place, "A response of first order has no damping.",
                    "remove damping, or write order = 2.");
    }
    if (goal_.largest_overshoot && goal_.signal != GoalSettings::Signal::Step) {
      contradiction(goal_.largest_overshoot->place, "Only a step has an overshoot.",
                    "write signal = \"step\", or remove the limit.");
    }
    if (goal_.signal == GoalSettings::Signal::Record && (goal_.from || goal_.size || goal_.duration)) {
      const auto& first = goal_.from ? goal_.from : goal_.size ? goal_.size : goal_.duration;
      contradiction(first->place, "A record says itself where it begins, how far it goes and how long.",
                    "remove from, size and duration.");
    }
    if (goal_.limits_margins() && !goal_.loop) {
      const auto& first = goal_.phase_margin  ? goal_.phase_margin
                          : goal_.gain_margin ? goal_.gain_margin
                                              : goal_.sensitivity;
      lacks(first->place, "A margin is that of a loop, and [goal] does not say where it is cut.",
            "name a signal of the loop, most often the controller's output: loop = \"PID.XOUT\".");
    }
    const bool of_effort = goal_.largest_effort || goal_.largest_rate || goal_.effort_weight;
    if (of_effort && !goal_.effort && !goal_.loop) {
      const auto& first = goal_.largest_effort ? goal_.largest_effort
                          : goal_.largest_rate ? goal_.largest_rate
                                               : goal_.effort_weight;
      lacks(first->place, "[goal] does not say which signal is the effort.",
            "name it, most often the controller's output: effort = \"PID.XOUT\".");
    }
  }

  GoalSettings goal_{};
};

}  // namespace

GoalSettings read_goal(const toml::table& table, const Place& place, const std::string& file,
                       Diagnostics& diagnostics) {
  return GoalReader(file, diagnostics).read(table, place);
}

}  // namespace hysteron::parameters
