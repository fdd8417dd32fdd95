#include "tool/target_proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <random>
#include <sstream>
#include <string_view>
#include <utility>

#include "codegen/backends/batch/batch.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/fmu/fmu.hpp"
#include "codegen/backends/fmu/model_description.hpp"
#include "codegen/backends/fmu/variables.hpp"
#include "codegen/import/plcopen_import.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/single.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/batch_program.hpp"
#include "tool/built_program.hpp"
#include "tool/compiled.hpp"
#include "tool/compiler.hpp"
#include "tool/process.hpp"
#include "tool/row_program.hpp"
#include "tuning/float32_run.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t steps = 2000;

double random_value(const Port& port, std::mt19937_64& random) {
  const bool bounded = std::isfinite(port.minimum) && std::isfinite(port.maximum);
  switch (port.type) {
    case Type::Bool:
      return static_cast<double>(random() % 2);
    case Type::Word:
      return static_cast<double>(random() % 65536);
    case Type::Int: {
      const double low = std::max(port.minimum, -1000.0);
      const double high = std::min(port.maximum, 1000.0);
      return std::floor(std::uniform_real_distribution<double>(low, high + 1.0)(random));
    }
    default:
      return bounded ? std::uniform_real_distribution<double>(port.minimum, port.maximum)(random)
                     : std::clamp(std::normal_distribution<double>()(random), port.minimum, port.maximum);
  }
}

/// A value stands for some steps, as commands do: else no branch point and no timer would ever be passed.
Drive random_drive(const Program& program, bool float32) {
  std::mt19937_64 random(1);
  Drive drive{.steps = steps, .sample_time = program.graph.sample_time()};
  for (const Port& port : program.graph.inputs) {
    Signal signal;
    while (signal.size() < steps) {
      double value = random_value(port, random);
      if (float32 && port.type == Type::Real) {
        value = nearest_single(value);
      }
      signal.insert(signal.end(), std::min<std::size_t>(1 + random() % 8, steps - signal.size()), value);
    }
    drive.inputs.push_back(std::move(signal));
  }
  return drive;
}

// ---- in C -----------------------------------------------------------------------------------------------------------

std::string c_type(Type type) {
  switch (type) {
    case Type::Bool:
      return "bool";
    case Type::Int:
      return "int32_t";
    case Type::Word:
      return "uint16_t";
    default:
      return "double";
  }
}

/// Of a cell of a row, what an input takes.
std::string from_row(Type type, std::size_t column) {
  return type == Type::Bool ? fmt::format("row[{}] != 0.0", column) : fmt::format("({})row[{}]", c_type(type), column);
}

constexpr std::string_view main_in_c = R"(
int main(void) {
  static double row[INPUTS + 1];
  static double results[OUTPUTS + 1];
  start();
  for (long k = 0; k < STEPS; ++k) {
    if (fread(row, sizeof(double), INPUTS, stdin) != INPUTS) {
      return 3;
    }
    step(row, results, k);
    if (fwrite(results, sizeof(double), OUTPUTS, stdout) != OUTPUTS) {
      return 4;
    }
  }
  return fflush(stdout) == 0 ? 0 : 4;
}
)";

std::string sizes(const Graph& graph) {
  return fmt::format("#define INPUTS {}u\n#define OUTPUTS {}u\n#define STEPS {}L\n", graph.inputs.size(),
                     graph.outputs.size(), steps);
}

std::string main_of_c(const Graph& graph) {
  const std::string name = namespace_identifier(graph.name);
  const auto inputs = port_members(graph.inputs);
  const auto outputs = port_members(graph.outputs);
  std::string text = fmt::format(
      "#include <stdio.h>\n#include \"{0}.h\"\n{1}"
      "static {0}_params params;\nstatic {0}_state state;\nstatic {0}_in in;\nstatic {0}_out out;\n"
      "static void start(void) {{\n  {0}_defaults(&params, &in);\n  {0}_reset(&state, &params);\n}}\n"
      "static void step(const double *row, double *results, long k) {{\n  (void)row;\n  (void)results;\n  (void)k;\n",
      name, sizes(graph));
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    text += fmt::format("  in.{} = {};\n", inputs[i], from_row(graph.inputs[i].type, i));
  }
  text += fmt::format("  {}_step(&params, &state, &in, &out);\n", name);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    text += fmt::format("  results[{}] = (double)out.{};\n", i, outputs[i]);
  }
  return text + "}\n" + std::string(main_in_c);
}

/// The C type of a value that FMI hands over.
std::string fmi_value_type(Type type, const FmuOptions& options) {
  if (options.version == FmiVersion::Two) {
    return type == Type::Real ? "double" : "int";
  }
  return type == Type::Real && options.float32 ? "float" : c_type(type);
}

std::string main_of_fmu(const Program& program, const FmuContents& contents, const FmuOptions& options) {
  const bool two = options.version == FmiVersion::Two;
  const std::string prefix = two ? "fmi2" : "fmi3";
  const auto source = std::ranges::find_if(contents.sources, [&](const std::string& one) {
    return one.find(two ? "_fmi2.c" : "_fmi3.c") != std::string::npos;
  });
  const std::string instantiate =
      two ? fmt::format("fmi2Instantiate(\"one\", fmi2CoSimulation, FMU_TOKEN, \"\", &callbacks, 0, 0)")
          : std::string(
                "fmi3InstantiateCoSimulation(\"one\", FMU_TOKEN, \"\", false, false, false, false, 0, 0, 0, 0, 0)");
  std::string text = fmt::format(
      "#include <stdio.h>\n#include \"{}\"\n{}"
      "static void *one;\n{}"
      "static void start(void) {{\n  one = {};\n  if (one == 0) exit(5);\n{}}}\n"
      "static void step(const double *row, double *results, long k) {{\n  (void)row;\n  (void)results;\n",
      source == contents.sources.end() ? std::string() : *source, sizes(program.graph),
      two ? "static const fmi2CallbackFunctions callbacks = {0, calloc, free, 0, 0};\n" : "", instantiate,
      two ? "  fmi2SetupExperiment(one, 0, 0.0, 0.0, 0, 0.0);\n  fmi2EnterInitializationMode(one);\n"
            "  fmi2ExitInitializationMode(one);\n"
          : "  fmi3EnterInitializationMode(one, false, 0.0, 0.0, false, 0.0);\n  fmi3ExitInitializationMode(one);\n");
  const auto variables = fmu_variables(program, options);
  std::size_t input = 0;
  std::size_t output = 0;
  std::string gets;
  for (std::size_t v = 0; v < variables.size(); ++v) {
    const FmuVariable& variable = variables[v];
    const std::string type = fmi_value_type(variable.type, options);
    const std::size_t elements = variable.start.size();
    const std::string tail = two ? "" : fmt::format(", {}", elements);
    if (variable.role == FmuVariable::Role::Input) {
      std::string values;
      for (std::size_t k = 0; k < elements; ++k) {
        values += fmt::format("{}({}){}", k == 0 ? "" : ", ", type, from_row(variable.type, input++));
      }
      text += fmt::format(
          "  {{\n    const unsigned int reference = {}u;\n    const {} values[] = {{{}}};\n    "
          "if ({}Set{}(one, &reference, 1, values{}) != 0) exit(6);\n  }}\n",
          v + 1, type, values, prefix, fmi_type_name(variable.type, options), tail);
    } else if (variable.role == FmuVariable::Role::Output) {
      gets += fmt::format(
          "  {{\n    const unsigned int reference = {}u;\n    {} values[{}];\n    "
          "if ({}Get{}(one, &reference, 1, values{}) != 0) exit(7);\n",
          v + 1, type, elements, prefix, fmi_type_name(variable.type, options), tail);
      for (std::size_t k = 0; k < elements; ++k) {
        gets += fmt::format("    results[{}] = (double)values[{}];\n", output++, k);
      }
      gets += "  }\n";
    }
  }
  text += two ? "  if (fmi2DoStep(one, (double)k * FMU_PERIOD, FMU_PERIOD, 1) != 0) exit(8);\n"
              : "  bool event, terminate, early;\n  double reached;\n"
                "  if (fmi3DoStep(one, (double)k * FMU_PERIOD, FMU_PERIOD, true, &event, &terminate, &early, &reached) "
                "!= 0) "
                "exit(8);\n";
  return text + gets + "}\n" + std::string(main_in_c);
}

/// What the functions of a source take of the stack together: no less than any chain of calls does, since none calls
/// itself. Nothing where the compiler does not say, or says that it is not known.
std::optional<std::size_t> stack_of(std::vector<std::string> compile, const fs::path& folder,
                                    const std::string& source) {
  compile.insert(compile.end(),
                 {"-fstack-usage", "-c", (folder / source).string(), "-o", (folder / "stack.o").string()});
  if (run_program(compile, {.errors = folder / "stack.errors"}) != 0 || !fs::exists(folder / "stack.su")) {
    return std::nullopt;
  }
  std::size_t bytes = 0;
  std::istringstream lines(read_text_file((folder / "stack.su").string()));
  for (std::string line; std::getline(lines, line);) {  // axis.c:34:6:axis_step<TAB>48<TAB>static
    const auto tab = line.find('\t');
    if (tab == std::string::npos || line.ends_with("dynamic")) {
      return std::nullopt;
    }
    bytes += std::strtoul(line.c_str() + tab + 1, nullptr, 10);
  }
  return bytes;
}

std::vector<Signal> run_in_c(const Program& program, const std::vector<GeneratedFile>& files,
                             const std::vector<std::string>& sources, const std::string& main, const Drive& drive,
                             TargetProof& proof, bool tells_stack) {
  const auto compiler = find_compiler("CC", {"cc", "gcc", "clang"});
  if (!compiler) {
    throw InputError(error::no_compiler, {}, "There is no C compiler (cc, gcc or clang) on the path.",
                     "install one (Debian: apt install gcc), or set CC.");
  }
  proof.way = fmt::format("compiled by {}", fs::path(compiler->front()).filename().string());
  const TemporaryFolder folder(fs::temp_directory_path());
  for (const GeneratedFile& file : files) {
    fs::create_directories((folder.path() / file.name).parent_path());
    write_scratch(folder.path() / file.name, file.text);
  }
  write_scratch(folder.path() / "main_of_proof.c", main);
  auto command = *compiler;
  command.insert(command.end(), {"-std=c99", "-O2", "-I" + folder.path().string()});  // as an FMU has it
  for (const std::string& flag : words_of(cpp_numeric_flags)) {
    command.push_back(flag);
  }
  const auto compile = command;
  for (const std::string& source : sources) {
    command.push_back((folder.path() / source).string());
  }
  const fs::path executable = folder.path() / "proof";
  const fs::path errors = folder.path() / "errors";
  command.insert(command.end(), {(folder.path() / "main_of_proof.c").string(), "-o", executable.string(), "-lm"});
  if (const int code = run_program(command, {.errors = errors}); code != 0) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The compiler {} refuses the generated code (exit code {}):{}", command.front(), code,
                                 first_lines(errors)),
                     "set CC to a compiler for C99.");
  }
  if (tells_stack) {
    proof.stack_bytes = stack_of(compile, folder.path(), sources.front());
  }
  return run_rows({.command = {executable.string()},
                   .name = program.graph.name,
                   .outputs = program.graph.outputs.size(),
                   .scratch = folder.path()},
                  drive);
}

// ---- in vectors -----------------------------------------------------------------------------------------------------

/// All lanes take the same inputs, and have to give the same outputs.
std::string main_of_batch(const Program& program, const std::string& header) {
  const Graph& graph = program.graph;
  const BatchNames names = batch_names(program);
  std::string text = fmt::format(
      "#include <cstdio>\n#include \"{0}\"\n{1}"
      "static {2}::Params params;\nstatic {2}::State state;\nstatic {2}::In in;\nstatic {2}::Out out;\n"
      "static void start() {{\n  {2}::reset(1, &params, &state);\n}}\n"
      "static void step(const double *row, double *results, long) {{\n  (void)row;\n  (void)results;\n"
      "  for (std::size_t i = 0; i < {2}::width; ++i) {{\n",
      header, sizes(graph), names.space);
  for (std::size_t i = 0; i < names.inputs.size(); ++i) {
    text += fmt::format("    in.{}.lane[i] = {};\n", names.inputs[i],
                        lane_of_number(graph.inputs[i].type, fmt::format("row[{}]", i)));
  }
  text += fmt::format("  }}\n  {}::step(1, &params, &state, &in, &out);\n", names.space);
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    text += fmt::format(
        "  for (std::size_t i = 1; i < {0}::width; ++i) {{\n"
        "    if (std::memcmp(&out.{1}.lane[i], &out.{1}.lane[0], sizeof(out.{1}.lane[0])) != 0) std::exit(9);\n  }}\n"
        "  results[{2}] = {3};\n",
        names.space, names.outputs[i], i,
        number_of_lane(graph.outputs[i].type, fmt::format("out.{}.lane[0]", names.outputs[i])));
  }
  return text + "}\n" + std::string(main_in_c);
}

std::vector<Signal> run_in_vectors(const Program& program, const std::vector<GeneratedFile>& files,
                                   const Drive& drive) {
  BuildCache cache;
  const fs::path executable = built_program(
      cache, batch_sources(files.front(), "#include <cstdlib>\n" + main_of_batch(program, files.front().name)));
  return run_rows({.command = {executable.string()},
                   .name = program.graph.name,
                   .outputs = program.graph.outputs.size(),
                   .scratch = cache.folder()},
                  drive);
}

// ---- read back ------------------------------------------------------------------------------------------------------

/// A text that was generated, as a diagram. Its inputs begin with those of the diagram, in the same order, under names
/// that the language leaves free; behind them stand RESET and the parameters, which keep their defaults.
std::vector<Signal> run_read_back(const Program& program, const std::string& text, const Drive& drive, bool float32) {
  const Program again = compile_text(text);
  const Graph& graph = again.graph;
  if (graph.inputs.size() < program.graph.inputs.size() || graph.outputs.size() != program.graph.outputs.size()) {
    throw InputError(error::unknown_signal, {}, "The text read back has other inputs or outputs.",
                     "this is a fault of Hysteron: please report it with the diagram.");
  }
  Drive given{.steps = drive.steps, .sample_time = drive.sample_time};
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    given.inputs.push_back(i < drive.inputs.size() ? drive.inputs[i] : Signal{graph.inputs[i].preset});
  }
  return interpret(again, given, output_wires(graph), float32);
}

}  // namespace

TargetProof prove(const Program& program, const Target& target, const std::vector<GeneratedFile>& files,
                  const TargetOptions& options) {
  const Drive drive = random_drive(program, options.float32);
  TargetProof proof{.steps = drive.steps, .outputs = program.graph.outputs.size()};
  std::vector<Signal> found;
  try {
    if (target.name == "cpp") {
      proof.way = fmt::format("compiled by {}", fs::path(compiler_command().front()).filename().string());
      found = CompiledPrograms({{.program = &program, .float32 = options.float32}}).run(0, drive);
    } else if (target.name == "batch") {
      proof.way = fmt::format("compiled by {}, all lanes", fs::path(compiler_command().front()).filename().string());
      found = run_in_vectors(program, files, drive);
    } else if (target.name == "c") {
      found = run_in_c(program, files, {namespace_identifier(program.graph.name) + ".c"}, main_of_c(program.graph),
                       drive, proof, true);
    } else if (target.name == "fmu") {
      const FmuOptions fmu{.version = options.fmi == "2" ? FmiVersion::Two : FmiVersion::Three,
                           .float32 = options.float32};
      const FmuContents contents = generate_fmu(program, fmu);
      std::vector<std::string> sources = contents.sources;
      std::erase_if(sources, [](const std::string& one) { return one.find("_fmi") != std::string::npos; });
      found = run_in_c(program, contents.files, sources, main_of_fmu(program, contents, fmu), drive, proof,
                       false);  // the functions of FMI are not in those sources
      proof.way += ", through FMI";
    } else {
      std::string text = files.front().text;
      proof.way = "read back";
      if (target.name == "plcopen") {
        proof.way = "imported and read back";
        Diagnostics told;
        text = import_plcopen(files.front().name, text, {}, told);
      }
      found = run_read_back(program, text, drive, options.float32);
    }
    proof.was_run = true;
  } catch (const InputError& refused) {
    const Diagnostic& first = refused.diagnostics().all().front();
    proof.fault = fmt::format("HY{}: {}", first.number, first.cause);
    return proof;
  }
  const std::vector<Signal> wanted = interpret(program, drive, output_wires(program.graph), options.float32);
  for (std::size_t i = 0; i < wanted.size() && proof.fault.empty(); ++i) {
    if (const std::size_t k = first_difference(wanted[i], found[i]); k != same_bits) {
      proof.fault = fmt::format("{} differs in step {}: {} for {}", program.graph.outputs[i].name, k,
                                number_text(found[i][k]), number_text(wanted[i][k]));
    }
  }
  return proof;
}

}  // namespace hysteron::tool
