#include "diagnosis/remedy/improved.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "codegen/compile.hpp"
#include "diagnosis/effects/edges.hpp"
#include "diagnosis/effects/insertion.hpp"
#include "diagnosis/remedy/inverse_blocks.hpp"
#include "support/errors.hpp"

namespace hysteron::diagnosis {
namespace {

/// The text with the sum of an effect written out, where the effect adds to its input; else the text as it is.
std::string written_as_sum(const std::string& text, const std::string& top, const Applied& applied) {
  if (!adds_to_input(applied.block)) {
    return text;
  }
  Diagnostics none;  // the text compiles
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", text, none));
  const Definitions definitions = define(source, none);
  const auto dot = applied.instance.rfind('.');
  const std::string prefix = dot == std::string::npos ? std::string() : applied.instance.substr(0, dot + 1);
  for (const BlockInstance& place : instances_of(definitions, top_definition(definitions, top))) {
    if (place.prefix == prefix) {
      return with_sum_outside(*source, place.definition, applied.instance.substr(prefix.size()));
    }
  }
  return text;
}

}  // namespace

std::size_t hidden_delays(const std::string& text) {
  Diagnostics found;
  auto source = language::parse("text", text, found);
  check(std::make_shared<const language::SourceFile>(std::move(source)), found);
  return static_cast<std::size_t>(
      std::ranges::count(found.all(), error::hidden_delay, [](const Diagnostic& one) { return one.number; }));
}

std::string improved_text(const Variant& variant, const std::string& path) {
  Diagnostics diagnostics;
  std::string text = format_text(path, variant.text, diagnostics, {.any_order = true});
  std::size_t left = hidden_delays(text);
  for (const Applied& applied : variant.effects) {
    if (left == 0) {
      break;
    }
    std::string other =
        format_text(path, written_as_sum(text, variant.program->graph.name, applied), diagnostics, {.any_order = true});
    if (const std::size_t there = hidden_delays(other); there < left) {
      text = std::move(other);
      left = there;
    }
  }
  return text;
}

bool has_influence(const Fit& fit, Index unknown, double typical) {
  constexpr double least = 1e-6;
  const double size = std::max(std::abs(typical), std::abs(fit.x[unknown]));
  return fit.jacobian.col(unknown).lpNorm<Eigen::Infinity>() * size > least;
}

parameters::ParameterFile improved_file(const Task& task, parameters::ParameterFile file,
                                        const Explanation& explanation) {
  const auto set = [&](const std::string& path, parameters::Value value) {
    for (parameters::ParameterValue& one : file.values) {
      if (language::same_name(one.path, path)) {
        one.value = std::move(value);
        return;
      }
    }
    file.values.push_back({.path = path, .value = std::move(value)});
  };
  const auto fitted = [&](const std::string& path) {
    return std::ranges::any_of(file.fits,
                               [&](const parameters::FitSetting& one) { return language::same_name(one.path, path); });
  };
  const VectorXd& x = explanation.fit.x;
  for (std::size_t j = 0; j < task.known.size(); ++j) {
    set(task.known[j].path, x[static_cast<Index>(j)]);
    for (parameters::FitSetting& one : file.fits) {
      if (language::same_name(one.path, task.known[j].path)) {
        one.start.reset();
      }
    }
  }
  for (std::size_t j = 0; j < explanation.variant.further.size(); ++j) {
    const std::string& path = explanation.variant.further[j].path;
    const Index at = std::ssize(task.known) + static_cast<Index>(j);
    const double value = x[at];
    if (!std::isfinite(value)) {
      continue;  // a bound that is not there: so the block has it by itself
    }
    set(path, value);
    // A fit refuses what the record says nothing of (HY719).
    if (!file.fits.empty() && !fitted(path) &&
        has_influence(explanation.fit, at, explanation.variant.further[j].typical)) {
      file.fits.push_back({.path = path});
    }
  }
  const Index first_state = std::ssize(task.known) + std::ssize(explanation.variant.further);
  for (std::size_t state = 0; state < task.initial_states.size(); ++state) {
    const std::string& path = task.initial_states[state];
    if (task.records.size() == 1) {  // of several records each has its own, which no file says
      file.set_initial(path, x[first_state + static_cast<Index>(state)]);
    }
    if (std::ranges::none_of(file.tune.initial_states, [&](const parameters::PlacedText& named) {
          return language::same_name(named.text, path);
        })) {
      file.tune.initial_states.push_back({.text = path});
    }
  }
  for (const Applied& applied : explanation.variant.effects) {
    for (const auto& [path, value] : applied.settings) {
      const std::int64_t found = find_parameter(explanation.variant.program->graph, path);
      const bool choice =
          found >= 0 &&
          explanation.variant.program->graph.parameters[static_cast<std::size_t>(found)].field.type == Type::Bool;
      set(path, choice ? parameters::Value(value != 0.0) : parameters::Value(value));
    }
  }
  return file;
}

}  // namespace hysteron::diagnosis
