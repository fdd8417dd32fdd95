#include "tool/serve_program.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/cpp/cpp_step.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/graph/relations.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/program_hash.hpp"
#include "runtime/task/linked_program.hpp"
#include "support/errors.hpp"
#include "support/sha256.hpp"
#include "support/text_file.hpp"
#include "tool/build_cache.hpp"
#include "tool/compiled.hpp"
#include "tool/process.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;
using runtime::PointType;
using runtime::ProgramShape;
using runtime::ProgramSignal;

PointType point_type(Type type) {
  switch (type) {
    case Type::Bool:
      return PointType::boolean;
    case Type::Int:
      return PointType::int32;
    case Type::Word:
      return PointType::uint16;
    default:
      return PointType::real64;
  }
}

ProgramSignal signal_of(const Port& port) {
  return {.name = port.name,
          .unit = port.unit,
          .meaning = port.meaning,
          .type = point_type(port.type),
          .preset = port.preset,
          .low = port.minimum,
          .high = port.maximum};
}

/// With elements of arrays counted one by one, as the parameters of a shape are.
std::vector<runtime::ProgramRelation> relations_of(const Graph& graph) {
  std::vector<std::size_t> first;
  std::size_t count = 0;
  for (const Parameter& parameter : graph.parameters) {
    first.push_back(count);
    count += parameter.value.size();
  }
  const auto number_of = [&](const RisingNumbers::Number& one) {
    return one.parameter ? runtime::RelatedNumber{.parameter = first[*one.parameter] + one.element}
                         : runtime::RelatedNumber{.constant = one.constant};
  };
  std::vector<runtime::ProgramRelation> relations;
  for (const RisingNumbers& rising : rising_numbers(graph)) {
    runtime::ProgramRelation relation{.strictly = rising.strictly};
    std::ranges::transform(rising.numbers, std::back_inserter(relation.numbers), number_of);
    if (rising.count) {
      relation.count = number_of(*rising.count);
    }
    relations.push_back(std::move(relation));
  }
  return relations;
}

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
  ProgramShape shape_;
  Machine<S> machine_;
  std::vector<std::pair<std::size_t, std::size_t>> places_;  ///< parameter and element
  std::vector<Wire> inner_;
};

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
}

void build_library(const Program& program, bool float32, const std::vector<std::string>& compiler,
                   const fs::path& path) {
  const GeneratedFile header = generate_cpp_header(program, {.float32 = float32});
  const GeneratedFile step = generate_cpp_step(program);
  const fs::path folder = path.parent_path();
  write_text(folder / header.name, header.text);
  write_text(folder / step.name, step.text);
  auto command = compiler;
  std::istringstream words("-std=c++20 -O2 -shared -fPIC " + std::string(cpp_numeric_flags));
  for (std::string word; words >> word;) {
    command.push_back(word);
  }
  command.insert(command.end(), {(folder / step.name).string(), "-o", path.string(), "-lm"});
  const fs::path errors = folder / "errors";
  if (const int code = run_program(command, {.errors = errors}); code != 0) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The compiler {} refuses the generated code (exit code {}):\n{}", compiler.front(),
                                 code, read_text_file(errors.string()).substr(0, 1000)),
                     "set CXX to a compiler for C++20, or run it with --engine interpreter.");
  }
}

template <class Function>
Function function_of(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

std::unique_ptr<runtime::StepProgram> compiled_program(const Program& program, ProgramShape shape, bool float32) {
  const auto compiler = compiler_command();
  BuildCache cache;
  const auto text = generate_cpp_header(program, {.float32 = float32}).text + generate_cpp_step(program).text;
  const auto path = cache.find_or_build(sha256("library " + compiler.front() + text),
                                        [&](const fs::path& to) { build_library(program, float32, compiler, to); });
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The compiled program cannot be opened: {}.", dlerror()),
                     "see whether programs may be run from the folder for temporary files; TMPDIR sets another.");
  }
  // Never closed: it runs for as long as this process does.
  return std::make_unique<runtime::LinkedProgram>(
      std::move(shape),
      runtime::StepFunctions{
          .reset = function_of<void (*)()>(library, "hysteron_reset"),
          .step = function_of<void (*)(const double*, double*)>(library, "hysteron_step"),
          .set_parameter = function_of<void (*)(std::size_t, double)>(library, "hysteron_set_parameter"),
          .parameter = function_of<double (*)(std::size_t)>(library, "hysteron_parameter"),
          .state = function_of<void* (*)()>(library, "hysteron_state"),
          .state_size = function_of<std::size_t (*)()>(library, "hysteron_state_size")});
}

/// The program with its inner signals as further outputs, by names that no diagram can have.
Program with_outputs(Program program, const std::vector<InnerSignal>& inner) {
  for (std::size_t i = 0; i < inner.size(); ++i) {
    program.graph.outputs.push_back(
        {.name = fmt::format("inner__{}", i), .type = inner[i].type, .wire = inner[i].wire});
  }
  return program;
}

}  // namespace

ProgramShape shape_of(const Program& program, Engine engine, bool float32) {
  const Graph& graph = program.graph;
  require_generable(graph);
  ProgramShape shape{.name = graph.name, .period = graph.sample_time_ns};
  for (const Port& port : graph.inputs) {
    shape.inputs.push_back(signal_of(port));
  }
  for (const Port& port : graph.outputs) {
    shape.outputs.push_back(signal_of(port));
  }
  const auto units = units::Solution(graph, program.schedule).parameters();
  std::size_t index = 0;
  Program plain = program;
  for (Parameter& parameter : plain.graph.parameters) {
    for (std::size_t element = 0; element < parameter.value.size(); ++element) {
      shape.parameters.push_back(
          {.name = parameter.field.length > 1 ? fmt::format("{}[{}]", parameter.path, element) : parameter.path,
           .unit = units[index],
           .meaning = std::string(parameter.field.meaning),
           .type = point_type(parameter.field.type),
           .preset = parameter.value[element],
           .low = parameter.field.minimum,
           .high = parameter.field.maximum,
           .low_excluded = parameter.field.above_minimum});
    }
    ++index;
    std::ranges::fill(parameter.value, 0.0);  // the values do not belong to the layout
  }
  shape.relations = relations_of(graph);
  shape.layout = fmt::format("{}-{}{}", program_hash(plain), engine == Engine::compiled ? "compiled" : "interpreter",
                             float32 ? "-float32" : "");
  return shape;
}

std::unique_ptr<runtime::StepProgram> step_program(const Program& program, Engine engine, bool float32,
                                                   const std::vector<InnerSignal>& inner) {
  auto shape = shape_of(program, engine, float32);
  for (const InnerSignal& signal : inner) {
    shape.inner.push_back({.name = signal.name, .unit = signal.unit, .type = point_type(signal.type)});
  }
  if (engine == Engine::compiled) {
    return compiled_program(with_outputs(program, inner), std::move(shape), float32);
  }
  if (float32) {
    return std::make_unique<InterpretedProgram<float>>(program, std::move(shape), inner);
  }
  return std::make_unique<InterpretedProgram<double>>(program, std::move(shape), inner);
}

Engine best_engine() {
  try {
    (void)compiler_command();
    return Engine::compiled;
  } catch (const InputError&) {
    return Engine::interpreter;
  }
}

}  // namespace hysteron::tool
