#include "tool/run_batch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/median.hpp"
#include "support/numbers.hpp"
#include "support/progress.hpp"
#include "tool/batch_program.hpp"
#include "tool/commands.hpp"
#include "tool/option_values.hpp"
#include "tool/record_options.hpp"
#include "tuning/recorded_run.hpp"

namespace hysteron::tool {
namespace {

/// A figure of an output that the table has a column for.
struct FigureColumn {
  std::string_view name;
  double OutputFigures::*value;
};
constexpr FigureColumn figure_columns[] = {{"MIN", &OutputFigures::least},
                                           {"MAX", &OutputFigures::most},
                                           {"LAST", &OutputFigures::last},
                                           {"RMS", &OutputFigures::rms},
                                           {"RMSE", &OutputFigures::rmse}};

/// The columns of an output: the last one is only there where the record has the output's column.
std::span<const FigureColumn> columns_of(const Signal* measured) {
  return {figure_columns, std::size(figure_columns) - (measured == nullptr ? 1 : 0)};
}

std::string table_text(const BatchRequest& request, const BatchResult& result) {
  const Graph& graph = request.program->graph;
  std::string text = "set";
  for (const std::string& path : request.sets->paths) {
    text += "," + path;
  }
  for (std::size_t o = 0; o < graph.outputs.size(); ++o) {
    for (const FigureColumn& column : columns_of(request.measured[o])) {
      text += fmt::format(",{}.{}", graph.outputs[o].name, column.name);
    }
  }
  text += "\n";
  for (std::size_t i = 0; i < result.size(); ++i) {
    text += std::to_string(i + 1);
    for (const double value : request.sets->rows[i]) {
      text += "," + number_text(value);
    }
    for (std::size_t o = 0; o < graph.outputs.size(); ++o) {
      for (const FigureColumn& column : columns_of(request.measured[o])) {
        text += "," + number_text(result[i][o].*column.value);
      }
    }
    text += "\n";
  }
  return text;
}

/// Quantiles of each figure over the sets, and the set that is nearest to the record.
std::string summary_text(const BatchRequest& request, const BatchResult& result, std::string_view how) {
  const Graph& graph = request.program->graph;
  std::string text =
      fmt::format("{}: {} set{} of {}, {} steps each, {}\n", graph.name, result.size(), result.size() == 1 ? "" : "s",
                  fmt::join(request.sets->paths, ", "), request.drive->steps, how);
  text += fmt::format("{:<20} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "output", "least", "5 %", "median", "95 %",
                      "greatest");
  for (std::size_t o = 0; o < graph.outputs.size(); ++o) {
    for (const FigureColumn& column : columns_of(request.measured[o])) {
      std::vector<double> values;
      for (const auto& set : result) {
        if (std::isfinite(set[o].*column.value)) {
          values.push_back(set[o].*column.value);
        }
      }
      const auto at = [&](double share) { return fmt::format("{:.6g}", quantile(values, share)); };
      const std::string name = fmt::format("{} {}", graph.outputs[o].name, column.name);
      text += values.empty() ? fmt::format("{:<20} {:>12}\n", name, "not finite")
                             : fmt::format("{:<20} {:>12} {:>12} {:>12} {:>12} {:>12}\n", name,
                                           fmt::format("{:.6g}", std::ranges::min(values)), at(0.05), at(0.5), at(0.95),
                                           fmt::format("{:.6g}", std::ranges::max(values)));
    }
    if (request.measured[o] != nullptr) {
      const auto [low, high] = std::ranges::minmax_element(result, {}, [&](const auto& set) { return set[o].rmse; });
      if (result.size() > 1 && (*low)[o].rmse == (*high)[o].rmse) {
        text += fmt::format("{} is the same in all sets\n", graph.outputs[o].name);
        continue;
      }
      const auto best = std::ranges::min_element(
          result, {}, [&](const auto& set) { return std::isfinite(set[o].rmse) ? set[o].rmse : infinity; });
      text += fmt::format("nearest to the record in {}: set {}", graph.outputs[o].name, best - result.begin() + 1);
      const auto& row = request.sets->rows[static_cast<std::size_t>(best - result.begin())];
      for (std::size_t k = 0; k < row.size(); ++k) {
        text += fmt::format(", {} = {}", request.sets->paths[k], number_text(row[k]));
      }
      text += "\n";
    }
  }
  return text;
}

std::size_t sets_not_finite(const BatchResult& result) {
  return static_cast<std::size_t>(std::ranges::count_if(result, [](const auto& set) {
    return std::ranges::any_of(set, [](const OutputFigures& one) {
      return !std::isfinite(one.rms) || !std::isfinite(one.least) || !std::isfinite(one.most);
    });
  }));
}

bool can_compile(const Graph& graph, bool float32) {
  return !float32 && has_compiler() && std::ranges::none_of(graph.nodes, [](const Node& node) {
    return node.block != nullptr && node.block->fmu != nullptr;
  });
}

}  // namespace

void add_batch_options(CLI::App& app, BatchOptions& options) {
  app.add_option("--batch", options.sets.file,
                 "Runs a set of parameters for each row of a table: INV.C1,INV.C2 in its head.")
      ->option_text("SETS.csv");
  app.add_option("--sweep", options.sets.sweeps,
                 "Runs a set for each of some values of a parameter: INV.C1=0.1..0.3/21; several make a grid.")
      ->option_text("PARAMETER=LOW..HIGH/COUNT")
      ->allow_extra_args(false);
  app.add_option("--draw", options.sets.draws,
                 "Runs sets with a random value of a parameter: 'INV.C1=normal(0.2,0.01)' or uniform(0.1,0.3); may be "
                 "repeated.")
      ->option_text("PARAMETER=DISTRIBUTION")
      ->allow_extra_args(false);
  app.add_option("--sets", options.sets.count, "How many sets are drawn.")
      ->option_text("N")
      ->check(whole_number_from(1));
  app.add_option("--seed", options.sets.seed, "Of draws; 1 where none is given.")
      ->option_text("N")
      ->check(whole_number_from(0));
  app.add_option("--engine", options.engine,
                 "Of many sets: interpreter, or compiled; where none is given, whichever is done sooner.")
      ->check(CLI::IsMember({"interpreter", "compiled"}))
      ->option_text("interpreter|compiled");
  options.threads = std::max(1U, std::thread::hardware_concurrency());
  app.add_option("--threads", options.threads, "How many sets run at the same time.")
      ->option_text("N")
      ->check(whole_number_from(1));
  app.add_flag("--fast", options.fast,
               "Of many sets, compiled: exp, log, pow and the like in vectors, within 4 units in the last place.");
}

void check_batch_options(const BatchOptions& options, bool traces, bool plot) {
  const auto refuse = [](std::string cause, std::string mend) {
    throw InputError(error::bad_usage, {}, std::move(cause), std::move(mend));
  };
  if (!options.wanted()) {
    if (options.sets.count || !options.engine.empty() || options.fast) {
      refuse("--sets, --engine and --fast are for many sets of parameters.",
             "write --batch SETS.csv, --sweep or --draw beside it.");
    }
    return;
  }
  if (traces || plot) {
    refuse(fmt::format("{} is for a run with one set of parameters.", traces ? "--trace" : "--plot"),
           "leave it out; hysteron plot draws columns of the table.");
  }
  if (options.fast && options.engine == "interpreter") {
    refuse("The interpreter has no vectors.", "leave out --fast, or write --engine compiled.");
  }
}

int run_batch(const BatchOptions& options, Program program, records::Record& record, const BatchOutput& output,
              Diagnostics& diagnostics, Console& console) {
  const Drive drive = drive_of(program, record, diagnostics);
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  const ParameterSets sets = parameter_sets(options.sets, program.graph);
  BatchRequest request{
      .program = &program, .drive = &drive, .sets = &sets, .threads = options.threads, .fast = options.fast};
  for (const Port& one : program.graph.outputs) {
    const records::Column* const column = record.find(one.name);
    request.measured.push_back(column != nullptr ? &column->values : nullptr);
  }
  const bool compiled = options.engine.empty()
                            ? can_compile(program.graph, output.float32) && (options.fast || worth_compiling(request))
                            : options.engine == "compiled";
  if (compiled && output.float32) {
    throw InputError(error::bad_usage, {}, "A compiled batch computes in 64 bits.",
                     "leave out --float32, or write --engine interpreter.");
  }
  Progress progress("Running");
  request.progress = [&](double fraction) { progress.update(fraction); };
  const BatchResult result = compiled ? run_compiled_batch(request) : run_interpreted_batch(request, output.float32);
  progress.finish();
  const std::string text = table_text(request, result);
  if (output.output == "-") {
    console.print(text);
  } else {
    write_file_atomically(output.output, text);
  }
  if (const std::size_t bad = sets_not_finite(result); bad > 0) {
    diagnostics.error(
        error::output_not_finite, {.file = output.output},
        fmt::format("An output of {} of {} sets is not a finite number in some step.", bad, sets.size()),
        "run one of them alone, without --batch: the step is told, and --trace shows the signals inside.");
  }
  console.report(diagnostics);
  say_what_was_read(record, program, true);
  if (output.output != "-") {
    console.print(summary_text(request, result,
                               !compiled      ? "interpreted"
                               : options.fast ? "eight at a time, in vectors"
                                              : "eight at a time"));
  }
  return diagnostics.has_errors() ? exit_findings : exit_ok;
}

}  // namespace hysteron::tool
