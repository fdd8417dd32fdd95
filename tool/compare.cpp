#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "records/read.hpp"
#include "records/uneven_record.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/comparison.hpp"
#include "tool/file_kind.hpp"
#include "tool/picture_file.hpp"
#include "tool/record_figures.hpp"
#include "tool/record_options.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view compare_examples = R"(Examples:
  hysteron compare monday.csv friday.csv --abs 0.01 --plot apart.html
  hysteron compare p.toml tuned.toml
  hysteron compare plant.st improved.st
  hysteron compare before/verdict.json after/verdict.json --json

Two records are compared column by column at the times that both have, even or not; with --resample, at those of the
slower one. Parameter files are compared value by value; diagrams by
their blocks and wires, so that layout and comments are no difference; verdicts by what they say. What the files are is
found from them. Numbers a and b are the same where |b - a| <= abs + rel*|a|; without --abs and --rel, where they are
equal.
Exit codes: 0 the same; 1 different; 2 a file cannot be read, or the two are not of one kind.
)";

struct CompareOptions {
  std::string a;
  std::string b;
  Tolerance tolerance;
  std::string top;
  std::string parameters;
  std::string plot;
  RecordOptions record;
  bool json = false;
};

/// Two records at the times that they have; resampled, at those of the slower one, so that no row is made up.
std::vector<NamedRecord> records_of(const CompareOptions& options, Console& console) {
  const records::ReadOptions reading = read_options(with_settings_of(options.parameters, options.record));
  const std::string bytes_of_a = read_text_file(options.a);
  const std::string bytes_of_b = read_text_file(options.b);
  console.sources().put(options.a, bytes_of_a);
  console.sources().put(options.b, bytes_of_b);
  records::Record a = records::parse_as_recorded(options.a, bytes_of_a, reading);
  records::Record b = records::parse_as_recorded(options.b, bytes_of_b, reading);
  if (reading.resamples()) {
    const bool b_is_slower = b.sample_time() > a.sample_time();
    const records::Record& slower = b_is_slower ? b : a;
    records::ReadOptions same = reading;
    same.sample_time = slower.sample_time();
    same.origin = slower.time().front();
    if (b_is_slower) {
      a = records::parse_record(options.a, bytes_of_a, same);
    } else {
      b = records::parse_record(options.b, bytes_of_b, same);
    }
  }
  std::vector<NamedRecord> result;
  result.push_back({.name = options.a, .record = std::move(a)});
  result.push_back({.name = options.b, .record = std::move(b)});
  bring_to_one_unit(result);
  for (const NamedRecord& one : result) {
    for (const std::string& note : one.record.notes()) {
      Console::note(one.record.file(), note);
    }
  }
  return result;
}

Program program_of(const std::string& file, const CompareOptions& options) {
  Diagnostics warnings;
  return compile_file(file, {.top = options.top, .any_order = true}, warnings);
}

void refuse_plot_of(FileKind kind, const CompareOptions& options) {
  if (!options.plot.empty() && (kind == FileKind::Diagram || kind == FileKind::Verdict)) {
    throw InputError(error::bad_usage, {.file = options.a},
                     fmt::format("--plot draws records and parameter files; {} is {}.", options.a, words_of(kind)),
                     "leave --plot out.");
  }
}

/// The comparison, and what --plot draws of it.
Comparison compared(FileKind kind, const CompareOptions& options, std::vector<plots::Figure>& figures,
                    Console& console) {
  switch (kind) {
    case FileKind::Record: {
      const std::vector<NamedRecord> records = records_of(options, console);
      Comparison result = compare_records(records[0].record, records[1].record, options.tolerance);
      figures.push_back(figure_over_time(records));
      return result;
    }
    case FileKind::Parameters: {
      const std::vector<NamedParameters> files{{.name = options.a, .file = parameters::read_parameter_file(options.a)},
                                               {.name = options.b, .file = parameters::read_parameter_file(options.b)}};
      figures.push_back(figure_of_parameters(files));
      return compare_parameters(files[0].file, files[1].file, options.tolerance);
    }
    case FileKind::Diagram:
      return compare_diagrams(program_of(options.a, options), program_of(options.b, options));
    case FileKind::Verdict:
      break;
  }
  return compare_verdicts(options.a, options.b, options.tolerance);
}

int compare(const CompareOptions& options, Console& console) {
  if (options.tolerance.absolute < 0.0 || options.tolerance.relative < 0.0) {
    throw InputError(error::bad_usage, {}, "A tolerance is below 0.", "give --abs and --rel as 0 or more.");
  }
  const FileKind kind = kind_of_file(options.a);
  const FileKind other = kind_of_file(options.b);
  if (kind != other) {
    throw InputError(error::bad_usage, {.file = options.b},
                     fmt::format("{} is {}, and {} is {}.", options.a, words_of(kind), options.b, words_of(other)),
                     "give two files of one kind: records, parameter files, diagrams, or verdicts.");
  }
  refuse_plot_of(kind, options);
  if (!options.plot.empty()) {
    refuse_unfit_picture(options.plot, "--plot", {{.file = options.a}, {.file = options.b}});
  }
  std::vector<plots::Figure> figures;
  const Comparison result = compared(kind, options, figures, console);
  if (!options.plot.empty()) {
    write_file_atomically(options.plot,
                          picture_bytes(options.plot, fmt::format("{} and {}", options.a, options.b), figures));
  }
  const std::string same = kind == FileKind::Diagram ? "the same diagram" : "the same";
  if (options.json) {
    nlohmann::ordered_json json{{"a", options.a}, {"b", options.b}, {"kind", std::string(words_of(kind).substr(2))}};
    json["same"] = result.same;
    json.update(result.json);
    console.print(json.dump(2) + "\n");
  } else {
    console.print(fmt::format("A: {}\nB: {}\n{}{}\n", options.a, options.b, result.text,
                              result.same ? same : std::string("different")));
  }
  return result.same ? exit_ok : exit_findings;
}

}  // namespace

Action add_compare(CLI::App& app) {
  const auto options = std::make_shared<CompareOptions>();
  app.add_option("A", options->a, "A record, a parameter file, a diagram, or a verdict.json.")
      ->required()
      ->option_text(" ");
  app.add_option("B", options->b, "Another of the same kind.")->required()->option_text(" ");
  app.add_option("--abs", options->tolerance.absolute, "A difference that does not count.")->option_text("X");
  app.add_option("--rel", options->tolerance.relative, "The same as a share of the value in A.")->option_text("X");
  app.add_option("--top", options->top, "The block to take, where a diagram has several that no other contains.")
      ->option_text("NAME");
  app.add_option("--plot", options->plot, "Draws two records, or two parameter files: .svg, .png, .html.")
      ->option_text("FILE");
  add_record_options(app, options->record);
  app.add_option("--params", options->parameters, "Takes [record] of a parameter file, where no option says otherwise.")
      ->option_text("P.toml");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(compare_examples));
  return [options](Console& console) { return compare(*options, console); };
}

}  // namespace hysteron::tool
