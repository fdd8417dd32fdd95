#include "examples/06_piezo_diagnosis/rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/parameters/apply.hpp"
#include "diagnosis/effects/set_words.hpp"
#include "examples/example.hpp"
#include "support/atomic_file.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::examples {

std::string Round::effect() const {
  return named() ? fmt::format("{} at {}", found.effects.front().id, found.effects.front().edge) : std::string();
}

std::vector<std::string> Round::rivals() const {
  std::vector<std::string> names;
  for (const diagnosis::Rival& rival : found.rivals) {
    std::string name = diagnosis::words_of_set(rival.effects);
    // The same effects may stand on several edges.
    if (rival.effects != std::vector{found.effects.front().id} && std::ranges::find(names, name) == names.end()) {
      names.push_back(std::move(name));
    }
  }
  return names;
}

Round tuned_model(const std::string& diagram, const std::string& settings, const records::Record& record) {
  Diagnostics warnings;
  Round round{.program = compile_file(path_of(diagram).string(), {}, warnings),
              .file = parameters::read_parameter_file(path_of(settings).string())};
  const OutputErrorProblem problem = output_error_problem(round.program, round.file, std::span(&record, 1));
  round.file = tuned_file(round.file, problem, fit_output_error(problem));
  return round;
}

Round next_round(const Round& before, const records::Record& record, const std::vector<std::string>& effects,
                 const std::filesystem::path& folder) {
  Round round{.file = before.file};
  round.found = diagnosis::diagnose(
      {.program = before.program, .text = *before.program.graph.source->text, .file = before.file, .records = {record}},
      {.effects = effects, .most_effects = 1, .effort = 15.0});
  round.program = compile_text(round.found.improved_text, {.any_order = true});
  round.file = round.found.improved_file;
  std::filesystem::create_directories(folder);
  write_file_atomically(folder / "improved.st", round.found.improved_text);
  write_file_atomically(folder / "improved.toml", parameters::parameter_text(round.file, {}, round.found.summary));
  return round;
}

std::vector<std::vector<double>> residuals_of(const Round& round, const records::Record& record) {
  Program program = round.program;
  parameters::apply(round.file, program.graph);
  std::vector<std::vector<double>> residuals = simulate(program, record);
  for (std::size_t output = 0; output < residuals.size(); ++output) {
    const std::vector<double>& measured = record.column(program.graph.outputs[output].name).values;
    for (std::size_t k = 0; k < measured.size(); ++k) {
      residuals[output][k] -= measured[k];
    }
  }
  return residuals;
}

}  // namespace hysteron::examples
