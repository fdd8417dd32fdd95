#include "examples/example.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "support/atomic_file.hpp"
#include "support/numbers.hpp"
#include "support/render.hpp"

namespace hysteron::examples {
namespace {

Program compiled(std::string_view file) {
  Diagnostics warnings;
  return compile_file(path_of(file).string(), {}, warnings);
}

std::size_t index_of(const std::vector<Port>& ports, std::string_view name) {
  const auto port = std::ranges::find_if(ports, [&](const Port& p) { return language::same_name(p.name, name); });
  if (port == ports.end()) {
    throw std::invalid_argument(fmt::format("the diagram has no input or output {}", name));
  }
  return static_cast<std::size_t>(port - ports.begin());
}

}  // namespace

std::filesystem::path path_of(std::string_view file) {
  return std::filesystem::path(HYSTERON_EXAMPLES) / file;
}

Diagram::Diagram(std::string_view file, std::span<const Setting> settings, double sample_time)
    : machine_(compiled(file), sample_time) {
  for (const Setting& setting : settings) {
    const std::int64_t parameter = find_parameter(machine_.program().graph, setting.path);
    if (parameter < 0) {
      throw std::invalid_argument(fmt::format("{} has no parameter {}", file, setting.path));
    }
    machine_.set_parameter(static_cast<std::size_t>(parameter), setting.value);
  }
  machine_.reset();
}

void Diagram::set(std::string_view input, double value) {
  machine_.set_input(index_of(machine_.program().graph.inputs, input), value);
}

double Diagram::get(std::string_view output) const {
  return machine_.output(index_of(machine_.program().graph.outputs, output));
}

records::Record Diagram::run(const records::Record& inputs) {
  const Graph& graph = machine_.program().graph;
  std::vector<std::span<const double>> in;
  for (const Port& port : graph.inputs) {
    in.push_back(column(inputs, port.name));
  }
  std::vector<records::Column> out;
  for (const Port& port : graph.outputs) {
    out.push_back({.name = port.name, .unit = port.unit, .values = std::vector<double>(inputs.size())});
  }
  machine_.reset();
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      machine_.set_input(i, in[i][k]);
    }
    machine_.step();
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].values[k] = machine_.output(i);
    }
  }
  records::Record record = inputs;
  for (records::Column& values : out) {
    record.add(std::move(values));
  }
  return record;
}

records::Record Diagram::run(std::size_t steps) {
  return run(records::Record::even(0.0, sample_time(), steps));
}

std::span<const double> column(const records::Record& record, std::string_view name) {
  return record.column(name).values;
}

double rms(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value * value;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double range(std::span<const double> values) {
  const auto [least, largest] = std::ranges::minmax(values);
  return largest - least;
}

void write_table(const std::filesystem::path& path, std::span<const records::Column> columns) {
  std::string text;
  const auto append = [&](std::size_t column, std::string_view cell) {
    text += cell;
    text += column + 1 < columns.size() ? ',' : '\n';
  };
  for (std::size_t i = 0; i < columns.size(); ++i) {
    append(i, columns[i].name);
  }
  for (std::size_t row = 0; row < columns.front().values.size(); ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      append(i, number_text(columns[i].values[row]));
    }
  }
  write_file_atomically(path, text);
}

bool draw(std::string_view script, const std::filesystem::path& folder) {
  std::array<std::string, 4> words{"gnuplot", "-c", path_of(script).string(), folder.string()};
  std::array<char*, 5> arguments{words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  pid_t process = 0;
  if (::posix_spawnp(&process, "gnuplot", nullptr, nullptr, arguments.data(), environ) != 0) {
    fmt::print("No picture: gnuplot is not installed (Debian: apt install gnuplot-nox).\n");
    return false;
  }
  int status = 0;
  ::waitpid(process, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    fmt::print("No picture: gnuplot could not run {}.\n", words[2]);
    return false;
  }
  return true;
}

int run_example(int argc, char** argv, const std::function<void(const std::filesystem::path&)>& body) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  if (argc > 2) {
    fmt::print(stderr, "usage: {} [FOLDER]   writes its records and pictures into FOLDER, or into out\n", arguments[0]);
    return 2;
  }
  try {
    const std::filesystem::path folder = argc == 2 ? arguments[1] : "out";
    std::filesystem::create_directories(folder);
    body(folder);
    fmt::print("Records and pictures: {}\n", folder.string());
    return 0;
  } catch (const InputError& error) {
    Sources sources;
    fmt::print(stderr, "{}", as_text(error.diagnostics(), sources));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
  }
  return 1;
}

}  // namespace hysteron::examples
