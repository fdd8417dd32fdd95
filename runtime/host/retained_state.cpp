#include "runtime/host/retained_state.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <system_error>
#include <utility>
#include <vector>

#include "runtime/task/staged_parameters.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::size_t most_names = 3;

[[noreturn]] void refuse_folder(const RetainConfig& config, const std::system_error& problem) {
  const std::string of_machine = mend_of_machine(problem.code().value());
  const bool is_of_rights = problem.code() == std::errc::permission_denied;
  throw InputError(error::unusable_retain_folder, config.place,
                   fmt::format("Values cannot be retained in {}: {}.", config.folder, problem.what()),
                   !of_machine.empty() ? of_machine + ", or name another folder."
                   : is_of_rights      ? "give this user the right to read and write it, or name another folder."
                                       : "remove what is in its way, or name another folder; one that is missing is "
                                         "made.");
}

std::string mend_of(const Recovery& recovery, const RetainConfig& config) {
  const std::string cold = "write mismatch = \"cold\", which puts the files aside";
  switch (recovery.refusal) {
    case RetainRefusal::damaged:
      return fmt::format("put copies of retain_a and retain_b back into {}, or {}; and see to the disk.", config.folder,
                         cold);
    case RetainRefusal::not_finite:
      return fmt::format("save the parameters by `hysteron retained {} --out P.toml`, and {}.", config.folder, cold);
    case RetainRefusal::unfit:
      return fmt::format("give others by `hysteron retained {} --set P.toml`, or {}.", config.folder, cold);
    case RetainRefusal::of_another:
    case RetainRefusal::none:
      break;
  }
  return fmt::format("run the diagram that they are of, name another folder, or {}.", cold);
}

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < most_names; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return text + (names.size() > most_names ? fmt::format(" and {} more", names.size() - most_names) : "");
}

}  // namespace

RetainedState::RetainedState(const RetainConfig& config, StepProgram& program, std::vector<std::size_t> inputs)
    : config_(config),
      folder_(config.folder),
      inputs_(std::move(inputs)),
      starts_(program.shape().inputs.size()),
      after_reset_(state_of(program)) {
  const std::vector<double> given = parameters_of(program);
  try {
    folder_.open();
    recovery_ = recover(
        folder_, program.shape().layout, config.mismatch,
        {.refusal = [&](const RetainedValues& values) { return refusal_of(program.shape(), values.parameters, given); },
         .not_finite =
             [&](const RetainedValues& values) {
               return values.state.size() == after_reset_.size()
                          ? not_finite(program.shape(), values.state, after_reset_)
                          : std::string();
             },
         .other_unit =
             [&](const RetainedValues& values) {
               return other_unit(read_description(values.described, values.state.size()), program.shape(), inputs_);
             }});
  } catch (const std::system_error& problem) {
    if (problem.code() == std::errc::resource_unavailable_try_again) {
      throw InputError(error::file_of_another_task, config.place,
                       fmt::format("Another task that runs retains its values in {}.", config.folder),
                       "end that task first, or name another folder.");
    }
    refuse_folder(config, problem);
  }
  if (!recovery_.refused.empty()) {
    throw InputError(error::retained_values_unfit, config.place, recovery_.refused, mend_of(recovery_, config));
  }
  if (recovery_.values) {
    const RetainedValues& values = *recovery_.values;
    const KeptLayout kept = read_description(values.described, values.state.size());
    if (recovery_.by_name) {
      carry(program, given, kept);
    } else {
      take(program, given);
    }
    starts_ = carry_inputs(kept, values.inputs, program.shape(), inputs_, left_);
  }
  told_ += recovery_.note.empty() ? "" : ", " + recovery_.note;
}

void RetainedState::take(StepProgram& program, std::span<const double> given) {
  set_parameters(program, recovery_.values->parameters);
  program.restore(recovery_.values->state);
  told_ = fmt::format(", from retained state {}", recovery_.sequence) + not_as_given(program, given);
}

std::string RetainedState::not_as_given(const StepProgram& program, std::span<const double> given) const {
  std::vector<std::string> others;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!is_same_value(program.parameter(i), given[i])) {
      others.push_back(program.shape().parameters[i].name);
    }
  }
  return others.empty() ? ""
                        : fmt::format(
                              " with {} parameter{} as retained and not as given: {} (an empty {} gives those "
                              "given)",
                              others.size(), others.size() == 1 ? "" : "s", names_text(others), config_.folder);
}

void RetainedState::carry(StepProgram& program, std::span<const double> given, const KeptLayout& kept) {
  const RetainedValues& values = *recovery_.values;
  const ProgramShape& shape = program.shape();
  CarriedValues carried = kept.parameters.size() == values.parameters.size()
                              ? carry_parameters(kept, values.parameters, shape, given)
                              : CarriedValues{.parameters = {given.begin(), given.end()}};
  if (const std::string refused = refusal_of(shape, carried.parameters, given); !refused.empty()) {
    throw InputError(error::retained_values_unfit, config_.place,
                     "The retained parameters cannot be beside those of the diagram: " + refused,
                     fmt::format("give others by `hysteron retained {} --set P.toml`, or write mismatch = \"cold\", "
                                 "which puts the files aside.",
                                 config_.folder));
  }
  set_parameters(program, carried.parameters);
  program.reset();  // what starts at a parameter starts at the carried one
  after_reset_ = state_of(program);
  std::vector<std::byte> state = after_reset_;
  carry_state(kept, values.state, shape, state, carried);
  program.restore(state);
  left_ = std::move(carried.left);
  told_ = fmt::format(", from retained state {}", recovery_.sequence);
  if (!left_.empty()) {
    told_ += fmt::format(" of another version: {} of {} parameters and {} of {} states carried over by name",
                         carried.parameters_taken, shape.parameters.size(), carried.states_taken, shape.state.size());
  }
  told_ += not_as_given(program, given);
}

std::string RetainedState::loss() const {
  return recovery_.loss.empty() ? "" : fmt::format("{}: {}", config_.folder, recovery_.loss);
}

void RetainedState::put_aside() {
  runtime::put_aside(folder_, recovery_);
}

}  // namespace hysteron::runtime
