// A diagram that is stepped.
#include "codegen/interpreter/machine.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "bindings/c/diagram.hpp"
#include "codegen/graph/body/whole_inputs.hpp"
#include "tuning/simulation.hpp"

using hysteron::Machine;

struct hysteron_machine {
  std::variant<Machine<double>, Machine<float>> machine;
  std::vector<std::optional<hysteron::bodies::WholeInput>> whole;  ///< by input, as simulation.hpp asks for them
};

namespace {

/// 0, or 1 + the first input that cannot take its value.
int unfit_input(const hysteron::Graph& graph, const std::vector<std::optional<hysteron::bodies::WholeInput>>& whole,
                const double* inputs) {
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    if (!hysteron::input_fault(graph.inputs[i], whole[i], inputs[i]).empty()) {
      return static_cast<int>(i) + 1;
    }
  }
  return 0;
}

}  // namespace

extern "C" {

hysteron_machine* hysteron_machine_new(const hysteron_diagram* diagram, double sample_time, const char* options,
                                       hysteron_messages** messages) {
  hysteron::bindings::Call call(messages);
  return call([&]() -> hysteron_machine* {
    hysteron::bindings::require(diagram, "The diagram");
    hysteron::bindings::Options given(options);
    const bool float32 = given.flag("float32");
    given.finish();
    auto whole = hysteron::bodies::whole_inputs(diagram->program.graph);
    return float32 ? new hysteron_machine{Machine<float>(diagram->program, sample_time), std::move(whole)}
                   : new hysteron_machine{Machine<double>(diagram->program, sample_time), std::move(whole)};
  });
}

int hysteron_machine_step(hysteron_machine* machine, const double* inputs, double* outputs) {
  if (machine == nullptr) {
    return -1;
  }
  try {
    return std::visit(
        [&](auto& one) {
          const hysteron::Graph& graph = one.program().graph;
          if ((inputs == nullptr && !graph.inputs.empty()) || (outputs == nullptr && !graph.outputs.empty())) {
            return -1;
          }
          if (const int unfit = unfit_input(graph, machine->whole, inputs); unfit != 0) {
            return unfit;
          }
          for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
            const auto& whole = machine->whole[i];
            one.set_input(i, whole ? hysteron::bodies::carried(*whole, inputs[i]) : inputs[i]);
          }
          one.step();
          for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
            outputs[i] = one.output(i);
          }
          return 0;
        },
        machine->machine);
  } catch (...) {
    return -1;  // no memory for the text of a fault
  }
}

void hysteron_machine_reset(hysteron_machine* machine) {
  if (machine != nullptr) {
    std::visit([](auto& one) { one.reset(); }, machine->machine);
  }
}

void hysteron_machine_free(hysteron_machine* machine) {
  delete machine;
}

}  // extern "C"
