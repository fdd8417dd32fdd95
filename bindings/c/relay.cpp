// A relay experiment behind its handle.
#include <nlohmann/json.hpp>

#include "bindings/c/options.hpp"
#include "bindings/c/record.hpp"
#include "tuning/relay_experiment.hpp"
#include "tuning/relay_json.hpp"

struct hysteron_relay {
  std::string json;
  std::string parameters;
};

extern "C" {

hysteron_relay* hysteron_relay_experiment(const hysteron_record* record, const char* u, const char* y,
                                          const char* options, hysteron_messages** messages) {
  hysteron::bindings::Call call(messages);
  return call([&]() -> hysteron_relay* {
    hysteron::bindings::require(record, "The record");
    hysteron::bindings::require(u, "The name of the relay's column");
    hysteron::bindings::require(y, "The name of the process value's column");
    hysteron::bindings::Options given(options);
    const std::string controller = given.text("controller");
    given.finish();
    const hysteron::RelayExperiment found = hysteron::relay_experiment(record->record, u, y);
    auto result = std::make_unique<hysteron_relay>();
    result->json = hysteron::relay_json(found).dump(2) + "\n";
    result->parameters =
        hysteron::relay_parameters(found, controller.empty() ? "PID" : controller, record->record.file());
    return result.release();
  });
}

const char* hysteron_relay_json(const hysteron_relay* relay) {
  return relay != nullptr ? relay->json.c_str() : nullptr;
}

const char* hysteron_relay_parameters(const hysteron_relay* relay) {
  return relay != nullptr ? relay->parameters.c_str() : nullptr;
}

void hysteron_relay_free(hysteron_relay* relay) {
  delete relay;
}

}  // extern "C"
