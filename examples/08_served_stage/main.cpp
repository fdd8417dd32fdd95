// Example 8: a generated feedforward drives a stage over Modbus, each a process of its own, and the record of the run
// says what the feedforward does not know of the stage.
#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdio>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "examples/example.hpp"
#include "records/read.hpp"
#include "support/atomic_file.hpp"
#include "support/text_file.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

constexpr int period = 1000;  ///< samples to a period of the reference

/// A program of the shell while it runs.
class Process {
 public:
  explicit Process(const std::string& command) : stream_(::popen(command.c_str(), "r")) {}
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  Process(Process&&) = delete;
  Process& operator=(Process&&) = delete;
  ~Process() {
    if (stream_ != nullptr) {
      (void)::pclose(stream_);
    }
  }

  std::string line() {
    std::string text;
    for (int letter = 0; (letter = std::fgetc(stream_)) != EOF && letter != '\n';) {
      text += static_cast<char>(letter);
    }
    return text;
  }
  /// What it still prints, until it ends. Throws std::runtime_error where its exit code is not 0.
  std::string rest() {
    std::string text;
    for (int letter = 0; (letter = std::fgetc(stream_)) != EOF;) {
      text += static_cast<char>(letter);
    }
    const int status = ::pclose(std::exchange(stream_, nullptr));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
      throw std::runtime_error("a program of this example failed:\n" + text);
    }
    return text;
  }

 private:
  std::FILE* stream_;
};

std::string run(const std::string& command) {
  return Process(command + " 2>&1").rest();
}

std::string file(const char* name) {
  return path_of(std::string("08_served_stage/") + name).string();
}

/// The stage and its controller, side by side until the controller has run so many cycles; leaves run.trace, and the
/// record of it, in the folder. What the replay says.
std::string drive(const std::filesystem::path& folder, bool virtual_time, int cycles) {
  std::filesystem::create_directories(folder);
  Process stage(std::string(HYSTERON_STAGE) + (virtual_time ? " --lockstep" : ""));
  std::string run_file = read_text_file(file("run.toml"));
  const std::string port = "port = 15108";
  run_file.replace(run_file.find(port), port.size(), "port = " + stage.line());
  write_file_atomically(folder / "run.toml", run_file);
  (void)run(fmt::format("cd '{}' && '{}' run.toml {} --cycles {}", folder.string(), HYSTERON_FEEDFORWARD_HOST,
                        virtual_time ? "--virtual" : "", cycles));
  (void)stage.rest();
  return run(
      fmt::format("cd '{}' && '{}' replay '{}' --params '{}' --trace run.trace --out record.csv --engine compiled",
                  folder.string(), HYSTERON_TOOL, file("feedforward.st"), file("stage.toml")));
}

/// U and Y in every tenth row, which is a hundred to a period.
void thin(const records::Record& record, const std::filesystem::path& to) {
  const auto every_tenth = [](std::span<const double> values) {
    std::vector<double> result;
    for (std::size_t i = 0; i < values.size(); i += 10) {
      result.push_back(values[i]);
    }
    return result;
  };
  std::vector<records::Column> columns{{.name = "t", .values = every_tenth(record.time())}};
  for (const char* const name : {"U", "Y"}) {
    columns.push_back({.name = name, .values = every_tenth(column(record, name))});
  }
  write_table(to, columns);
}

/// What the diagnosis names, and how far that closes the gap. Where an effect acts is left out: on a line of blocks
/// several places fit alike.
std::string summary_of(const std::string& said) {
  std::string names;
  std::string gap;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (line.ends_with(" % of the gap")) {
      names += (names.empty() ? "" : ", ") + first;
    } else if (first == "Y" || first == "closed") {
      gap += line.substr(0, line.find(" (")) + "\n";
    }
  }
  return "The diagnosis of the record names " + names + ":\n" + gap;
}

void example(const std::filesystem::path& given) {
  const auto folder = std::filesystem::absolute(given);
  fmt::print("In real time, a second: {}", drive(folder / "real_time", false, period));
  fmt::print("On the virtual clock:   {}", drive(folder, true, 20 * period));
  const records::Record record = records::read_record((folder / "record.csv").string());
  const auto error = column(record, "ERR");
  fmt::print("Tracking error {:.3f} um RMS, {:.2f} % of the range\n", rms(error),
             100.0 * rms(error) / range(column(record, "REF")));
  std::fflush(stdout);
  thin(record, folder / "every_tenth.csv");
  const std::string found =
      run(fmt::format("cd '{}' && '{}' diagnose '{}' --params '{}' --log every_tenth.csv --out diagnosis "
                      "--effects creep,lag,delay,backlash,even_nonlinearity,thermal_drift",
                      folder.string(), HYSTERON_TOOL, file("plant.st"), file("stage.toml")));
  fmt::print("{}", summary_of(found));
  draw("08_served_stage/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
