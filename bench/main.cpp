// Google Benchmark's main. It can also load the steps that bench/step.py and bench/batch.py have compiled, and write
// what rivals in other languages are given.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <span>
#include <string>
#include <string_view>

#include "bench/contender_bench.hpp"
#include "bench/machine_record.hpp"
#include "bench/many_instances.hpp"
#include "bench/reference_signal.hpp"
#include "bench/static_map_data.hpp"

namespace {

/// Doubles as this machine holds them.
void write_numbers(std::ostream& file, std::span<const double> values) {
  file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
}

/// A file with the rows behind each other; false where it could not be written.
bool write_rows(const std::string& path, std::span<const double> first, std::span<const double> second = {}) {
  std::ofstream file(path, std::ios::binary);
  write_numbers(file, first);
  write_numbers(file, second);
  return static_cast<bool>(file.flush());
}

/// signal.bin; static_map_N.bin with all p, then all M; machine_N.bin with all u, then all y; instances_N.st.
bool write_data(const std::string& folder) {
  bool good = write_rows(folder + "/signal.bin", hysteron::bench::reference_signal(20'000));
  for (const std::size_t points : {200U, 10'000U, 1'000'000U}) {
    const auto data = hysteron::bench::static_map_data(points);
    good = write_rows(folder + "/static_map_" + std::to_string(points) + ".bin", data.p, data.M) && good;
  }
  for (const std::size_t samples : {100'000U, 1'000'000U}) {
    const auto data = hysteron::bench::machine_record(samples);
    good = write_rows(folder + "/machine_" + std::to_string(samples) + ".bin", data.u, data.y) && good;
  }
  for (const int instances : {10, 1'000, 100'000}) {
    std::ofstream text(folder + "/instances_" + std::to_string(instances) + ".st", std::ios::binary);
    text << hysteron::bench::many_instances(instances, hysteron::bench::plain);
    good = text.flush() && good;
  }
  return good;
}

}  // namespace

/// hysteron_bench --data FOLDER | [--contenders FOLDER ROUNDS] [options of Google Benchmark]
int main(int count, char** arguments) {
  if (count == 3 && std::string_view(arguments[1]) == "--data") {
    if (!write_data(arguments[2])) {
      std::cerr << "cannot write into " << arguments[2] << '\n';
      return 1;
    }
    return 0;
  }
  if (count >= 4 && std::string_view(arguments[1]) == "--contenders") {
    hysteron::bench::add_contenders(arguments[2], std::atoi(arguments[3]));
    arguments[3] = arguments[0];
    arguments += 3;
    count -= 3;
  }
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) {
    return 2;
  }
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}
