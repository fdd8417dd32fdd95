// One step of the feedforward as an FMU, through the functions of FMI 3.0: an input is set, a step is done, an output
// is read.
#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/reference_signal.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/fmu/fmu.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace hysteron::bench {
namespace {

constexpr std::size_t fmu_samples = 20'000;

/// The binary of an FMU, made by the system's compiler as the tool makes it.
class Fmu {
 public:
  Fmu() : folder_(std::filesystem::temp_directory_path()) {
    Diagnostics warnings;
    const Program program = compile_file(HYSTERON_SOURCE_DIR "/bench/feedforward.st", {}, warnings);
    period_ = program.graph.sample_time();
    const FmuContents contents = generate_fmu(program);
    std::string command = "cd " + folder_.path().string() + " && cc -std=c99 -O2 -fPIC -shared -o model.so " +
                          std::string(cpp_numeric_flags);
    for (const GeneratedFile& file : contents.files) {
      const std::filesystem::path path = folder_.path() / file.name;
      std::filesystem::create_directories(path.parent_path());
      std::ofstream(path) << file.text;
      if (file.name.ends_with("_fmi3.c")) {
        const auto at = file.text.find("#define FMU_TOKEN \"") + std::strlen("#define FMU_TOKEN \"");
        token_ = file.text.substr(at, file.text.find('"', at) - at);
      }
    }
    for (const std::string& source : contents.sources) {
      command += " " + source;
    }
    if (std::system((command + " -lm").c_str()) == 0) {
      library_ = dlopen((folder_.path() / "model.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    }
  }
  ~Fmu() {
    if (library_ != nullptr) {
      dlclose(library_);
    }
  }
  Fmu(const Fmu&) = delete;
  Fmu& operator=(const Fmu&) = delete;

  [[nodiscard]] bool is_there() const { return library_ != nullptr; }

  /// Runs over the whole signal from the start and hands every output to `take`; false where a call was refused.
  template <class Take>
  bool run(const std::vector<double>& signal, Take take) {
    const auto set = function<int(void*, const std::uint32_t*, std::size_t, const double*, std::size_t)>("SetFloat64");
    const auto get = function<int(void*, const std::uint32_t*, std::size_t, double*, std::size_t)>("GetFloat64");
    const auto advance = function<int(void*, double, double, bool, bool*, bool*, bool*, double*)>("DoStep");
    void* const one =
        function<void*(const char*, const char*, const char*, bool, bool, bool, bool, const std::uint32_t*, std::size_t,
                       void*, void*, void*)>("InstantiateCoSimulation")(
            "bench", token_.c_str(), "", false, false, false, false, nullptr, 0, nullptr, nullptr, nullptr);
    int status = one == nullptr ? 1 : 0;
    status |= function<int(void*, bool, double, double, bool, double)>("EnterInitializationMode")(one, false, 0.0, 0.0,
                                                                                                  false, 0.0);
    status |= function<int(void*)>("ExitInitializationMode")(one);
    const std::uint32_t input = 1;  // Y_REF, RESET, U: inputs first
    const std::uint32_t output = 3;
    double time = 0.0;
    for (std::size_t k = 0; k < signal.size(); ++k) {
      bool event = false;
      bool terminate = false;
      bool early = false;
      double result = 0.0;
      status |= set(one, &input, 1, &signal[k], 1);
      status |= advance(one, static_cast<double>(k) * period_, period_, true, &event, &terminate, &early, &time);
      status |= get(one, &output, 1, &result, 1);
      take(result);
    }
    function<void(void*)>("FreeInstance")(one);
    return status == 0;
  }

 private:
  template <class Signature>
  [[nodiscard]] Signature* function(const std::string& name) const {
    return reinterpret_cast<Signature*>(dlsym(library_, ("fmi3" + name).c_str()));
  }

  TemporaryFolder folder_;
  double period_ = 0.0;
  std::string token_;
  void* library_ = nullptr;
};

bool has_bits_of_the_interpreter(Fmu& fmu, const std::vector<double>& signal) {
  Diagnostics warnings;
  Machine<double> machine(compile_file(HYSTERON_SOURCE_DIR "/bench/feedforward.st", {}, warnings));
  std::size_t k = 0;
  bool equal = true;
  const bool done = fmu.run(signal, [&](double output) {
    machine.set_input(0, signal[k++]);
    machine.step();
    const double wanted = machine.output(0);
    equal = equal && std::memcmp(&output, &wanted, sizeof(output)) == 0;
  });
  return done && equal;
}

void fmu_step(benchmark::State& state) {
  static const std::vector<double> signal = reference_signal(fmu_samples);
  Fmu fmu;
  if (!fmu.is_there() || !has_bits_of_the_interpreter(fmu, signal)) {
    state.SkipWithError(fmu.is_there() ? "other bits than the interpreter: nothing to compare"
                                       : "left out: there is no C compiler");
    return;
  }
  for (auto _ : state) {
    fmu.run(signal, [](double output) { benchmark::DoNotOptimize(output); });
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(fmu_samples));
}

BENCHMARK(fmu_step)->Name("step/fmu");

}  // namespace
}  // namespace hysteron::bench
