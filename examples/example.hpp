// What the examples share: a diagram run by name, the folder for results, and pictures by gnuplot.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/interpreter/machine.hpp"
#include "records/csv.hpp"

namespace hysteron::examples {

/// A file of the examples: path_of("01_memory_element/memory_element.st").
[[nodiscard]] std::filesystem::path path_of(std::string_view file);

/// A parameter of a diagram, by its path: {"HYST.C1", 2.45e-9}.
struct Setting {
  std::string path{};
  double value = 0.0;
};

/// A diagram in the interpreter, its inputs and outputs by name without regard to case.
class Diagram {
 public:
  /// The sample time, in seconds, is for a diagram that states none. Throws InputError where the text is wrong,
  /// std::invalid_argument where there is no such parameter.
  explicit Diagram(std::string_view file, std::span<const Setting> settings = {}, double sample_time = 0.0);

  void set(std::string_view input, double value);
  void step() noexcept { machine_.step(); }
  [[nodiscard]] double get(std::string_view output) const;
  [[nodiscard]] double sample_time() const { return machine_.sample_time(); }

  /// Runs as many steps as the record of the inputs has rows. Gives its columns and those of the outputs.
  records::Record run(const records::Record& inputs);
  /// Runs a diagram without inputs, from t = 0.
  records::Record run(std::size_t steps);

 private:
  Machine<double> machine_;
};

/// A column's values; throws InputError where there is none of that name.
[[nodiscard]] std::span<const double> column(const records::Record& record, std::string_view name);

/// √(mean of squares)
[[nodiscard]] double rms(std::span<const double> values);
/// Largest minus smallest.
[[nodiscard]] double range(std::span<const double> values);

/// Writes columns that are no record over time, as CSV with one header row.
void write_table(const std::filesystem::path& path, std::span<const records::Column> columns);

/// Runs the gnuplot script of an example on the CSV files in a folder; the script finds the folder in ARG1 and leaves
/// its pictures there. Says so on the terminal, and gives false, where gnuplot is missing or fails.
bool draw(std::string_view script, const std::filesystem::path& folder);

/// The main function of an example. Makes the folder for results, which is the first argument, or `out`; prints an
/// InputError as the tool does. Gives the exit code.
int run_example(int argc, char** argv, const std::function<void(const std::filesystem::path& folder)>& body);

}  // namespace hysteron::examples
