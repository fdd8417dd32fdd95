// How the fits of rivals in C++ are timed: processor time of each, a line a repetition.
#pragma once

#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

/// Seconds of this process.
inline double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Fits `repetitions` times, or where that is 0 until half a second is spent, three times at least. Prints the
/// contender, its subject, the seconds and the solution.
template <class Fit>
void repeat_fit(const char* contender, const std::string& subject, Fit fit, int repetitions = 0) {
  double spent = 0.0;
  for (int runs = 0; repetitions > 0 ? runs < repetitions : runs < 3 || (spent < 0.5 && runs < 2000); ++runs) {
    const double begin = processor_time();
    const std::vector<double> solution = fit();
    const double used = processor_time() - begin;
    spent += used;
    std::printf("%s %s %.9g", contender, subject.c_str(), used);
    for (const double value : solution) {
      std::printf(" %.17g", value);
    }
    std::printf("\n");
  }
}

/// A file of two rows of doubles.
struct TwoRows {
  std::vector<double> first;
  std::vector<double> second;
};

inline TwoRows read_rows(const std::string& path, std::size_t columns) {
  TwoRows rows{std::vector<double>(columns), std::vector<double>(columns)};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(rows.first.data()), static_cast<std::streamsize>(columns * sizeof(double)));
  file.read(reinterpret_cast<char*>(rows.second.data()), static_cast<std::streamsize>(columns * sizeof(double)));
  return rows;
}
