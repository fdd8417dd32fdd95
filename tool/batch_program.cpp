#include "tool/batch_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "codegen/backends/batch/batch.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/built_program.hpp"
#include "tool/compiler.hpp"
#include "tool/process.hpp"
#include "tool/row_program.hpp"
#include "tuning/float32_run.hpp"

namespace hysteron::tool {
namespace {

/// Figures of an output that a program writes: least, most, last, rms, rmse.
constexpr std::size_t figure_count = 5;

/// By a thread of the compiled program: 16 packs, which stay in the first cache.
constexpr std::size_t sets_at_once = 16 * batch_width;

/// Sums in the order of the steps: those of the compiled program, below, are taken alike.
class Figures {
 public:
  void add(double value, double measured) {
    least_ = value < least_ ? value : least_;
    most_ = value > most_ ? value : most_;
    last_ = value;
    squares_ += value * value;
    errors_ += (value - measured) * (value - measured);
  }
  [[nodiscard]] OutputFigures of(std::size_t steps) const {
    const auto count = static_cast<double>(steps);
    return {.least = least_,
            .most = most_,
            .last = last_,
            .rms = std::sqrt(squares_ / count),
            .rmse = std::sqrt(errors_ / count)};
  }

 private:
  double least_ = infinity;
  double most_ = -infinity;
  double last_ = 0.0;
  double squares_ = 0.0;
  double errors_ = 0.0;
};

/// {0}: the header; {1}: the namespace; {2}: inputs; {3}: measured signals; {4}: values of parameters; {5}: outputs;
/// {6}: parameters of a lane; {7}: inputs of all lanes; {8}: outputs of all lanes.
constexpr std::string_view batch_main = R"(#include "{0}"

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <thread>
#include <vector>

namespace {{

constexpr std::size_t packs = 16;  // at once: what they need stays in the first cache
constexpr std::size_t width = {1}::width;

struct Figures {{
  double least[width], most[width], last[width], squares[width], errors[width];
}};

void begin(Figures& figures) {{
  for (std::size_t i = 0; i < width; ++i) {{
    figures.least[i] = std::numeric_limits<double>::infinity();
    figures.most[i] = -figures.least[i];
    figures.last[i] = figures.squares[i] = figures.errors[i] = 0.0;
  }}
}}

void set_lane({1}::Params& params, std::size_t lane, const double* value) {{
  (void)params;
  (void)lane;
  (void)value;
{6}}}

void set_inputs({1}::In& in, const double* row) {{
  (void)in;
  (void)row;
  for (std::size_t i = 0; i < width; ++i) {{
{7}  }}
}}

void add(Figures& figures, const double* values, double measured) {{
  for (std::size_t i = 0; i < width; ++i) {{
    const double value = values[i];
    figures.least[i] = value < figures.least[i] ? value : figures.least[i];
    figures.most[i] = value > figures.most[i] ? value : figures.most[i];
    figures.last[i] = value;
    figures.squares[i] += value * value;
    figures.errors[i] += (value - measured) * (value - measured);
  }}
}}

struct Task {{
  std::size_t steps, sets;
  std::vector<double> rows, measured, values, results;
}};

void run(Task& task, std::size_t group) {{
  std::vector<{1}::Params> params(packs);
  std::vector<{1}::State> state(packs);
  std::vector<{1}::In> in(packs);
  std::vector<{1}::Out> out(packs);
  std::vector<Figures> figures(packs * {5});
  const std::size_t first = group * packs * width;
  const std::size_t count = task.sets - first < packs * width ? task.sets - first : packs * width;
  const std::size_t used = (count + width - 1) / width;
  for (std::size_t i = 0; i < used * width; ++i) {{  // lanes behind the last set repeat it
    set_lane(params[i / width], i % width, task.values.data() + (first + (i < count ? i : count - 1)) * {4});
  }}
  for (Figures& one : figures) {{
    begin(one);
  }}
  {1}::reset(used, params.data(), state.data());
  for (std::size_t k = 0; k < task.steps; ++k) {{
    set_inputs(in[0], task.rows.data() + k * {2});
    for (std::size_t p = 1; p < used; ++p) {{
      in[p] = in[0];
    }}
    {1}::step(used, params.data(), state.data(), in.data(), out.data());
    const double* measured = task.measured.data() + k * {3};
    (void)measured;
    for (std::size_t p = 0; p < used; ++p) {{
      double values[width];
      (void)values;
{8}    }}
  }}
  const double steps = static_cast<double>(task.steps);
  for (std::size_t i = 0; i < count; ++i) {{
    for (std::size_t o = 0; o < {5}; ++o) {{
      const Figures& one = figures[i / width * {5} + o];
      double* result = task.results.data() + ((first + i) * {5} + o) * 5;
      result[0] = one.least[i % width];
      result[1] = one.most[i % width];
      result[2] = one.last[i % width];
      result[3] = std::sqrt(one.squares[i % width] / steps);
      result[4] = std::sqrt(one.errors[i % width] / steps);
    }}
  }}
}}

bool read(std::vector<double>& list, std::size_t count) {{
  list.resize(count);
  return std::fread(list.data(), sizeof(double), count, stdin) == count;
}}

}}  // namespace

int main(int count, char** arguments) {{
  if (count != 4) {{
    return 2;
  }}
  Task task;
  task.steps = std::strtoull(arguments[1], nullptr, 10);
  task.sets = std::strtoull(arguments[2], nullptr, 10);
  const unsigned long threads = std::strtoul(arguments[3], nullptr, 10);
  if (!read(task.rows, task.steps * {2}) || !read(task.measured, task.steps * {3}) ||
      !read(task.values, task.sets * {4})) {{
    return 3;
  }}
  task.results.resize(task.sets * {5} * 5);
  const std::size_t groups = (task.sets + packs * width - 1) / (packs * width);
  std::atomic<std::size_t> next{{0}};
  std::vector<std::thread> workers;
  for (unsigned long i = 0; i < threads; ++i) {{
    workers.emplace_back([&] {{
      for (std::size_t group = next++; group < groups; group = next++) {{
        run(task, group);
      }}
    }});
  }}
  for (std::thread& one : workers) {{
    one.join();
  }}
  return std::fwrite(task.results.data(), sizeof(double), task.results.size(), stdout) == task.results.size() &&
                 std::fflush(stdout) == 0
             ? 0
             : 4;
}}
)";

std::string main_text(const Program& program, const std::string& header, const std::vector<const Signal*>& measured) {
  const Graph& graph = program.graph;
  const BatchNames names = batch_names(program);
  std::string parameters;
  std::size_t value = 0;
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    const Parameter& one = graph.parameters[i];
    for (std::size_t k = 0; k < one.value.size(); ++k, ++value) {
      const std::string member = names.parameters[i] + (one.field.length > 1 ? fmt::format("[{}]", k) : "");
      parameters += fmt::format("  params.{}.lane[lane] = {};\n", member,
                                lane_of_number(one.field.type, fmt::format("value[{}]", value)));
    }
  }
  std::string inputs;
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    inputs += fmt::format("    in.{}.lane[i] = {};\n", names.inputs[i],
                          lane_of_number(graph.inputs[i].type, fmt::format("row[{}]", i)));
  }
  std::string outputs;
  std::size_t columns = 0;
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    outputs += fmt::format(
        "      for (std::size_t i = 0; i < width; ++i) {{\n        values[i] = {};\n      }}\n"
        "      add(figures[p * {} + {}], values, {});\n",
        number_of_lane(graph.outputs[i].type, fmt::format("out[p].{}.lane[i]", names.outputs[i])), graph.outputs.size(),
        i, measured[i] != nullptr ? fmt::format("measured[{}]", columns++) : "0.0");
  }
  return fmt::format(batch_main, header, names.space, fmt::format("{}u", graph.inputs.size()),
                     fmt::format("{}u", columns), fmt::format("{}u", value), fmt::format("{}u", graph.outputs.size()),
                     parameters, inputs, outputs);
}

void append_bytes(std::string& bytes, double value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(value));
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

/// What the program reads: rows of inputs, rows of measured signals, sets.
std::string bytes_of(const BatchRequest& request) {
  std::string bytes;
  for (std::size_t k = 0; k < request.drive->steps; ++k) {
    for (const Signal& input : request.drive->inputs) {
      append_bytes(bytes, at_step(input, k));
    }
  }
  for (std::size_t k = 0; k < request.drive->steps; ++k) {
    for (const Signal* const one : request.measured) {
      if (one != nullptr) {
        append_bytes(bytes, (*one)[k]);
      }
    }
  }
  for (const std::vector<double>& set : request.sets->whole) {
    for (const double value : set) {
      append_bytes(bytes, value);
    }
  }
  return bytes;
}

void set_values(Graph& graph, const std::vector<double>& values) {
  auto next = values.begin();
  for (Parameter& one : graph.parameters) {
    std::copy_n(next, one.value.size(), one.value.begin());
    next += static_cast<std::ptrdiff_t>(one.value.size());
  }
}

}  // namespace

ProgramSources batch_sources(const GeneratedFile& header, std::string main) {
  ProgramSources sources{.main = std::move(main), .headers = {header}, .flags = words_of(batch_flags)};
  sources.flags.emplace_back("-std=c++17");
  return sources;
}

BatchResult run_compiled_batch(const BatchRequest& request) {
  const Program& program = *request.program;
  const GeneratedFile header = generate_batch(program);
  ProgramSources sources = batch_sources(header, main_text(program, header.name, request.measured));
  sources.flags.emplace_back("-pthread");
  sources.without = "write --engine interpreter";
#if defined(__x86_64__) && defined(__GLIBC__)
  if (request.fast) {
    sources.flags.emplace_back("-DHYSTERON_BATCH_FAST");
    sources.libraries.emplace_back("-lmvec");
  }
#endif
  BuildCache cache;
  const auto executable = built_program(cache, sources);
  const TemporaryFolder folder(cache.folder());
  const Streams streams{
      .input = folder.path() / "in", .output = folder.path() / "out", .errors = folder.path() / "err"};
  write_scratch(streams.input, bytes_of(request));
  const std::size_t sets = request.sets->size();
  const std::size_t groups = (sets + sets_at_once - 1) / sets_at_once;
  const int code = run_program({executable.string(), std::to_string(request.drive->steps), std::to_string(sets),
                                std::to_string(std::clamp<std::size_t>(request.threads, 1, groups))},
                               streams);
  const std::size_t outputs = program.graph.outputs.size();
  const std::string written = code == 0 ? read_text_file(streams.output.string()) : std::string();
  if (code != 0 || written.size() != sets * outputs * figure_count * sizeof(double)) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The program generated from {} does not run to its end (exit code {}):{}",
                                 program.graph.name, code, first_lines(streams.errors)),
                     "see whether programs may be run from the folder for temporary files; TMPDIR sets another; or "
                     "write --engine interpreter.");
  }
  BatchResult result(sets, std::vector<OutputFigures>(outputs));
  const char* at = written.data();
  for (auto& set : result) {
    for (OutputFigures& one : set) {
      for (double* const figure : {&one.least, &one.most, &one.last, &one.rms, &one.rmse}) {
        std::memcpy(figure, at, sizeof(double));
        at += sizeof(double);
      }
    }
  }
  return result;
}

BatchResult run_interpreted_batch(const BatchRequest& request, bool float32) {
  const Program& program = *request.program;
  const std::vector<Wire> wires = output_wires(program.graph);
  BatchResult result(request.sets->size());
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    Program set = program;
    for (std::size_t i = next++; i < result.size(); i = next++) {
      set_values(set.graph, request.sets->whole[i]);
      const auto values = interpret(set, *request.drive, wires, float32);
      for (std::size_t o = 0; o < values.size(); ++o) {
        Figures figures;
        for (std::size_t k = 0; k < request.drive->steps; ++k) {
          figures.add(values[o][k], request.measured[o] != nullptr ? (*request.measured[o])[k] : 0.0);
        }
        result[i].push_back(figures.of(request.drive->steps));
      }
      const std::lock_guard lock(mutex);
      if (request.progress) {
        request.progress(static_cast<double>(++done) / static_cast<double>(result.size()));
      }
    }
  };
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = failure ? failure : std::current_exception();
      next = result.size();
    }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < std::min<std::size_t>(request.threads, result.size()); ++i) {
    workers.emplace_back(guarded);
  }
  guarded();
  for (std::thread& one : workers) {
    one.join();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
  return result;
}

bool worth_compiling(const BatchRequest& request) {
  constexpr double node = 5e-9;     // s, interpreted
  constexpr double compiler = 2.0;  // s
  const auto steps = static_cast<double>(request.drive->steps) * static_cast<double>(request.sets->size());
  return steps * static_cast<double>(request.program->graph.nodes.size()) * node > compiler * request.threads;
}

}  // namespace hysteron::tool
