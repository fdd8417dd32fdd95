#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "codegen/program_hash.hpp"
#include "plots/thinned.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/progress.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/compiled.hpp"
#include "tool/diagram.hpp"
#include "tool/picture_file.hpp"
#include "tool/test_bench.hpp"
#include "tool/test_judge.hpp"
#include "tool/test_plan.hpp"
#include "tool/test_report.hpp"
#include "tool/writable.hpp"
#include "tuning/float32_run.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view test_examples = R"(Examples:
  hysteron test feedforward.st              runs feedforward.test.toml
  hysteron test src/*.st --junit tests.xml
  hysteron test feedforward.st --filter dwell --no-generated
  hysteron test feedforward.st --plot cases.html
  hysteron test feedforward.st --update     writes the golden records that cases name
  hysteron test feedforward.st --bench plc  writes the tests in Structured Text, for the PLC

A test file:
  [[case]]
  name = "a step passes the gain"
  steps = 10
  params = {AMP = {K = 2.0}}                over those of the diagram, or a file: "tuned.toml"
  inputs = {X = {0 = 0.0, 5 = 1.0}}         by step; or 1.0, [0.0, 1.0], {from = 0.0, to = 1.0}
  expect = {Y = {4 = 0.0, 5 = 2.0}}         by step; or 2.0, [0.0, 2.0]
  abs = 1e-12                               |got - expected| <= abs + rel*|expected|
  rel = 1e-9
Other keys: block = "NAME", csv = "log.csv" for inputs, golden = "NAME.csv", float32 = true, doc = "why".

--bench: one text with the block, a block NAME_TEST that runs one step of a test in each cycle, and a program that shows
test, step, output, expected and got of what failed first. Its dialects: portable, codesys, twincat, siemens-scl.

Each case is run by the interpreter and as generated C++ (compiler: CXX, else c++); their bits must be equal.
Exit codes: 0 all cases passed; 1 some failed; 2 a diagram or test file has errors, or there is nothing to run.
)";

struct TestOptions {
  std::vector<std::string> diagrams;
  std::string tests;
  std::string junit;
  std::string filter;
  bool update = false;
  bool no_generated = false;
  std::string plot;
  std::string bench;
  std::string dialect;
};

std::string test_file_of(const std::string& diagram) {
  return fs::path(diagram).replace_extension(".test.toml").string();
}

bool selected(const TestCase& test, const std::string& filter) {
  return in_capitals(test.name).find(in_capitals(filter)) != std::string::npos;
}

/// Programs that several cases share are compiled once.
class GeneratedPrograms {
 public:
  explicit GeneratedPrograms(const std::vector<PlannedCase>& cases) {
    std::vector<GeneratedProgram> programs;
    std::map<std::string, std::size_t> known;
    for (const PlannedCase& planned : cases) {
      const auto key = program_hash(planned.program) + (planned.test.float32 ? " float" : "");
      const auto [found, fresh] = known.emplace(key, programs.size());
      if (fresh) {
        programs.push_back({.program = &planned.program, .float32 = planned.test.float32});
      }
      indexes_.push_back(found->second);
    }
    compiled_.emplace(programs);
  }

  [[nodiscard]] std::vector<Signal> run(std::size_t number, const PlannedCase& planned) const {
    return compiled_->run(indexes_[number], planned.drive);
  }

 private:
  std::vector<std::size_t> indexes_;
  std::optional<CompiledPrograms> compiled_;
};

void append(std::vector<Failure>& failures, std::vector<Failure> more) {
  std::move(more.begin(), more.end(), std::back_inserter(failures));
}

/// What was expected of each output and what came, and the inputs that made it.
plots::Figure figure_of(const PlannedCase& planned, const std::vector<Signal>& outputs) {
  const Graph& graph = planned.program.graph;
  plots::Figure figure{.title = planned.test.name};
  const auto panel = [&](const Port& port, const Signal& values) {
    return plots::FigurePanel{
        .title = port.name,
        .x_label = "t [s]",
        .y_label = plots::axis_label(port.name, port.unit),
        .curves = {{.name = "got",
                    .x = planned.time,
                    .y = values,
                    .stroke = port.type == Type::Real && !plots::is_of_steps(values) ? plots::Stroke::Line
                                                                                     : plots::Stroke::Steps}}};
  };
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    if (planned.drive.inputs[i].size() == planned.time.size()) {
      figure.panels.push_back(panel(graph.inputs[i], planned.drive.inputs[i]));
      figure.panels.back().curves.front().name = "input";
      figure.panels.back().curves.front().colour = 2;
    }
  }
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    figure.panels.push_back(panel(graph.outputs[i], outputs[i]));
    for (const ExpectedOutput& expected : planned.expected) {
      if (expected.output != i) {
        continue;
      }
      plots::Curve curve{.name = "expected", .stroke = plots::Stroke::Dots, .colour = 1};
      for (const auto& [step, value] : expected.values) {
        curve.x.push_back(planned.time[step]);
        curve.y.push_back(value);
      }
      figure.panels.back().curves.push_back(std::move(curve));
    }
  }
  return figure;
}

/// One case by the interpreter and, where there is one, as a generated program.
CaseResult run_case(std::size_t number, const PlannedCase& planned, const GeneratedPrograms* generated, bool update,
                    bool draw) {
  const auto begun = std::chrono::steady_clock::now();
  CaseResult result{.name = planned.test.name};
  const auto outputs =
      interpret(planned.program, planned.drive, output_wires(planned.program.graph), planned.test.float32);
  if (draw) {
    result.figure = figure_of(planned, outputs);
  }
  append(result.failures, judge(planned, outputs));
  if (generated != nullptr) {
    append(result.failures, judge_bits(planned, outputs, generated->run(number, planned)));
  }
  if (!planned.golden.empty() && update && result.failures.empty()) {
    const auto text = golden_text(planned, outputs);
    std::error_code unknown;
    if (!fs::exists(planned.golden, unknown) || read_text_file(planned.golden.string()) != text) {
      write_file_atomically(planned.golden, text);
      result.note = "wrote " + planned.golden.string();
    }
  } else if (!planned.golden.empty() && !update) {
    std::vector<std::string> notes;
    append(result.failures, judge_golden(planned, outputs, notes));
    for (const std::string& note : notes) {
      Console::note(planned.golden.string(), note);
    }
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

/// The files that a test file names, and what else its cases are made from.
std::vector<InputFile> inputs_of(const std::string& diagram, const std::string& tests, const TestFile& file,
                                 bool with_golden) {
  std::vector<InputFile> inputs{{.file = diagram}, {.file = tests}};
  for (const TestCase& test : file.cases) {
    for (const TestText* named : {&test.csv, &test.parameter_file, &test.golden}) {
      if (!named->text.empty() && (with_golden || named != &test.golden)) {
        inputs.push_back({.file = (fs::path(tests).parent_path() / named->text).string(), .named_by = tests});
      }
    }
  }
  return inputs;
}

/// Golden records are written over nothing that a case is made from, and each by one case alone.
void refuse_to_overwrite(const std::vector<PlannedCase>& cases, const std::vector<InputFile>& inputs) {
  std::map<fs::path, const PlannedCase*> written;
  for (const PlannedCase& planned : cases) {
    if (planned.golden.empty()) {
      continue;
    }
    hysteron::refuse_to_overwrite({.file = planned.golden.string(), .place = planned.test.golden.place}, inputs);
    const auto [first, is_new] = written.emplace(planned.golden.lexically_normal(), &planned);
    if (!is_new) {
      throw InputError(error::overwrites_input, planned.test.golden.place,
                       fmt::format("The cases \"{}\" and \"{}\" would both write {}.", first->second->test.name,
                                   planned.test.name, planned.golden.string()),
                       "give each case a golden record of its own, or update one of them by --filter.");
    }
  }
}

/// The files that a run reads. A test file that cannot be read is reported later.
std::vector<InputFile> inputs_of(const TestOptions& options) {
  std::vector<InputFile> inputs;
  for (const std::string& diagram : options.diagrams) {
    const std::string tests = options.tests.empty() ? test_file_of(diagram) : options.tests;
    TestFile file;
    try {
      file = read_test_file(tests);
    } catch (const InputError&) {
      file = {};
    }
    std::ranges::move(inputs_of(diagram, tests, file, true), std::back_inserter(inputs));
  }
  return inputs;
}

StDialect bench_dialect(const TestOptions& options) {
  const std::string& name = options.dialect.empty() ? std::string("portable") : options.dialect;
  const auto dialect = st_dialect(name);
  if (!dialect) {
    throw InputError(error::bad_usage, {}, fmt::format("There is no dialect {}.", name),
                     fmt::format("the dialects are: {}.", st_dialect_names()));
  }
  return *dialect;
}

/// The bench of one file, to be written with those of the others.
void add_bench(const std::string& diagram, const std::vector<InputFile>& inputs, const std::vector<PlannedCase>& cases,
               const TestOptions& options, std::vector<OutputFile>& files) {
  for (const GeneratedFile& file : bench_files(diagram, cases, bench_dialect(options))) {
    OutputFile made{.path = fs::path(options.bench) / file.name, .contents = file.text};
    hysteron::refuse_to_overwrite({.file = made.path.string(), .mend = "give another folder for --bench."}, inputs);
    refuse_foreign_file(made.path, made.contents, "choose another folder with --bench.");
    const auto same = std::ranges::find(files, made.path, &OutputFile::path);
    if (same != files.end() && same->contents != made.contents) {
      throw InputError(error::bad_usage, {}, fmt::format("Two diagrams would both write {}.", made.path.string()),
                       "write their benches one by one, into a folder each.");
    }
    if (same == files.end()) {
      files.push_back(std::move(made));
    }
  }
}

/// The cases of one file that the filter selects.
FileResult run_file(const std::string& diagram, const std::string& tests, const TestOptions& options,
                    std::vector<OutputFile>& bench, Console& console) {
  FileResult result{.file = tests, .cases = {}};
  TestFile file = read_test_file(tests);
  TestPlanner planner(diagram, fs::path(tests).parent_path());
  Diagnostics diagnostics;
  std::vector<PlannedCase> cases;
  for (const TestCase& test : file.cases) {
    if (selected(test, options.filter)) {
      cases.push_back(planner.plan(test, diagnostics));
    }
  }
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  if (options.update) {
    refuse_to_overwrite(cases, inputs_of(diagram, tests, file, false));
  }
  console.report(diagnostics);
  std::set<std::pair<std::string, std::string>> said;  // of a record that several cases take, once
  for (const PlannedCase& planned : cases) {
    for (const auto& note : planned.notes) {
      if (said.insert(note).second) {
        Console::note(note.first, note.second);
      }
    }
  }
  std::optional<GeneratedPrograms> generated;
  Progress progress("Testing");
  if (!options.no_generated && !cases.empty()) {
    progress.update(0.0, "compiling " + tests);
    generated.emplace(cases);
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(cases.size()), cases[i].test.name);
    result.cases.push_back(
        run_case(i, cases[i], generated ? &*generated : nullptr, options.update, !options.plot.empty()));
  }
  if (!options.bench.empty() && !cases.empty()) {
    add_bench(diagram, inputs_of(diagram, tests, file, true), cases, options, bench);
  }
  return result;
}

/// A figure a case; of one that failed, its title says so.
std::vector<plots::Figure> figures_of(const std::vector<FileResult>& results) {
  std::vector<plots::Figure> figures;
  for (const FileResult& result : results) {
    for (const CaseResult& one : result.cases) {
      if (one.figure) {
        figures.push_back(*one.figure);
        figures.back().title = fmt::format("{}: {}{}", result.file, one.name, one.failures.empty() ? "" : " (failed)");
      }
    }
  }
  return figures;
}

std::string existing_test_file(const std::string& diagram, const TestOptions& options) {
  auto tests = options.tests.empty() ? test_file_of(diagram) : options.tests;
  std::error_code unknown;
  if (!fs::exists(tests, unknown)) {
    throw InputError(error::missing_test_file, {.file = diagram},
                     fmt::format("The test file {} does not exist.", tests),
                     "write one: `hysteron test --help` shows its form; --tests names one that stands elsewhere.");
  }
  return tests;
}

int run_tests(const TestOptions& options, Console& console) {
  if (!options.tests.empty() && options.diagrams.size() > 1) {
    throw InputError(error::bad_usage, {}, "--tests names the test file of one diagram, here are several.",
                     "give one diagram, or leave --tests out.");
  }
  if (!options.junit.empty()) {
    hysteron::refuse_to_overwrite({.file = options.junit}, inputs_of(options));
  }
  if (!options.plot.empty()) {
    std::vector<InputFile> inputs = inputs_of(options);
    inputs.push_back({.file = options.junit, .named_by = "--junit"});
    refuse_unfit_picture(options.plot, "--plot", inputs);
  }
  if (options.bench.empty() && !options.dialect.empty()) {
    throw InputError(error::bad_usage, {}, "A dialect is one of the bench, and none is asked for.",
                     "write --bench DIR, or leave out --dialect.");
  }
  if (!options.bench.empty()) {
    (void)bench_dialect(options);
    refuse_unwritable_folder(options.bench);
  }
  Diagnostics refused;
  std::vector<FileResult> results;
  std::vector<OutputFile> bench;
  std::size_t cases = 0;
  for (const std::string& diagram : options.diagrams) {
    try {
      results.push_back(run_file(diagram, existing_test_file(diagram, options), options, bench, console));
      cases += results.back().cases.size();
      if (!results.back().cases.empty()) {
        console.print(report_text(results.back(), Console::colour()));
      }
    } catch (const InputError& error) {
      refused.add_all(error.diagnostics());
    }
  }
  if (!options.junit.empty()) {
    write_file_atomically(options.junit, junit_text(results));
  }
  if (!options.plot.empty() && cases > 0) {
    write_file_atomically(options.plot, picture_bytes(options.plot, "Tests", figures_of(results)));
  }
  write_files_atomically(bench);
  for (const OutputFile& file : bench) {
    console.print(file.path.string() + "\n");
  }
  if (cases > 0) {
    console.print(closing_line(results));
  }
  if (refused.has_errors()) {
    throw InputError(refused);
  }
  if (cases == 0) {
    throw InputError(error::no_test_selected, {}, fmt::format("No case has \"{}\" in its name.", options.filter),
                     "--filter takes a part of a name, without regard to case.");
  }
  return failed_cases(results) > 0 ? exit_findings : exit_ok;
}

}  // namespace

Action add_test(CLI::App& app) {
  const auto options = std::make_shared<TestOptions>();
  app.add_option("FILE", options->diagrams, "Diagrams; the tests of NAME.st stand in NAME.test.toml beside it.")
      ->required()
      ->option_text(" ");
  app.add_option("--tests", options->tests, "The test file, where it stands elsewhere.")->option_text("TESTS.toml");
  app.add_flag("--update", options->update, "Writes golden records instead of holding outputs against them.");
  app.add_option("--junit", options->junit, "Writes the results as JUnit XML, for a build server.")
      ->option_text("FILE.xml");
  app.add_option("--plot", options->plot, "Draws what each case expects and gets: .svg, .png, .html.")
      ->option_text("FILE");
  app.add_option("--bench", options->bench, "Writes the tests in Structured Text into a folder, to be run on the PLC.")
      ->option_text("DIR");
  app.add_option("--dialect", options->dialect, "Of the bench; portable where none is given.")->option_text("DIALECT");
  app.add_flag("--no-generated", options->no_generated, "Runs the interpreter alone; needs no compiler.");
  app.add_option("--filter", options->filter, "Runs only cases with this in their names.")->option_text("TEXT");
  app.footer(std::string(test_examples));
  return [options](Console& console) { return run_tests(*options, console); };
}

}  // namespace hysteron::tool
