// Google Benchmark's main, which can also write the points of the static fit for a rival in another language.
#include <benchmark/benchmark.h>

#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

#include "bench/static_map_data.hpp"

namespace {

/// Doubles as this machine holds them: all p, then all M.
bool write_static_map_data(const std::string& folder, std::size_t points) {
  const auto data = hysteron::bench::static_map_data(points);
  std::ofstream file(folder + "/static_map_" + std::to_string(points) + ".bin", std::ios::binary);
  for (const auto* values : {&data.p, &data.M}) {
    file.write(reinterpret_cast<const char*>(values->data()),
               static_cast<std::streamsize>(values->size() * sizeof(double)));
  }
  file.close();
  return !file.fail();
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 3 && std::string_view(arguments[1]) == "--write-static-map-data") {
    for (const std::size_t points : {200U, 10'000U, 1'000'000U}) {
      if (!write_static_map_data(arguments[2], points)) {
        std::cerr << "cannot write into " << arguments[2] << '\n';
        return 1;
      }
    }
    return 0;
  }
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) {
    return 2;
  }
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}
