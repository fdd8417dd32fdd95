#include "tool/serve_program.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/cpp/cpp_step.hpp"
#include "codegen/backends/shared/routine.hpp"
#include "codegen/interpreter/machine.hpp"
#include "runtime/task/linked_program.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/build_cache.hpp"
#include "tool/built_program.hpp"
#include "tool/row_program.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;
using runtime::ProgramShape;
using runtime::ProgramSignal;

template <class S>
class InterpretedProgram final : public runtime::StepProgram {
 public:
  InterpretedProgram(const Program& program, ProgramShape shape, const std::vector<InnerSignal>& inner)
      : shape_(std::move(shape)), machine_(program) {
    for (const InnerSignal& signal : inner) {
      inner_.push_back(signal.wire);
    }
    const auto& parameters = program.graph.parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      for (std::size_t element = 0; element < parameters[i].value.size(); ++element) {
        places_.emplace_back(i, element);
      }
    }
    place_state(program);
  }
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override { machine_.reset(); }
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      machine_.set_input(i, inputs[i]);
    }
    machine_.step();
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      outputs[i] = machine_.output(i);
    }
  }
  void inner_values(std::span<double> into) const noexcept override {
    for (std::size_t i = 0; i < into.size(); ++i) {
      into[i] = machine_.value(inner_[i]);
    }
  }
  void set_parameter(std::size_t parameter, double value) noexcept override {
    machine_.set_parameter(places_[parameter].first, value, places_[parameter].second);
  }
  [[nodiscard]] double parameter(std::size_t parameter) const noexcept override {
    return machine_.parameter(places_[parameter].first, places_[parameter].second);
  }
  [[nodiscard]] std::size_t state_size() const noexcept override { return machine_.saved_size(); }
  void save(std::span<std::byte> bytes) const noexcept override { machine_.save(bytes); }
  void restore(std::span<const std::byte> bytes) noexcept override { machine_.restore(bytes); }

 private:
  void place_state(const Program& program) {
    const Routine routine = make_routine(program);
    for (std::size_t i = 0; i < routine.cells.size(); ++i) {
      const CellInfo& cell = routine.cells[i];
      runtime::StateField& field = shape_.state[i];
      if (cell.instance.empty()) {
        field.type = runtime::PointType::uint64;
        field.offset = machine_.place_of_steps();
        continue;
      }
      field.offset = cell.held ? machine_.place_of_output(cell.node, static_cast<std::uint16_t>(cell.place))
                               : machine_.place_of_state(cell.node, cell.place);
    }
  }

  ProgramShape shape_;
  Machine<S> machine_;
  std::vector<std::pair<std::size_t, std::size_t>> places_;  ///< parameter and element
  std::vector<Wire> inner_;
};

template <class Function>
Function function_of(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

std::unique_ptr<runtime::StepProgram> compiled_program(const Program& program, ProgramShape shape, bool float32) {
  BuildCache cache;
  const auto path = built_program(cache, {.main = generate_cpp_step(program).text,
                                          .headers = {generate_cpp_header(program, {.float32 = float32})},
                                          .flags = {"-std=c++20", "-O2", "-shared", "-fPIC"},
                                          .without = "run it with --engine interpreter"});
  // Each program has a state of its own: the same file opened twice would be one library, with one state.
  const TemporaryFolder folder(cache.folder());
  const fs::path copy = folder.path() / path.filename();
  write_scratch(copy, read_text_file(path.string()));
  const std::shared_ptr<void> opened(dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL), [](void* library) {
    if (library != nullptr) {
      (void)dlclose(library);
    }
  });
  void* const library = opened.get();
  if (library == nullptr) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The compiled program cannot be opened: {}.", dlerror()),
                     "see whether programs may be run from the folder for temporary files; TMPDIR sets another.");
  }
  return std::make_unique<runtime::LinkedProgram>(
      std::move(shape),
      runtime::StepFunctions{
          .reset = function_of<void (*)()>(library, "hysteron_reset"),
          .step = function_of<void (*)(const double*, double*)>(library, "hysteron_step"),
          .set_parameter = function_of<void (*)(std::size_t, double)>(library, "hysteron_set_parameter"),
          .parameter = function_of<double (*)(std::size_t)>(library, "hysteron_parameter"),
          .state = function_of<void* (*)()>(library, "hysteron_state"),
          .state_size = function_of<std::size_t (*)()>(library, "hysteron_state_size"),
          .state_offset = function_of<std::size_t (*)(std::size_t)>(library, "hysteron_state_offset")},
      opened);
}

}  // namespace

Program with_inner_outputs(Program program, const std::vector<InnerSignal>& inner) {
  for (std::size_t i = 0; i < inner.size(); ++i) {
    program.graph.outputs.push_back(
        {.name = fmt::format("inner__{}", i), .type = inner[i].type, .wire = inner[i].wire});
  }
  return program;
}

std::vector<ProgramSignal> inner_of_shape(const std::vector<InnerSignal>& inner) {
  std::vector<ProgramSignal> signals;
  for (const InnerSignal& signal : inner) {
    signals.push_back({.name = signal.name, .unit = signal.unit, .type = point_type(signal.type)});
  }
  return signals;
}

std::unique_ptr<runtime::StepProgram> step_program(const Program& program, Engine engine, bool float32,
                                                   const std::vector<InnerSignal>& inner, const std::string& picture) {
  auto shape = shape_of(program, engine, float32);
  shape.picture = picture;
  shape.inner = inner_of_shape(inner);
  if (engine == Engine::compiled) {
    return compiled_program(with_inner_outputs(program, inner), std::move(shape), float32);
  }
  if (float32) {
    return std::make_unique<InterpretedProgram<float>>(program, std::move(shape), inner);
  }
  return std::make_unique<InterpretedProgram<double>>(program, std::move(shape), inner);
}

Engine best_engine() {
  return has_compiler() ? Engine::compiled : Engine::interpreter;
}

}  // namespace hysteron::tool
