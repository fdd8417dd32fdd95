// The steps that bench/step.py and bench/batch.py have compiled, a library each, and the interpreter on the same
// diagrams. Their outputs are compared with the interpreter's before anything is timed.
#include "bench/contender_bench.hpp"

#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "bench/reference_signal.hpp"
#include "codegen/interpreter/machine.hpp"

namespace hysteron::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t samples_of_round = 20'000;
/// Of a batch: as much work as 128 instances have in a round of 20,000.
constexpr std::size_t work_of_batch = 128 * samples_of_round;
/// Of the largest output. What is below is rounding in another order; what is above is another diagram.
constexpr double largest_difference = 1e-9;

const std::vector<double>& signal() {
  static const std::vector<double> samples = reference_signal(samples_of_round);
  return samples;
}

/// Resets and runs over so many samples of the signal.
class Interpreted {
 public:
  explicit Interpreted(const std::string& diagram) : machine_(program(diagram)) {}

  [[nodiscard]] static long instances() { return 1; }

  void run(double* output, std::size_t samples) {
    machine_.reset();
    for (std::size_t k = 0; k < samples; ++k) {
      machine_.set_input(0, signal()[k]);
      machine_.step();
      output[k] = machine_.output(0);
    }
  }

 private:
  static Program program(const std::string& diagram) {
    Diagnostics warnings;
    return compile_file(HYSTERON_SOURCE_DIR "/bench/" + diagram + ".st", {}, warnings);
  }

  Machine<double> machine_;
};

/// A library with the functions of bench/rivals/contender.h. It stays loaded.
class Contender {
 public:
  explicit Contender(const std::string& path) {
    if (void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL); library != nullptr) {
      reset_ = reinterpret_cast<void (*)()>(dlsym(library, "contender_reset"));
      run_ = reinterpret_cast<void (*)(const double*, double*, long)>(dlsym(library, "contender_run"));
      if (const auto count = reinterpret_cast<long (*)()>(dlsym(library, "contender_instances")); count != nullptr) {
        instances_ = count();
      }
    }
  }

  [[nodiscard]] bool is_there() const { return reset_ != nullptr && run_ != nullptr; }

  [[nodiscard]] long instances() const { return instances_; }

  void run(double* output, std::size_t samples) const {
    reset_();
    run_(signal().data(), output, static_cast<long>(samples));
  }

 private:
  long instances_ = 1;
  void (*reset_)() = nullptr;
  void (*run_)(const double*, double*, long) = nullptr;
};

/// The largest difference of two runs, as a share of the largest output.
double difference(const std::vector<double>& wanted, const std::vector<double>& got) {
  double largest = 0.0;
  double apart = 0.0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    largest = std::max(largest, std::fabs(wanted[k]));
    const double here = std::fabs(wanted[k] - got[k]);
    apart = std::isfinite(here) ? std::max(apart, here) : INFINITY;
  }
  return apart / largest;
}

template <class Kind>
void time_rounds(benchmark::State& state, Kind& kind, const std::string& diagram) {
  if (kind.instances() < 1) {
    state.SkipWithError("left out: this processor has no registers of so many numbers");
    return;
  }
  const auto instances = static_cast<std::size_t>(kind.instances());
  const std::size_t samples = std::min(samples_of_round, work_of_batch / instances);
  std::vector<double> wanted(samples);
  std::vector<double> output(samples);
  Interpreted(diagram).run(wanted.data(), samples);
  kind.run(output.data(), samples);
  const double apart = difference(wanted, output);
  if (!(apart <= largest_difference)) {
    state.SkipWithError("other outputs than the interpreter's: not timed");
    return;
  }
  for (auto _ : state) {
    kind.run(output.data(), samples);
    benchmark::DoNotOptimize(output.data());
  }
  state.counters["work"] = static_cast<double>(samples * instances);
  state.counters["difference"] = apart;
}

}  // namespace

void add_contenders(const std::string& folder, int rounds) {
  for (const auto& of_diagram : fs::directory_iterator(folder)) {
    const std::string diagram = of_diagram.path().filename().string();
    const std::string name = "contender/" + diagram + "/";
    benchmark::RegisterBenchmark((name + "interpreter").c_str(), [diagram](benchmark::State& state) {
      Interpreted interpreted(diagram);
      time_rounds(state, interpreted, diagram);
    })->Iterations(rounds);
    for (const auto& file : fs::directory_iterator(of_diagram)) {
      if (file.path().extension() != ".so") {
        continue;
      }
      const std::string path = file.path().string();
      benchmark::RegisterBenchmark((name + file.path().stem().string()).c_str(), [diagram,
                                                                                  path](benchmark::State& state) {
        Contender contender(path);
        if (!contender.is_there()) {
          state.SkipWithError("not loaded");
          return;
        }
        time_rounds(state, contender, diagram);
      })->Iterations(rounds);
    }
  }
}

}  // namespace hysteron::bench
