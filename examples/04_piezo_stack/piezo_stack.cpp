#include "examples/04_piezo_stack/piezo_stack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <stdexcept>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/parameters/apply.hpp"
#include "examples/example.hpp"
#include "records/csv.hpp"
#include "records/data_folder.hpp"
#include "records/read.hpp"
#include "support/atomic_file.hpp"
#include "support/names.hpp"

namespace hysteron::examples {
namespace {

std::string file_of(std::string_view name, std::string_view ending) {
  return path_of(fmt::format("04_piezo_stack/{}.{}", name, ending)).string();
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void set(Graph& graph, std::string_view path, double value) {
  const std::int64_t found = find_parameter(graph, path);
  if (found >= 0) {
    graph.parameters[static_cast<std::size_t>(found)].value = {value};
  }
}

}  // namespace

std::optional<records::Record> stack_record(std::string_view file) {
  const auto path = records::find_record(fmt::format("piezo-picma-dbo/{}", file), path_of("..").lexically_normal());
  return path ? std::optional(records::read_record(path->string())) : std::nullopt;
}

double TunedDiagram::train_share() const {
  return fit.scores.front().train / fit.scores.front().range;
}

double TunedDiagram::test_share() const {
  return fit.scores.front().test / fit.scores.front().test_range;
}

double TunedDiagram::parameter(std::string_view path) const {
  const std::int64_t found = find_parameter(program.graph, path);
  if (found < 0) {
    throw std::invalid_argument(fmt::format("the diagram has no parameter {}", path));
  }
  return program.graph.parameters[static_cast<std::size_t>(found)].value.front();
}

TunedDiagram tune(std::string_view name, std::string_view settings, const records::Record& record) {
  Diagnostics warnings;
  TunedDiagram tuned{.program = compile_file(file_of(name, "st"), {}, warnings)};
  const auto file = parameters::read_parameter_file(file_of(settings, "toml"));
  tuned.problem = output_error_problem(tuned.program, file, std::span(&record, 1));
  tuned.fit = fit_output_error(tuned.problem);
  parameters::apply(tuned_file(file, tuned.problem, tuned.fit), tuned.program.graph);
  return tuned;
}

Program feedforward_of(std::string_view name, const TunedDiagram& plant) {
  Diagnostics warnings;
  Program program = compile_file(file_of(name, "st"), {}, warnings);
  for (const Parameter& parameter : plant.program.graph.parameters) {
    set(program.graph, parameter.path, parameter.value.front());
  }
  const Signal& y = plant.fit.model.front().front();
  const records::RowRange rows = plant.problem.experiments.front().train.front();
  const auto [least, largest] = std::minmax_element(y.begin() + static_cast<std::ptrdiff_t>(rows.first),
                                                    y.begin() + static_cast<std::ptrdiff_t>(rows.last));
  set(program.graph, "BIAS", 0.5 * (*least + *largest));
  return program;
}

std::vector<double> tracking_errors(const std::vector<double>& ref, const std::vector<double>& y, std::size_t row) {
  const std::size_t first = row - 1;
  const double mean = mean_of(std::span(y).subspan(first + 1, window));
  std::vector<double> errors;
  for (std::size_t k = first; k < first + window; ++k) {
    errors.push_back(y[k + 1] - mean - ref[k]);
  }
  return errors;
}

double tracking_error(const std::vector<double>& ref, const std::vector<double>& y, std::size_t row) {
  return rms(tracking_errors(ref, y, row));
}

std::vector<double> run_generated(const Program& program, const records::Record& record,
                                  const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const GeneratedFile& file : generate_cpp(program)) {
    write_file_atomically(folder / file.name, file.text);
  }
  records::write_csv(folder / "in.csv", record);
  const std::string place = folder.string();
  if (place.find('\'') != std::string::npos) {
    throw std::runtime_error("a folder for generated code must not have a quote in its name");
  }
  const char* const chosen = std::getenv("CXX");
  const std::string command = fmt::format("cd '{}' && {} -std=c++20 -O2 {} main.cpp -o run && ./run < in.csv > out.csv",
                                          place, chosen == nullptr ? "c++" : chosen, cpp_numeric_flags);
  if (std::system(command.c_str()) != 0) {
    throw std::runtime_error("the generated code could not be compiled and run: " + command);
  }
  const records::Record out = records::read_record((folder / "out.csv").string());
  return out.column(program.graph.outputs.front().name).values;
}

Prediction predict(const Program& judge, const std::vector<double>& u, const records::Record& record) {
  records::Record driven = records::Record::even(record.time().front(), record.sample_time(), record.size());
  driven.add({.name = "U", .unit = "V", .values = u});
  Prediction prediction{.u = u, .y = simulate(judge, driven).front()};
  const std::vector<double>& ref = record.column("ref").values;
  prediction.without_inverse = tracking_error(ref, prediction.y, row_without_inverse);
  prediction.with_inverse = tracking_error(ref, prediction.y, row_with_inverse);
  return prediction;
}

double difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t row) {
  std::vector<double> left;
  for (std::size_t k = row - 1; k < a.size(); ++k) {
    left.push_back(a[k] - b[k]);
  }
  const double mean = mean_of(left);
  for (double& value : left) {
    value -= mean;
  }
  return rms(left);
}

}  // namespace hysteron::examples
