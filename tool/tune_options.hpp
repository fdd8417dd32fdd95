// What `hysteron tune` is asked, by records or by a goal alike.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tool/diagram.hpp"
#include "tool/record_options.hpp"

namespace hysteron::tool {

struct TuneOptions {
  DiagramOptions diagram;
  RecordOptions record;
  std::vector<std::string> logs;
  std::string output;
  std::string report;
  int starts = 1;
  bool json = false;
};

/// As shells give it for a program that an interrupt has ended.
inline constexpr int exit_interrupted = 130;

/// Takes Ctrl-C as a wish to end the work, for as long as it lives.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;
  InterruptWatch(InterruptWatch&&) = delete;
  InterruptWatch& operator=(InterruptWatch&&) = delete;

  [[nodiscard]] bool interrupted() const;

 private:
  void (*before_)(int);
};

/// What the end of the work would fail on is said before it: throws InputError HY700, HY709. `reports` are the files of
/// --report, where it is given.
void prove_outputs(const TuneOptions& options, const std::vector<std::filesystem::path>& reports);

}  // namespace hysteron::tool
