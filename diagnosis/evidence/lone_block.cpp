#include "diagnosis/evidence/lone_block.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {

RecordSignals combined(const RecordSignals& a, double share_a, const RecordSignals& b, double share_b) {
  RecordSignals result = a;
  for (std::size_t e = 0; e < a.size(); ++e) {
    for (std::size_t k = 0; k < a[e].size(); ++k) {
      result[e][k] = share_a * a[e][k] + share_b * b[e][k];
    }
  }
  return result;
}

LoneBlock::LoneBlock(const EffectKind& kind, const RecordSignals& input, std::vector<const RecordSignals*> drivers,
                     const RecordSignals* unsure, double sample_time)
    : input_(input), drivers_(std::move(drivers)), unsure_(unsure) {
  std::string pins = fmt::format("{} : LREAL; ", kind.input);
  std::string call = fmt::format("{} := {}", kind.input, kind.input);
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    pins += fmt::format("{} : LREAL; ", kind.auxiliaries[i]);
    call += fmt::format(", {} := {}", kind.auxiliaries[i], kind.auxiliaries[i]);
  }
  program_ = compile_text(fmt::format("FUNCTION_BLOCK LAW VAR_INPUT {}END_VAR VAR_OUTPUT RESULT : LREAL; END_VAR VAR "
                                      "E : {}; END_VAR E({}); RESULT := E.{}; END_FUNCTION_BLOCK",
                                      pins, kind.block, call, kind.output),
                          {.any_order = true});
  machine_ = std::make_unique<Machine<double>>(program_, sample_time);
}

void LoneBlock::set(std::string_view parameter, double value) {
  const std::int64_t at = find_parameter(program_.graph, fmt::format("E.{}", parameter));
  if (at >= 0) {
    machine_->set_parameter(static_cast<std::size_t>(at), value);
  }
}

LoneBlock::Added LoneBlock::added() {
  if (unsure_ == nullptr) {
    return {.middle = added_at(0.0)};
  }
  const RecordSignals low = added_at(-policy::unsure_speed.value);
  const RecordSignals high = added_at(policy::unsure_speed.value);
  if (low.empty() || high.empty()) {
    return {};
  }
  return {.middle = combined(low, 0.5, high, 0.5), .slack = combined(high, 0.5, low, -0.5)};
}

RecordSignals LoneBlock::added_at(double deviations) {
  RecordSignals result;
  for (std::size_t e = 0; e < input_.size(); ++e) {
    machine_->reset();
    result.emplace_back(input_[e].size());
    for (std::size_t k = 0; k < input_[e].size(); ++k) {
      machine_->set_input(0, input_[e][k]);
      for (std::size_t i = 0; i < drivers_.size(); ++i) {
        const double off = i == 0 && unsure_ != nullptr ? deviations * (*unsure_)[e][k] : 0.0;
        machine_->set_input(i + 1, (*drivers_[i])[e][k] + off);
      }
      machine_->step();
      result.back()[k] = machine_->output(0) - input_[e][k];
      if (!std::isfinite(result.back()[k])) {
        return {};
      }
    }
  }
  return result;
}

}  // namespace hysteron::diagnosis
