#include "tool/compiled.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/cpp/cpp_host.hpp"
#include "tool/build_cache.hpp"
#include "tool/built_program.hpp"
#include "tool/row_program.hpp"

namespace hysteron::tool {
namespace {

/// Optimised a little: it is compiled in half the time, and bits do not depend on it.
constexpr std::array flags{"-std=c++20", "-O1"};

/// A program that reads rows of inputs as doubles and writes rows of outputs as doubles: no digit is lost.
constexpr std::string_view host_head = R"(#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <vector>

)";
constexpr std::string_view host_tail = R"(
int main(int count, char** arguments) {
  const int program = count > 1 ? std::atoi(arguments[1]) : -1;
  const std::size_t steps = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 0;
  switch (program) {
)";

std::string as_member(Type type, std::string_view member, std::size_t column) {
  return type == Type::Bool
             ? fmt::format("    in.{} = row[{}] != 0.0;\n", member, column)
             : fmt::format("    in.{0} = static_cast<std::decay_t<decltype(in.{0})>>(row[{1}]);\n", member, column);
}

/// The function that runs one program over all its rows.
std::string runner(const std::string& name, const Graph& graph) {
  const auto inputs = port_members(graph.inputs);
  const auto outputs = port_members(graph.outputs);
  std::string text = fmt::format(
      "int run_{0}(std::size_t steps) {{\n"
      "  {0}::Params params;\n  {0}::State state;\n  {0}::In in;\n  {0}::reset(params, state);\n"
      "  std::vector<double> row({1});\n  std::vector<double> results({2});\n"
      "  for (std::size_t k = 0; k < steps; ++k) {{\n"
      "    if (std::fread(row.data(), sizeof(double), row.size(), stdin) != row.size()) {{\n      return 3;\n    }}\n",
      name, inputs.size(), outputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    text += as_member(graph.inputs[i].type, inputs[i], i);
  }
  text += fmt::format("    {}const auto out = {}::step(params, state, in);\n",
                      outputs.empty() ? "[[maybe_unused]] " : "", name);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    text += fmt::format("    results[{}] = static_cast<double>(out.{});\n", i, outputs[i]);
  }
  return text +
         "    if (std::fwrite(results.data(), sizeof(double), results.size(), stdout) != results.size()) {\n"
         "      return 4;\n    }\n  }\n  return std::fflush(stdout) == 0 ? 0 : 4;\n}\n";
}

ProgramSources sources_of(const std::vector<GeneratedProgram>& programs) {
  ProgramSources sources{.main = std::string(host_head), .flags = {flags.begin(), flags.end()}};
  std::string runners;
  std::string cases;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    // Diagrams of the same name, with other parameters, have to stand side by side.
    Program renamed = *programs[i].program;
    renamed.graph.name = fmt::format("program_{}", i);
    sources.headers.push_back(generate_cpp_header(renamed, {.float32 = programs[i].float32}));
    sources.main += fmt::format("#include \"{}\"\n", sources.headers.back().name);
    runners += "\n" + runner(renamed.graph.name, renamed.graph);
    cases += fmt::format("    case {}:\n      return run_program_{}(steps);\n", i, i);
  }
  sources.main += "\nnamespace {\n" + runners + "\n}  // namespace\n" + std::string(host_tail) + cases +
                  "    default:\n      return 2;\n  }\n}\n";
  return sources;
}

}  // namespace

CompiledPrograms::CompiledPrograms(const std::vector<GeneratedProgram>& programs) {
  const ProgramSources sources = sources_of(programs);
  for (const GeneratedProgram& one : programs) {
    shapes_.push_back({.name = one.program->graph.name,
                       .inputs = one.program->graph.inputs.size(),
                       .outputs = one.program->graph.outputs.size()});
  }
  BuildCache cache;
  scratch_ = cache.folder();
  executable_ = built_program(cache, sources);
}

std::vector<Signal> CompiledPrograms::run(std::size_t program, const Drive& drive) const {
  const Shape& shape = shapes_[program];
  return run_rows({.command = {executable_.string(), std::to_string(program), std::to_string(drive.steps)},
                   .name = shape.name,
                   .outputs = shape.outputs,
                   .scratch = scratch_},
                  drive);
}

std::size_t first_difference(const Signal& a, const Signal& b) {
  for (std::size_t k = 0; k < a.size() && k < b.size(); ++k) {
    const bool same = std::bit_cast<std::uint64_t>(a[k]) == std::bit_cast<std::uint64_t>(b[k]);
    if (!same && !(std::isnan(a[k]) && std::isnan(b[k]))) {
      return k;
    }
  }
  return a.size() == b.size() ? same_bits : std::min(a.size(), b.size());
}

}  // namespace hysteron::tool
