#include "tool/compiled.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <utility>

#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/cpp/cpp_host.hpp"
#include "support/errors.hpp"
#include "support/sha256.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/build_cache.hpp"
#include "tool/compiler.hpp"
#include "tool/process.hpp"
#include "tool/row_program.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

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
#include <vector>

)";
constexpr std::string_view host_tail = R"(
int main(int count, char** arguments) {
  const int program = count > 1 ? std::atoi(arguments[1]) : -1;
  const std::size_t steps = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 0;
  switch (program) {
)";

std::string as_member(Type type, std::string_view member, std::size_t column) {
  return type == Type::Bool ? fmt::format("    in.{} = row[{}] != 0.0;\n", member, column)
                            : fmt::format("    in.{0} = static_cast<decltype(in.{0})>(row[{1}]);\n", member, column);
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

struct GeneratedSources {
  std::string host;
  std::vector<GeneratedFile> headers;
};

GeneratedSources sources_of(const std::vector<GeneratedProgram>& programs) {
  GeneratedSources sources{.host = std::string(host_head), .headers = {}};
  std::string runners;
  std::string cases;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    // Diagrams of the same name, with other parameters, have to stand side by side.
    Program renamed = *programs[i].program;
    renamed.graph.name = fmt::format("program_{}", i);
    sources.headers.push_back(generate_cpp_header(renamed, {.float32 = programs[i].float32}));
    sources.host += fmt::format("#include \"{}\"\n", sources.headers.back().name);
    runners += "\n" + runner(renamed.graph.name, renamed.graph);
    cases += fmt::format("    case {}:\n      return run_program_{}(steps);\n", i, i);
  }
  sources.host += "\nnamespace {\n" + runners + "\n}  // namespace\n" + std::string(host_tail) + cases +
                  "    default:\n      return 2;\n  }\n}\n";
  return sources;
}

std::string version_of(const std::vector<std::string>& compiler, const fs::path& folder) {
  auto command = compiler;
  command.emplace_back("--version");
  const auto output = folder / "version";
  return run_program(command, {.output = output}) == 0 ? read_text_file(output.string()) : std::string();
}

void compile_sources(const GeneratedSources& sources, std::vector<std::string> command, const fs::path& executable) {
  const auto folder = executable.parent_path();
  for (const GeneratedFile& header : sources.headers) {
    write_scratch(folder / header.name, header.text);
  }
  write_scratch(folder / "main.cpp", sources.host);
  command.insert(command.end(), flags.begin(), flags.end());
  for (const std::string& flag : words_of(cpp_numeric_flags)) {
    command.push_back(flag);
  }
  command.insert(command.end(), {(folder / "main.cpp").string(), "-o", executable.string(), "-lm"});
  const auto errors = folder / "errors";
  if (const int code = run_program(command, {.errors = errors}); code != 0) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The compiler {} refuses the generated code (exit code {}):{}", command.front(), code,
                                 first_lines(errors)),
                     "set CXX to a compiler for C++20, or leave generated code out with --no-generated.");
  }
}

}  // namespace

std::vector<std::string> compiler_command() {
  if (auto command = find_compiler("CXX", {"c++", "g++", "clang++"})) {
    return *command;
  }
  if (const char* const set = std::getenv("CXX"); set != nullptr && *set != '\0') {
    throw InputError(error::no_compiler, {}, fmt::format("CXX is \"{}\", which cannot be run.", set),
                     "set CXX to a C++ compiler, or unset it.");
  }
  throw InputError(error::no_compiler, {}, "There is no C++ compiler (c++, g++ or clang++) on the path.",
                   "install one (Debian: apt install g++), set CXX, or leave generated code out with --no-generated.");
}

CompiledPrograms::CompiledPrograms(const std::vector<GeneratedProgram>& programs) {
  const auto compiler = compiler_command();
  const GeneratedSources sources = sources_of(programs);
  for (const GeneratedProgram& one : programs) {
    shapes_.push_back({.name = one.program->graph.name,
                       .inputs = one.program->graph.inputs.size(),
                       .outputs = one.program->graph.outputs.size()});
  }
  BuildCache cache;
  scratch_ = cache.folder();
  std::string everything = sources.host;
  for (const GeneratedFile& header : sources.headers) {
    everything += header.text;
  }
  for (const std::string& word : compiler) {
    everything += word + " ";
  }
  for (const char* const flag : flags) {
    everything += flag;
  }
  everything += cpp_numeric_flags;
  {
    const TemporaryFolder folder(scratch_);
    everything += version_of(compiler, folder.path());
  }
  executable_ =
      cache.find_or_build(sha256(everything), [&](const fs::path& path) { compile_sources(sources, compiler, path); });
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
