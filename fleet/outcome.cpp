#include "fleet/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "support/text_file.hpp"

namespace hysteron::fleet {
namespace {

// Half of the 95 % interval of a normal distribution over its standard deviation.
constexpr double half_of_95 = 1.959964;

double number_of(const nlohmann::json& value) {
  return value.is_number() ? value.get<double>() : not_a_number;
}

void add_intervals(Outcome& outcome, const std::string& source, const std::string& before,
                   const nlohmann::json& parameters) {
  for (const auto& [name, one] : parameters.items()) {
    FoundParameter found{.source = source,
                         .name = before + name,
                         .value = number_of(one.at("value")),
                         .low = number_of(one.at("low")),
                         .high = number_of(one.at("high")),
                         .unit = one.at("unit")};
    found.standard_error = (found.high - found.low) / (2.0 * half_of_95);
    outcome.parameters.push_back(std::move(found));
  }
}

void add_fitted(Outcome& outcome, const std::string& source, const nlohmann::json& parameters) {
  for (const nlohmann::json& one : parameters) {
    FoundParameter found{.source = source,
                         .name = one.at("name"),
                         .value = number_of(one.at("value")),
                         .standard_error = number_of(one.at("standard_error")),
                         .unit = one.at("unit"),
                         .at_bound = one.at("at_bound")};
    found.low = found.value - half_of_95 * found.standard_error;
    found.high = found.value + half_of_95 * found.standard_error;
    outcome.parameters.push_back(std::move(found));
  }
}

Outcome diagnosis_of(const nlohmann::json& json) {
  Outcome outcome{.verdict = json.at("verdict")};
  for (const nlohmann::json& one : json.at("effects")) {
    outcome.effects.push_back(
        {.effect = one.at("id"), .edge = one.at("edge"), .share = number_of(one.at("share")), .named = true});
    const FoundEffect& effect = outcome.effects.back();
    add_intervals(outcome, "effect", fmt::format("{} at {}: ", effect.effect, effect.edge), one.at("parameters"));
  }
  for (const nlohmann::json& family : json.at("families")) {
    const std::string id = family.at("effect");
    const auto known = std::ranges::find(outcome.effects, id, &FoundEffect::effect);
    FoundEffect& effect = known != outcome.effects.end() ? *known : outcome.effects.emplace_back();
    effect.family = family.at("family");
    outcome.families[effect.family] =
        number_of(family.value("probability_by_record", family.value("probability", nlohmann::json())));
    effect.probability = number_of(family.at("effect_probability"));
    if (!effect.named) {
      effect.effect = id;
      effect.edge = family.at("edge");
    }
  }
  add_intervals(outcome, "calibration", "", json.at("calibration"));
  outcome.confidence = number_of(json.at("confidence"));
  for (const nlohmann::json& one : json.at("effects")) {
    // Where the evidence has weighed the families, it has said so already, without the prior.
    outcome.families.try_emplace(one.value("family", one.at("id").get<std::string>()), outcome.confidence);
  }
  outcome.nominal_rms = number_of(json.at("gap").at("nominal_rms"));
  outcome.improved_rms = number_of(json.at("gap").at("improved_rms"));
  outcome.unit_of_gap = json.at("gap").at("unit");
  return outcome;
}

Outcome fit_of(const nlohmann::json& json) {
  Outcome outcome{.verdict = json.at("status")};
  add_fitted(outcome, "fit", json.at("parameters"));
  add_fitted(outcome, "initial state", json.at("initial_states"));
  if (!json.at("outputs").empty()) {
    const nlohmann::json& first = json.at("outputs").front();
    outcome.nominal_rms = number_of(first.at("rmse_before"));
    outcome.improved_rms = number_of(first.at("rmse_train"));
    outcome.unit_of_gap = first.at("unit");
  }
  return outcome;
}

/// A loop that was tuned for a goal: the error is that of the plant that it is largest with, a share of the step.
Outcome loop_of(const nlohmann::json& json) {
  Outcome outcome{.verdict = json.at("status")};
  for (const nlohmann::json& one : json.at("parameters")) {
    outcome.parameters.push_back({.source = "goal",
                                  .name = one.at("name"),
                                  .value = number_of(one.at("value")),
                                  .unit = one.at("unit"),
                                  .at_bound = one.at("at_bound")});
  }
  for (const nlohmann::json& plant : json.at("plants")) {
    const double error = number_of(plant.at("after").at("error"));
    if (!(error <= outcome.improved_rms)) {
      outcome.improved_rms = error;
      outcome.nominal_rms = plant.at("before").is_null() ? not_a_number : number_of(plant["before"].at("error"));
    }
  }
  outcome.unit_of_gap = "1";
  return outcome;
}

}  // namespace

std::string effects_text(const Outcome& outcome) {
  std::string text;
  for (const FoundEffect& effect : outcome.effects) {
    text += effect.named ? fmt::format("{}{} at {}", text.empty() ? "" : " + ", effect.effect, effect.edge) : "";
  }
  return text;
}

Outcome read_outcome(Command command, const std::filesystem::path& folder) {
  const auto json = nlohmann::json::parse(read_text_file((folder / product_of(command)).string()));
  switch (command) {
    case Command::Diagnose:
      return diagnosis_of(json);
    case Command::Tune:
      return json.contains("plants") ? loop_of(json) : fit_of(json);
    case Command::Check:
      break;
  }
  return {.verdict = "no errors"};
}

}  // namespace hysteron::fleet
