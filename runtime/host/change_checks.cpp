#include "runtime/host/change_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

/// Of the range of an output: what the EnTech Control Valve Dynamic Specification (version 3.0, 1998) counts as a small
/// step of a valve's input, "1% and less".
constexpr double part_of_range = 0.01;

std::string signal_text(const ProgramSignal& signal) {
  return signal.name + (signal.unit.empty() ? "" : " in " + signal.unit);
}

/// What of a signal must stay, as its registers and devices were planned with it.
void require_same_signals(const char* kind, const std::vector<ProgramSignal>& has,
                          const std::vector<ProgramSignal>& next, Diagnostics& found) {
  const auto refuse = [&](const std::string& cause) {
    found.error(error::other_interface, {}, cause,
                fmt::format("leave the {}s as they are, or end the task and start it with the new version: retained "
                            "values are carried over.",
                            kind));
  };
  for (std::size_t i = 0; i < has.size() || i < next.size(); ++i) {
    if (i >= next.size()) {
      refuse(fmt::format("The {} {} is gone.", kind, signal_text(has[i])));
    } else if (i >= has.size()) {
      refuse(fmt::format("The {} {} is new.", kind, signal_text(next[i])));
    } else if (has[i].name != next[i].name) {
      refuse(fmt::format("The {} {} stands where {} was.", kind, signal_text(next[i]), signal_text(has[i])));
      return;  // all behind it are shifted
    } else if (has[i].unit != next[i].unit) {
      refuse(fmt::format("The {} {} has another unit: {}.", kind, signal_text(has[i]), next[i].unit));
    } else if (has[i].type != next[i].type) {
      refuse(fmt::format("The {} {} has another type.", kind, has[i].name));
    } else if (has[i].low != next[i].low || has[i].high != next[i].high) {
      refuse(fmt::format("The range of the {} {} was {} to {}, and is {} to {}.", kind, has[i].name,
                         number_text(has[i].low), number_text(has[i].high), number_text(next[i].low),
                         number_text(next[i].high)));
    }
  }
}

/// The signals that a name means: the one, or the elements of the vector, that is named so; case makes no difference.
std::vector<std::string> meant_by(const std::string& name, const std::vector<ProgramSignal>& signals,
                                  const std::string& none) {
  std::vector<std::string> meant;
  std::vector<std::string> known;
  for (const ProgramSignal& signal : signals) {
    known.push_back(signal.name);
    if (is_or_is_element_of(signal.name, name)) {
      meant.push_back(signal.name);
    }
  }
  if (meant.empty()) {
    const auto near = nearest_name(name, known);
    throw InputError(error::bad_usage, {}, none,
                     near.empty() ? "write a name as `hysteron map` lists it; the name of a vector is each of its "
                                    "elements."
                                  : fmt::format("did you mean {}?", near));
  }
  return meant;
}

}  // namespace

void require_same_interface(const ProgramShape& has, const ProgramShape& next) {
  Diagnostics found;
  if (has.period != next.period) {
    found.error(error::other_interface, {},
                fmt::format("The sample time was {} ns, and is {} ns.", has.period, next.period),
                "keep it, or end the task and start it with the new version.");
  }
  require_same_signals("input", has.inputs, next.inputs, found);
  require_same_signals("output", has.outputs, next.outputs, found);
  if (found.has_errors()) {
    throw InputError(std::move(found));
  }
}

std::vector<OutputLimit> bump_limits(const RunConfig& config, const ProgramShape& shape) {
  std::vector<OutputLimit> limits;
  for (std::size_t i = 0; i < shape.outputs.size(); ++i) {
    const OutputSafety& safety = config.task.outputs[i];
    const double low = std::max(shape.outputs[i].low, safety.low);
    const double high = std::min(shape.outputs[i].high, safety.high);
    const bool is_analog = is_real(shape.outputs[i].type);
    OutputLimit one{.limit = {.low = low, .high = high}};
    if (const auto given = config.bumps.find(i); given != config.bumps.end()) {
      one.limit.most = given->second;
      one.origin = "bump in the run file at the start";
    } else if (is_analog && std::isfinite(low) && std::isfinite(high)) {
      one.limit.most = part_of_range * (high - low);
      one.origin = fmt::format("1 % of {:.6g} to {:.6g}", low, high);
    } else {
      one.origin = is_analog ? "it has no low and high" : "it is no real number";
    }
    limits.push_back(std::move(one));
  }
  return limits;
}

ChangeWish as_named(const ChangeWish& wish, const ProgramShape& next) {
  ChangeWish named = wish;
  named.bumps.clear();
  for (const auto& [name, most] : wish.bumps) {
    for (const std::string& output :
         meant_by(name, next.outputs, fmt::format("There is no output {} whose jump could be limited.", name))) {
      if (!named.bumps.emplace(output, most).second) {
        throw InputError(error::bad_usage, {}, fmt::format("--bump limits {} twice.", output),
                         "write each output once; case makes no difference, and the name of a vector is each of its "
                         "elements.");
      }
    }
  }
  named.as_given.clear();
  for (const std::string& name : wish.as_given) {
    for (std::string& parameter :
         meant_by(name, next.parameters, fmt::format("The new version has no parameter {}.", name))) {
      if (std::ranges::find(named.as_given, parameter) == named.as_given.end()) {
        named.as_given.push_back(std::move(parameter));
      }
    }
  }
  return named;
}

}  // namespace hysteron::runtime
