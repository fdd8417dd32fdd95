// Every back-end against every other, over random diagrams of the whole catalogue, of all types, at several rates, with
// vectors and the blocks that take them, with inputs that are no numbers, infinite or denormal among them. Every
// diagram is run by the interpreter, by C or C++ from the system's compilers, one in four as an FMU, and, in LREAL, by
// both texts of Structured Text read back by our own front end: the one block, and the calls of the library.
//
// HYSTERON_SEED repeats the fresh part of a run, which prints its seed; HYSTERON_EVERY_BACKEND_DIAGRAMS sets the number
// of diagrams.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cfenv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "codegen/backends/c/c.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/fmu/fmu.hpp"
#include "codegen/backends/fmu/model_description.hpp"
#include "codegen/backends/st/st.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/single.hpp"
#include "tests/codegen/backends/recorded_run.hpp"
#include "tests/codegen/backends/same_inputs.hpp"
#include "tests/codegen/random_body.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

constexpr std::size_t every_steps = 500;
constexpr std::size_t every_middle = every_steps / 2;  ///< a reset before this step
constexpr std::size_t every_batch = 100;               ///< diagrams in one file of a language

struct EveryDiagram {
  std::uint64_t seed = 0;
  std::size_t number = 0;
  bool float32 = false;
  int extremes = 0;  ///< of inputs: 1: equal, denormal, large; 2: infinite and no numbers too
  std::string text{};
  Program program{};
  std::uint64_t hash = 0;

  [[nodiscard]] std::string name() const { return fmt::format("P{}", number); }
  [[nodiscard]] bool has_words() const { return program.graph.inputs.size() > RecordedRun::columns; }
  [[nodiscard]] bool has_vectors() const { return find_port(program.graph.inputs, "XV[0]") != nullptr; }
};

EveryDiagram every_diagram(std::uint64_t seed, std::size_t number) {
  const std::size_t kind = number / 2;  // one of each kind for C, and one for C++
  EveryDiagram made{.seed = seed, .number = number, .float32 = kind % 4 == 1, .extremes = static_cast<int>(kind % 3)};
  if (kind % 8 == 7) {
    const RandomBody body(seed, made.name(), 6, true);
    made.text = body.text();
    made.program = body.program();
  } else {
    const RandomDiagram diagram(seed, made.name(), 1 + static_cast<int>(kind % 5),
                                {.rates = true, .types = true, .functions = true, .vectors = kind % 2 == 0});
    made.text = diagram.text();
    made.program = diagram.program();
  }
  return made;
}

std::uint64_t every_source(const EveryDiagram& diagram) {
  return 88172645463325252ULL ^ (diagram.seed * 0x9E3779B97F4A7C15ULL);
}

/// The inputs of a step, in the order of the ports.
std::vector<double> every_row(const EveryDiagram& diagram, same::source& from) {
  std::vector<double> row;
  for (int i = 0; i < 3; ++i) {
    const double value = same::real_number(&from, diagram.extremes);
    row.push_back(diagram.float32 ? nearest_single(value) : value);
  }
  row.push_back(static_cast<double>(same::next_number(&from) % 2));
  row.push_back(static_cast<double>(same::next_number(&from) % 8 == 0));
  row.push_back(static_cast<double>(same::whole_number(&from, diagram.float32 ? 0 : 1)));
  if (diagram.has_words()) {
    row.push_back(static_cast<double>(same::next_number(&from) % 65536));
  }
  if (diagram.has_vectors()) {
    for (int i = 0; i < 3; ++i) {
      const double value = same::real_number(&from, diagram.extremes);
      row.push_back(diagram.float32 ? nearest_single(value) : value);
    }
    for (int i = 0; i < 2; ++i) {
      row.push_back(static_cast<double>(same::next_number(&from) % 2));
    }
  }
  return row;
}

/// What a program makes of the inputs. One that was read back has a RESET behind the inputs of the diagram.
template <class Real>
RecordedRun every_run(const EveryDiagram& diagram, const Program& program) {
  RecordedRun run;
  Machine<Real> machine(program, diagram.program.graph.sample_time());
  const bool read_back = program.graph.inputs.size() > diagram.program.graph.inputs.size();
  same::source from{every_source(diagram)};
  for (std::size_t k = 0; k < every_steps; ++k) {
    const std::vector<double> row = every_row(diagram, from);
    for (std::size_t i = 0; i < row.size(); ++i) {
      machine.set_input(i, static_cast<Real>(row[i]));
    }
    for (std::size_t i = row.size(); i < program.graph.inputs.size(); ++i) {  // RESET, and parameters
      machine.set_input(i, static_cast<Real>(program.graph.inputs[i].preset));
    }
    if (read_back) {
      machine.set_input(row.size(), static_cast<Real>(k == every_middle));
    } else if (k == every_middle) {
      machine.reset();
      for (std::size_t i = 0; i < row.size(); ++i) {
        machine.set_input(i, static_cast<Real>(row[i]));
      }
    }
    std::feclearexcept(FE_ALL_EXCEPT);
    machine.step();
    const bool no_number = std::ranges::any_of(row, [](double x) { return !std::isfinite(x); });
    if (no_number || std::fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW) != 0) {
      run.first_exception = std::min(run.first_exception, k);
    }
    if (std::ranges::any_of(row, [](double x) { return std::abs(x) > 1e20; })) {
      run.first_large = std::min(run.first_large, k);
    }
    for (std::size_t i = 0; i < diagram.program.graph.outputs.size(); ++i) {
      run.outputs.push_back(static_cast<double>(machine.output(i)));
    }
  }
  return run;
}

RecordedRun every_run_of(const EveryDiagram& diagram, const Program& program) {
  return diagram.float32 ? every_run<float>(diagram, program) : every_run<double>(diagram, program);
}

/// The inputs of the steps up to one, for a message.
std::string every_rows(const EveryDiagram& diagram, std::size_t last) {
  std::string text;
  same::source from{every_source(diagram)};
  for (std::size_t k = 0; k <= last; ++k) {
    const std::vector<double> row = every_row(diagram, from);
    if (k + 8 > last) {
      text += fmt::format("{},{}\n", static_cast<double>(k) * 1e-3, fmt::join(row, ","));
    }
  }
  return text;
}

/// A text that was generated, as a diagram, against the interpreter: up to the step in which a guard may act, or what
/// stands for infinity meets a signal of its size.
void hold_text(const EveryDiagram& diagram, const std::string& text, const RecordedRun& wanted, std::size_t& steps) {
  const std::size_t width = diagram.program.graph.outputs.size();
  const bool folded = std::ranges::any_of(diagram.program.graph.literals, [](double x) { return std::isnan(x); });
  const bool has_largest = text.find("stands for infinity") != std::string::npos;
  const std::size_t finite = std::min(wanted.first_exception, has_largest ? wanted.first_large : every_steps);
  const std::size_t safe = folded ? 0 : std::min(finite, every_steps);
  const Program again = compile_text(text, {.top = diagram.name()});
  const RecordedRun got = every_run_of(diagram, again);
  for (std::size_t i = 0; i < safe * width; ++i) {
    if (!same_bits(got.outputs[i], wanted.outputs[i])) {
      ADD_FAILURE() << "seed " << diagram.seed << ", number " << diagram.number << ", step " << i / width << ", "
                    << diagram.program.graph.outputs[i % width].name << ": " << got.outputs[i] << " for "
                    << wanted.outputs[i] << "\n"
                    << every_rows(diagram, i / width) << diagram.text << "\n"
                    << text;
      return;
    }
  }
  steps += safe;
}

// --- compiled languages: one file for many diagrams, which prints a hash each ---

constexpr std::string_view every_main = R"(
int main(void) {{
{}  return 0;
}}
)";

/// The values of a step's inputs in C, in the order of the ports.
std::vector<std::string> every_values(const EveryDiagram& diagram) {
  const std::string real =
      fmt::format("({})real_number(&from, {})", diagram.float32 ? "float" : "double", diagram.extremes);
  std::vector<std::string> values(3, real);
  values.insert(values.end(), {"next_number(&from) % 2 != 0", "next_number(&from) % 8 == 0",
                               fmt::format("whole_number(&from, {})", diagram.float32 ? 0 : 1)});
  if (diagram.has_words()) {
    values.emplace_back("(uint16_t)(next_number(&from) % 65536)");
  }
  if (diagram.has_vectors()) {
    values.insert(values.end(), 3, real);
    values.insert(values.end(), 2, "next_number(&from) % 2 != 0");
  }
  return values;
}

/// A loop over the steps, between the random inputs and the hash of what comes of them.
std::string every_loop_of(const EveryDiagram& diagram, std::string_view reset, std::string_view step) {
  return fmt::format(
      "  source from = {{{}u}};\n  uint64_t hash = 14695981039346656037u;\n  int k;\n"
      "  for (k = 0; k < {}; ++k) {{\n    if (k == {}) {{ {} }}\n{}  }}\n"
      "  printf(\"%llu\\n\", (unsigned long long)hash);\n",
      every_source(diagram), every_steps, every_middle, reset, step);
}

/// With the ports as members of `in` and `out`.
std::string every_loop(const EveryDiagram& diagram, std::string_view reset, std::string_view step) {
  std::string text;
  const std::vector<std::string> values = every_values(diagram);
  const std::vector<std::string> inputs = port_members(diagram.program.graph.inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    text += fmt::format("    in.{} = {};\n", inputs[i], values.at(i));
  }
  text += fmt::format("    {}\n", step);
  for (const std::string& member : port_members(diagram.program.graph.outputs)) {
    text += fmt::format("    mix(&hash, (double)out.{});\n", member);
  }
  return every_loop_of(diagram, reset, text);
}

/// Each source of C has functions of its own that help: in one file with others they get the name of the diagram.
std::string with_own_helpers(const std::string& source, const std::string& name) {
  static const std::regex helper(R"(^static (?:inline )?\w+ \*?(\w+)\()", std::regex::multiline);
  std::set<std::string> names;
  for (auto one = std::sregex_iterator(source.begin(), source.end(), helper); one != std::sregex_iterator(); ++one) {
    names.insert((*one)[1]);
  }
  std::string text;
  for (const std::string& one : names) {
    text += fmt::format("#define {0} {1}_{0}\n", one, name);
  }
  text += source;
  for (const std::string& one : names) {
    text += fmt::format("#undef {}\n", one);
  }
  return text;
}

/// One in four diagrams is an FMU, too: of FMI 2.0 and of FMI 3.0 by turns.
bool is_fmu(const EveryDiagram& diagram) {
  return diagram.number % 4 == 0;
}

std::string every_in_c(const std::vector<EveryDiagram>& batch) {
  std::string text =
      "#include <math.h>\n#include <stdbool.h>\n#include <stdint.h>\n#include <stdio.h>\n#include <string.h>\n";
  text += std::string(same::text) + "\n";
  std::string calls;
  std::string fmus;
  for (const EveryDiagram& diagram : batch) {
    const std::string name = fmt::format("p{}", diagram.number);
    const std::vector<GeneratedFile> files = generate_c(diagram.program, {.float32 = diagram.float32});
    std::string source = files.at(1).text;
    const std::string include = fmt::format("#include \"{}\"\n", files.at(0).name);
    source.replace(source.find(include), include.size(), "");
    text += files.at(0).text + with_own_helpers(source, name);
    const std::string reset = fmt::format("{0}_reset(&state, &params);", name);
    text += fmt::format(
        "static void run_{0}(void) {{\n  {0}_params params;\n  {0}_state state;\n  {0}_in in;\n  {0}_out out;\n"
        "  {0}_defaults(&params, &in);\n  {1}\n{2}}}\n",
        name, reset, every_loop(diagram, reset, fmt::format("{}_step(&params, &state, &in, &out);", name)));
    calls += fmt::format("  run_{}();\n", name);
    if (is_fmu(diagram)) {
      text += fmt::format("void run_{}_fmu(void);\n", name);
      fmus += fmt::format("  run_{}_fmu();\n", name);
    }
  }
  return text + fmt::format(every_main, calls + fmus);
}

std::string every_in_cpp(const std::vector<EveryDiagram>& batch) {
  std::string text = "#include <array>\n#include <cmath>\n#include <cstdint>\n#include <cstdio>\n#include <cstring>\n";
  std::string own = std::string(same::text) + "\n";
  std::string calls;
  for (const EveryDiagram& diagram : batch) {
    const std::string name = fmt::format("p{}", diagram.number);
    std::string header = generate_cpp_header(diagram.program, {.float32 = diagram.float32}).text;
    header.replace(header.find("#pragma once"), 12, "");
    text += header;
    const std::string reset = fmt::format("{}::reset(params, state);", name);
    own += fmt::format(
        "static void run_{0}() {{\n  {0}::Params params;\n  {0}::State state;\n  {0}::In in;\n  {1}\n{2}}}\n", name,
        reset, every_loop(diagram, reset, fmt::format("const auto out = {}::step(params, state, in);", name)));
    calls += fmt::format("  run_{}();\n", name);
  }
  return text + own + fmt::format(every_main, calls);
}

/// An FMU as a source of its own, with an importer of a few lines behind it. It shares the step of the C file.
std::string every_fmu(const EveryDiagram& diagram, const test::ScratchFolder& folder) {
  const bool three = diagram.number % 8 == 0;
  const FmuOptions options{.version = three ? FmiVersion::Three : FmiVersion::Two, .float32 = diagram.float32};
  const FmuContents fmu = generate_fmu(diagram.program, options);
  const std::string name = fmt::format("p{}", diagram.number);
  std::string wrapper;
  for (const GeneratedFile& file : fmu.files) {
    if (file.name.ends_with(".h")) {
      folder.write(name + ".h", file.text);
    } else if (file.name == fmu.sources.back()) {
      wrapper = file.text;
    }
  }
  const std::string start =
      three ? "status |= FMI(EnterInitializationMode)(one, false, 0.0, 0.0, false, 0.0);"
            : "status |= FMI(SetupExperiment)(one, 0, 0.0, 0.0, 0, 0.0) | FMI(EnterInitializationMode)(one);";
  const std::string begin = start + " status |= FMI(ExitInitializationMode)(one); first = k;";
  const auto access = [&](std::string_view verb, const FmuVariable& variable, std::size_t reference) {
    return fmt::format("{{ const unsigned r = {}u; status |= FMI({}{})(one, &r, 1, v{}); }}", reference, verb,
                       fmi_type_name(variable.type, options), three ? fmt::format(", {}", variable.start.size()) : "");
  };
  const auto c_type = [&](Type type) -> std::string {
    if (!three) {
      return type == Type::Real ? "double" : "int";
    }
    return type == Type::Real   ? (diagram.float32 ? "float" : "double")
           : type == Type::Bool ? "bool"
           : type == Type::Int  ? "int32_t"
                                : "uint16_t";
  };
  const std::vector<std::string> values = every_values(diagram);
  const std::vector<FmuVariable> variables = fmu_variables(diagram.program, options);
  std::string step;
  std::string results;
  std::size_t next = 0;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const FmuVariable& one = variables[i];
    if (one.role == FmuVariable::Role::Input) {
      std::string given;
      for (std::size_t k = 0; k < one.start.size(); ++k) {
        given += (k == 0 ? "" : ", ") + values.at(next++);
      }
      step += fmt::format("    {{ const {} v[] = {{{}}}; {} }}\n", c_type(one.type), given, access("Set", one, i + 1));
    } else if (one.role == FmuVariable::Role::Output) {
      results += fmt::format("    {{ {0} v[{1}]; int j; {2} for (j = 0; j < {1}; ++j) mix(&hash, (double)v[j]); }}\n",
                             c_type(one.type), one.start.size(), access("Get", one, i + 1));
    }
  }
  step += three
              ? "    { bool e, t, y; double at; status |= FMI(DoStep)(one, (k - first) * FMU_PERIOD, FMU_PERIOD, true, "
                "&e, &t, &y, &at); }\n"
              : "    status |= FMI(DoStep)(one, (k - first) * FMU_PERIOD, FMU_PERIOD, 1);\n";
  step += results;
  step += "    if (status != 0) { hash = 0; }\n";
  const std::string instantiate =
      three ? "FMI(InstantiateCoSimulation)(\"one\", FMU_TOKEN, \"\", 0, 0, 0, 0, 0, 0, 0, 0, 0)"
            : "FMI(Instantiate)(\"one\", 1, FMU_TOKEN, \"\", &callbacks, 0, 0)";
  folder.write(name + "_fmu.c",
               fmt::format("#define FMI{0}_FUNCTION_PREFIX {1}_\n#include <stdio.h>\n{2}\n{3}\n"
                           "void run_{1}_fmu(void) {{\n{4}  void *one = {5};\n  int status = one == 0;\n"
                           "  int first = 0;\n  {{ int k = 0; {6} }}\n{7}  FMI(FreeInstance)(one);\n}}\n",
                           three ? 3 : 2, name, wrapper, same::text,
                           three ? "" : "  static const fmi2CallbackFunctions callbacks = {0};\n", instantiate, begin,
                           every_loop_of(diagram, "status |= FMI(Reset)(one); " + begin, step)));
  return name + "_fmu.c";
}

/// Compiled without optimisation: what is tried is the text, and its bits are the same.
std::size_t hold_compiled(const std::vector<EveryDiagram>& batch, const std::vector<std::string>& files,
                          const test::ScratchFolder& folder, std::string_view compiler) {
  const std::string build = fmt::format("cd {} && {} -O0 -w {} {} -o run -lm > log 2>&1 && ./run > out",
                                        folder.path().string(), compiler, cpp_numeric_flags, fmt::join(files, " "));
  EXPECT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 3000);
  std::istringstream hashes(test::contents_of(folder / "out"));
  std::size_t steps = 0;
  for (const EveryDiagram& diagram : batch) {
    std::uint64_t got = 0;
    hashes >> got;
    EXPECT_EQ(got, diagram.hash) << compiler << ", seed " << diagram.seed << ", number " << diagram.number << "\n"
                                 << diagram.text;
    steps += every_steps;
  }
  return steps;
}

std::size_t hold_in_cpp(const std::vector<EveryDiagram>& batch) {
  const test::ScratchFolder folder;
  folder.write("all.cpp", every_in_cpp(batch));
  return hold_compiled(batch, {"all.cpp"}, folder, "c++ -std=c++11");
}

/// The steps of C, and those of FMUs behind them.
void hold_in_c(const std::vector<EveryDiagram>& batch, std::size_t& in_c, std::size_t& in_fmus) {
  const test::ScratchFolder folder;
  std::vector<std::string> files{"all.c"};
  std::vector<EveryDiagram> printed = batch;
  for (const EveryDiagram& diagram : batch) {
    if (is_fmu(diagram)) {
      files.push_back(every_fmu(diagram, folder));
      printed.push_back(diagram);
    }
  }
  folder.write("all.c", every_in_c(batch));
  const std::size_t steps = hold_compiled(printed, files, folder, "cc -std=c99");
  in_c += batch.size() * every_steps;
  in_fmus += steps - batch.size() * every_steps;
}

struct EveryCount {
  std::size_t diagrams = 0;
  std::size_t compiled = 0;
  std::size_t fmus = 0;
  std::size_t flat = 0;
  std::size_t structured = 0;
};

void hold_batch(std::uint64_t first_seed, std::size_t count, EveryCount& total) {
  std::vector<EveryDiagram> in_c;
  std::vector<EveryDiagram> in_cpp;
  for (std::size_t i = 0; i < count; ++i) {
    EveryDiagram diagram = every_diagram(first_seed + i, i);
    const RecordedRun wanted = every_run_of(diagram, diagram.program);
    diagram.hash = 14695981039346656037ULL;
    std::ranges::for_each(wanted.outputs, [&](double value) { same::mix(&diagram.hash, value); });
    // Constants of REAL are folded in 64 bits when a text is read, so a text of REAL is no second opinion on bits.
    if (!diagram.float32) {
      const StOptions options{.dialect = *st_dialect("portable")};
      hold_text(diagram, generate_st_structured(diagram.program, options).front().text, wanted, total.structured);
      hold_text(diagram, generate_st(diagram.program, options).front().text, wanted, total.flat);
    }
    (i % 2 == 0 ? in_c : in_cpp).push_back(std::move(diagram));
  }
  hold_in_c(in_c, total.compiled, total.fmus);
  total.compiled += hold_in_cpp(in_cpp);
  total.diagrams += count;
}

constexpr int parts = 8;

/// A part of the diagrams; half of the parts have a fixed seed, the others a fresh one.
class EveryBackend : public ::testing::TestWithParam<int> {};

TEST_P(EveryBackend, HasTheBitsOfEveryOther) {
  const char* const wanted = std::getenv("HYSTERON_EVERY_BACKEND_DIAGRAMS");
  const std::size_t diagrams = (wanted != nullptr ? std::strtoul(wanted, nullptr, 10) : 2000) / parts;
  const char* const given = std::getenv("HYSTERON_SEED");
  const bool fixed = GetParam() < parts / 2;
  std::uint64_t seed = 1'000'000 * static_cast<std::uint64_t>(GetParam() + 1);
  if (!fixed) {
    seed = given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
    fmt::print("HYSTERON_SEED={}\n", seed);
  }
  EveryCount total;
  for (std::size_t first = 0; first < diagrams; first += every_batch) {
    hold_batch(seed + first, std::min(every_batch, diagrams - first), total);
  }
  fmt::print(
      "{} diagrams; steps of equal bits: {} compiled, {} as FMUs, {} read back as one block, {} read back as calls of "
      "the library\n",
      total.diagrams, total.compiled, total.fmus, total.flat, total.structured);
}

INSTANTIATE_TEST_SUITE_P(FixedAndFreshSeeds, EveryBackend, ::testing::Range(0, parts));

}  // namespace
}  // namespace hysteron::testing
