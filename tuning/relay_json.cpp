#include "tuning/relay_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "codegen/parameters/parameter_file.hpp"
#include "codegen/parameters/parameter_names.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

nlohmann::json controller_json(const ControllerStart& start) {
  return {{"KP", start.gain}, {"TR", start.reset_time}, {"TD", start.rate_time}};
}

}  // namespace

nlohmann::json relay_json(const RelayExperiment& relay) {
  nlohmann::json json = {{"low", relay.low},
                         {"high", relay.high},
                         {"cycles", relay.cycles},
                         {"period", relay.period},
                         {"spread", relay.spread},
                         {"amplitude", relay.amplitude},
                         {"hysteresis", relay.hysteresis},
                         {"duty", relay.duty},
                         {"gain", relay.gain},
                         {"phase_deg", relay.phase},
                         {"direction", relay.direction},
                         {"ultimate_gain", relay.ultimate_gain},
                         {"ultimate_period", relay.ultimate_period},
                         {"model", nullptr},
                         {"why_no_model", relay.why_no_model},
                         {"pi", controller_json(relay.pi())},
                         {"pid", controller_json(relay.pid())}};
  if (relay.model) {
    json["model"] = {{"K", relay.model->gain}, {"T", relay.model->time}, {"dead_time", relay.model->dead_time}};
  }
  return json;
}

std::string relay_parameters(const RelayExperiment& relay, const std::string& controller, const std::string& file) {
  if (!parameters::is_path(controller)) {
    throw InputError(error::bad_usage, {}, fmt::format("The controller {} is no name of an instance.", controller),
                     "write the name that it has in the diagram, as PID.");
  }
  parameters::ParameterFile result;
  const ControllerStart start = relay.pid();
  const auto add = [&](const char* name, double value) {
    const std::string path = controller + "." + name;
    result.values.push_back({.path = path, .value = value});
    const double low = value < 0.0 ? 10.0 * value : 0.02 * value;
    const double high = value < 0.0 ? 0.02 * value : 10.0 * value;
    result.fits.push_back({.path = path,
                           .minimum = parameters::PlacedNumber{.value = low},
                           .maximum = parameters::PlacedNumber{.value = high}});
  };
  add("KP", start.gain);
  add("TR", start.reset_time);
  add("TD", start.rate_time);
  const std::string unit = relay.controller_unit();
  parameters::Remarks remarks;
  remarks[in_capitals("parameters." + controller + ".KP")].unit = unit;
  return parameters::parameter_text(
      result, remarks,
      fmt::format("From the relay experiment {}: Ku = {:.4g}{}{}, Tu = {:.4g} s.", file, relay.ultimate_gain,
                  unit.empty() ? "" : " ", unit, relay.ultimate_period));
}

}  // namespace hysteron
