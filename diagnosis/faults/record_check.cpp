#include "diagnosis/faults/record_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string_view>
#include <vector>

#include "diagnosis/faults/sensor_faults.hpp"
#include "diagnosis/model/task.hpp"
#include "support/median.hpp"
#include "support/numbers.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t fewest_samples = 100;

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

Moments moments(const std::vector<double>& values) {
  Moments result;
  const auto count = static_cast<double>(values.size());
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  for (const double v : values) {
    result.deviation += (v - result.mean) * (v - result.mean) / count;
  }
  result.deviation = std::sqrt(result.deviation);
  return result;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Moments x = moments(a);
  const Moments y = moments(b);
  if (!(x.deviation > 0.0) || !(y.deviation > 0.0)) {
    return 0.0;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += (a[k] - x.mean) * (b[k] - y.mean);
  }
  return sum / (static_cast<double>(a.size()) * x.deviation * y.deviation);
}

bool moves(const Signal& signal) {
  return signal.size() > 1 && std::ranges::max(signal) > std::ranges::min(signal);
}

/// The share of samples that stand exactly at the largest or smallest value in runs of five or more.
double clipped_share(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  if (!(high > low)) {
    return 0.0;
  }
  std::size_t count = 0;
  std::size_t run = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const bool at_end = values[k] == low || values[k] == high;
    run = at_end && k > 0 && values[k] == values[k - 1] ? run + 1 : 0;
    count += run >= 5 ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(values.size());
}

/// Where a signal turns, with reversals below a hundredth of its range left out, and how long each way takes.
struct Turns {
  std::vector<double> levels{};
  std::vector<double> ways{};  ///< samples from one turn to the next
};

Turns turns_of(const Signal& signal, double range) {
  const double band = 0.01 * range;
  Turns turns;
  std::size_t extreme = 0;
  std::size_t last = 0;
  double heading = 0.0;
  for (std::size_t k = 1; k < signal.size(); ++k) {
    const double from_extreme = signal[k] - signal[extreme];
    if (heading * from_extreme > 0.0) {
      extreme = k;
    } else if (std::abs(from_extreme) > band) {
      if (heading != 0.0) {
        turns.ways.push_back(static_cast<double>(extreme - last));
      }
      turns.levels.push_back(signal[extreme]);
      last = extreme;
      extreme = k;
      heading = from_extreme;
    }
  }
  turns.levels.push_back(signal[extreme]);
  return turns;
}

/// Whether all input signals go to and fro between two levels in one time, or from one level to another once: a sine,
/// a triangle, a step. Each effect then shows as one shape of the response, and many have it.
bool is_one_motion(const std::vector<Experiment>& experiments) {
  constexpr double same_level = 0.03;
  constexpr double same_time = 0.1;
  const std::size_t count = experiments.front().drive.inputs.size();
  for (std::size_t input = 0; input < count; ++input) {
    Turns all;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Experiment& experiment : experiments) {
      const Signal& signal = experiment.drive.inputs[input];
      if (signal.empty()) {
        continue;
      }
      const auto [least, most] = std::ranges::minmax(signal);
      low = std::min(low, least);
      high = std::max(high, most);
      if (most > least) {
        const Turns turns = turns_of(signal, most - least);
        all.levels.insert(all.levels.end(), turns.levels.begin(), turns.levels.end());
        // The first way begins anywhere.
        all.ways.insert(all.ways.end(), turns.ways.begin() + (turns.ways.empty() ? 0 : 1), turns.ways.end());
      }
    }
    if (!(high > low)) {
      continue;
    }
    std::size_t between = 0;
    for (const double level : all.levels) {
      between += std::min(level - low, high - level) > same_level * (high - low) ? 1 : 0;
    }
    // Where the record begins and ends may be anywhere between.
    const bool two_levels = between <= 2 * experiments.size();
    const bool one_time =
        all.ways.empty() || std::ranges::max(all.ways) <= (1.0 + same_time) * std::ranges::min(all.ways);
    if (!two_levels || !one_time) {
      return false;
    }
  }
  return true;
}

/// Larger than anything that is measured: squares and sums of them are finite up to here.
constexpr double largest_measured = 1e100;
/// So many times as far from the middle as all other samples: beside it a double keeps too few digits of them.
constexpr double absurdly_far = 1e9;

std::string sample_text(const records::Record& record, const records::Column& column, std::size_t row) {
  const Place place = record.place(column.name, row);
  return fmt::format(
      "{} is {:.3g} at t = {:.6g} s{}", column.name, column.values[row], record.time()[row],
      place.line > 0 ? fmt::format(" ({}, line {})", place.file, place.line) : fmt::format(" (sample {})", row + 1));
}

/// The one sample that lies absurdly far off the others, or the first that no sensor gives; empty where there is none.
std::string absurd_sample(const records::Record& record, const records::Column& column) {
  const std::vector<double>& values = column.values;
  const auto huge = std::ranges::find_if(values, [](double v) { return std::abs(v) > largest_measured; });
  const double middle = median(values);
  std::size_t farthest = 0;
  double second = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double here = std::abs(values[k] - middle);
    const double there = std::abs(values[farthest] - middle);
    second = std::max(second, std::min(here, there));
    farthest = here > there ? k : farthest;
  }
  if (second > 0.0 && std::abs(values[farthest] - middle) > absurdly_far * second) {
    return fmt::format("{}, a billion times as far off as any other sample: a slip of the logger. Take it out.",
                       sample_text(record, column, farthest));
  }
  if (huge != values.end()) {
    return fmt::format("{}: no sensor gives such a value. Export the column anew.",
                       sample_text(record, column, static_cast<std::size_t>(huge - values.begin())));
  }
  return {};
}

class Check {
 public:
  Check(const Task& task, const Model& model, const VectorXd& nominal)
      : task_(task), problem_(model.problem()), nominal_(nominal), left_out_(task.left_out) {
    std::ranges::sort(left_out_);
  }

  RecordCheck run() {
    std::size_t total = 0;
    bool moving = false;
    for (const Experiment& experiment : problem_.experiments) {
      total += experiment.drive.steps;
      moving = moving || std::ranges::any_of(experiment.drive.inputs, moves);
    }
    if (total < fewest_samples) {
      refuse(fmt::format("The records have {} samples, and fewer than {} cannot tell an effect from noise.", total,
                         fewest_samples));
      return std::move(result_);
    }
    if (!moving) {
      refuse("No input moves: the record shows how the machine rests, not how it differs from the model.");
      return std::move(result_);
    }
    Index row = 0;
    for (std::size_t output = 0; output < problem_.outputs.size(); ++output) {
      std::vector<double> measured;
      std::vector<double> model;
      for (const Experiment& experiment : problem_.experiments) {
        for (const double y : experiment.measured[output]) {
          const Index here = row++;
          if (std::ranges::find(task_.left_out, here) == task_.left_out.end()) {  // a glitch says nothing of the rest
            measured.push_back(y);
            model.push_back(y + nominal_[here] * task_.scales[output]);
          }
        }
      }
      const Port& port = problem_.program.graph.outputs[problem_.outputs[output]];
      check_output(port, measured, model);
      check_sensor(output, port);
    }
    check_swap();
    result_.one_motion = is_one_motion(problem_.experiments);
    if (result_.one_motion) {
      warn(
          "The inputs make one motion only, a step or to and fro between two levels in one time: many effects have "
          "such "
          "a response. Record several amplitudes and rates.");
    }
    return std::move(result_);
  }

 private:
  void refuse(std::string text) { result_.refusals.push_back(std::move(text)); }
  void warn(std::string text) { result_.warnings.push_back(std::move(text)); }

  void check_output(const Port& port, const std::vector<double>& measured, const std::vector<double>& model) {
    const Moments seen = moments(measured);
    const Moments simulated = moments(model);
    if (!(seen.deviation > 0.0)) {
      refuse(fmt::format("The output {} never changes: a sensor that is stuck or not connected.", port.name));
      return;
    }
    if (const double share = clipped_share(measured); share > 0.02) {
      warn(fmt::format("{:.0f} % of {} stand exactly at its largest or smallest value: a clipped sensor, or a stop.",
                       100.0 * share, port.name));
    }
    if (!(simulated.deviation > 1e-9 * seen.deviation)) {  // residuals in units of the floor round
      if (moves_by_itself(port)) {
        refuse(
            fmt::format("{} is more than a billion times as large as the model's: the units of record and diagram "
                        "differ ({}).",
                        port.name, port.unit.empty() ? "the diagram states none" : "diagram: " + port.unit));
        return;
      }
      refuse(fmt::format("The model's {} does not move under the record's inputs: are its inputs the right columns?",
                         port.name));
      return;
    }
    const double together = correlation(measured, model);
    if (together < -0.5) {
      refuse(fmt::format("{} moves against the model (correlation {:.2f}): a sign is mirrored in record or diagram.",
                         port.name, together));
      return;
    }
    // The slope of the measured output over the model's: what an effect adds beside it, a drift say, does not count.
    const double ratio = together * seen.deviation / simulated.deviation;
    const double decades = together > 0.3 ? std::log10(ratio) : 0.0;
    if (std::abs(decades) > 1.5 && std::abs(decades - std::round(decades)) < 0.15) {
      refuse(
          fmt::format("{} is {:.3g} times as large as the model's, almost a power of ten: the units of record and "
                      "diagram differ ({}).",
                      port.name, ratio, port.unit.empty() ? "the diagram states none" : "diagram: " + port.unit));
      return;
    }
    if (together < 0.3) {
      warn(fmt::format("{} has little in common with the model (correlation {:.2f}).", port.name, together));
    }
    check_temperature(port, measured, model, seen);
  }

  /// Whether the model moves where no record stands beside it.
  [[nodiscard]] bool moves_by_itself(const Port& port) const {
    const auto output = static_cast<std::size_t>(&port - problem_.program.graph.outputs.data());
    return std::ranges::any_of(task_.records, [&](const records::Record& record) {
      return moves(simulate(problem_.program, record)[output]);
    });
  }

  /// Temperatures in another unit: what an offset among the parameters would take up without a word.
  void check_temperature(const Port& port, const std::vector<double>& measured, const std::vector<double>& model,
                         const Moments& seen) {
    struct Conversion {
      std::string_view from;
      std::string_view to;
      double gain;
      double offset;
    };
    static constexpr std::array conversions{
        Conversion{.from = "degC", .to = "K", .gain = 1.0, .offset = 273.15},
        Conversion{.from = "K", .to = "degC", .gain = 1.0, .offset = -273.15},
        Conversion{.from = "degC", .to = "degrees Fahrenheit", .gain = 1.8, .offset = 32.0},
        Conversion{.from = "K", .to = "degrees Fahrenheit", .gain = 1.8, .offset = -459.67}};
    const auto off = [&](double gain, double offset) {
      double sum = 0.0;
      for (std::size_t k = 0; k < measured.size(); ++k) {
        sum += std::pow(measured[k] - gain * model[k] - offset, 2);
      }
      return std::sqrt(sum / static_cast<double>(measured.size()));
    };
    const double as_it_is = off(1.0, 0.0);
    for (const Conversion& one : conversions) {
      constexpr double explained = 0.2;
      const double converted = port.unit == one.from ? off(one.gain, one.offset) : as_it_is;
      if (converted < explained * as_it_is && converted < 0.5 * seen.deviation) {
        refuse(fmt::format(
            "{} is off the model by {:.3g} {}, and by {:.3g} where the record is taken to be in {}: convert "
            "the column to {}.",
            port.name, as_it_is, port.unit, converted, one.to, one.from));
        return;
      }
    }
  }

  /// Readings that no machine gives: they are named by time, and what is spoilt is left out or, where it is much,
  /// refused.
  void check_sensor(std::size_t output, const Port& port) {
    constexpr double most = 0.2;
    std::size_t spoilt = 0;
    std::size_t total = 0;
    std::vector<std::string> texts;
    Index row = first_row(output);
    for (const Experiment& experiment : problem_.experiments) {
      const std::vector<double>& measured = experiment.measured[output];
      std::vector<double> model;
      std::vector<std::size_t> glitches;
      for (std::size_t k = 0; k < measured.size(); ++k) {
        const Index here = row + static_cast<Index>(k);
        model.push_back(measured[k] + nominal_[here] * task_.scales[output]);
        if (std::ranges::binary_search(left_out_, here)) {
          glitches.push_back(k);
        }
      }
      const std::string where = problem_.experiments.size() > 1 ? " of " + experiment.name : "";
      for (const SensorFault& fault : find_sensor_faults(measured, model, glitches)) {
        const auto [from, to] =
            distinct_texts(experiment.time[fault.rows.first], experiment.time[fault.rows.last - 1], 6);
        switch (fault.kind) {
          case SensorFault::Kind::Stuck:
            texts.push_back(
                fmt::format("{} stands at exactly {:.4g} {} from {} to {} s{}, and is noisy elsewhere: "
                            "the sensor is stuck",
                            port.name, fault.value, port.unit, from, to, where));
            break;
          case SensorFault::Kind::Dropout:
            texts.push_back(
                fmt::format("{} leaps to exactly {:.4g} {} from {} to {} s{} and back: its readings "
                            "drop out",
                            port.name, fault.value, port.unit, from, to, where));
            break;
          case SensorFault::Kind::Leap:
            warn(
                fmt::format("{} leaps by {:.3g} {} at {} s{}, far more than it or the model ever does from one sample "
                            "to the next: a piece of the record may be missing there. Cut it there into two records.",
                            port.name, fault.value, port.unit, from, where));
            continue;
        }
        spoilt += fault.rows.size();
        for (std::size_t k = fault.rows.first; k < fault.rows.last; ++k) {
          result_.left_out.push_back(row + static_cast<Index>(k));
        }
      }
      total += measured.size();
      row += std::ssize(measured);
    }
    const bool much = static_cast<double>(spoilt) > most * static_cast<double>(total);
    for (const std::string& text : texts) {
      if (much) {
        refuse(text + ". Cut the record there.");
      } else {
        warn(text + "; these samples are left out of the fits.");
      }
    }
  }

  /// Of an output, in the residuals of all.
  [[nodiscard]] Index first_row(std::size_t output) const {
    return static_cast<Index>(output) * nominal_.size() / std::ssize(problem_.outputs);
  }

  /// Whether the model explains the record much better with an input and an output column exchanged.
  void check_swap() {
    const double before = nominal_.squaredNorm();
    for (const Port& input : problem_.program.graph.inputs) {
      for (const std::string& output : task_.outputs) {
        const records::Record& first = task_.records.front();
        if (input.type != Type::Real || first.find(input.name) == nullptr || first.find(output) == nullptr) {
          continue;
        }
        Task swapped = task_;
        for (records::Record& record : swapped.records) {
          records::Record other = records::Record::even(record.time().front(), record.sample_time(), record.size());
          for (records::Column column : record.columns()) {
            if (language::same_name(column.name, input.name)) {
              column.values = record.column(output).values;
            } else if (language::same_name(column.name, output)) {
              column.values = record.column(input.name).values;
            }
            other.add(std::move(column));
          }
          record = std::move(other);
        }
        try {
          Model model(swapped, problem_.program);
          VectorXd residuals;
          if (model.residuals(model.start(), residuals) && residuals.squaredNorm() < 0.02 * before) {
            refuse(fmt::format(
                "The model fits {:.0f} times better with the columns {} and {} exchanged: are they swapped?",
                std::sqrt(before / residuals.squaredNorm()), input.name, output));
          }
        } catch (const InputError&) {
          continue;  // the values of one do not fit the other
        }
      }
    }
  }

  const Task& task_;
  const OutputErrorProblem& problem_;
  const VectorXd& nominal_;
  std::vector<Index> left_out_;  ///< of the task, sorted
  RecordCheck result_{};
};

}  // namespace

std::vector<std::string> absurd_samples(const Task& task, const Graph& graph) {
  std::vector<std::string> found;
  for (const records::Record& record : task.records) {
    for (const records::Column& column : record.columns()) {
      const auto named = [&](const auto& port) { return language::same_name(port.name, column.name); };
      const bool measured = std::ranges::any_of(
          task.outputs, [&](const std::string& output) { return language::same_name(output, column.name); });
      if (!measured && std::ranges::none_of(graph.inputs, named)) {
        continue;
      }
      if (std::string one = absurd_sample(record, column); !one.empty()) {
        found.push_back(std::move(one));
      }
    }
  }
  return found;
}

RecordCheck check_records(const Task& task, const Model& model, const VectorXd& nominal) {
  RecordCheck result = Check(task, model, nominal).run();
  // No fault of a record, but what the nominal rests on as well.
  std::ranges::move(remarks_on_bounds(task), std::back_inserter(result.warnings));
  return result;
}

}  // namespace hysteron::diagnosis
