#include "diagnosis/report/diagnosis_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "codegen/compile.hpp"
#include "codegen/graph/fmu_files.hpp"
#include "codegen/graph/port_t.hpp"
#include "diagnosis/report/page.hpp"
#include "diagnosis/report/verdict_json.hpp"
#include "records/csv.hpp"

namespace hysteron::diagnosis {
namespace {

/// One record for each signal and file: time, measured, nominal, calibrated, improved.
records::Record trace_record(const Trace& trace) {
  const std::size_t rows = trace.time.size();
  const double step = rows > 1 ? (trace.time.back() - trace.time.front()) / static_cast<double>(rows - 1) : 1.0;
  records::Record record = records::Record::even(trace.time.front(), step, rows);
  record.add({.name = trace.signal + "_measured", .unit = trace.unit, .values = trace.measured});
  record.add({.name = trace.signal + "_nominal", .unit = trace.unit, .values = trace.nominal});
  record.add({.name = trace.signal + "_calibrated", .unit = trace.unit, .values = trace.calibrated});
  record.add({.name = trace.signal + "_improved", .unit = trace.unit, .values = trace.improved});
  return record;
}

/// The command of the next experiment, ready to be played.
records::Record command_record(const NextExperiment& next) {
  const std::size_t rows = next.time.size();
  const double step = rows > 1 ? (next.time.back() - next.time.front()) / static_cast<double>(rows - 1) : 1.0;
  records::Record record = records::Record::even(next.time.front(), step, rows);
  record.add({.name = next.input, .unit = next.unit, .values = next.values});
  for (const NextExperiment::Resting& rest : next.resting) {
    record.add({.name = rest.input, .unit = rest.unit, .values = std::vector<double>(rows, rest.value)});
  }
  return record;
}

std::string record_text(records::Record record, bool is_beside_t) {
  record.set_beside_t(is_beside_t);
  return records::csv_text(record);
}

constexpr std::string_view verdict_file = "verdict.json";
constexpr std::string_view report_file = "report.html";
constexpr std::string_view improved_diagram_file = "improved.st";
constexpr std::string_view improved_parameters_file = "improved.toml";
constexpr std::string_view feedforward_file = "feedforward.st";
constexpr std::string_view next_experiment_file = "next_experiment.csv";

/// The improved diagram with the files of its FMUs seen from the folder that it is written to.
std::string improved_text(const std::filesystem::path& folder, const Diagnosis& found) {
  Diagnostics unused;  // the text compiles
  const auto source = language::parse("improved.st", found.improved_text, unused);
  return with_fmu_files(source, [&](std::string_view file) {
    return std::filesystem::path(file)
        .lexically_relative(std::filesystem::absolute(folder).lexically_normal())
        .string();
  });
}

Program improved_program(const Diagnosis& found) {
  return compile_text(found.improved_text, {.top = found.top, .any_order = true});
}

}  // namespace

std::string traces_file(std::size_t number, std::size_t count) {
  return count == 1 ? "traces.csv" : fmt::format("traces{}.csv", number);
}

bool is_diagnosis_file(std::string_view name) {
  constexpr std::array fixed{verdict_file,     report_file,         improved_diagram_file, improved_parameters_file,
                             feedforward_file, next_experiment_file};
  if (std::ranges::find(fixed, name) != fixed.end()) {
    return true;
  }
  // How many traces there will be is not known before the diagnosis.
  constexpr std::string_view before = "traces";
  constexpr std::string_view behind = ".csv";
  if (!name.starts_with(before) || !name.ends_with(behind) || name.size() < before.size() + behind.size()) {
    return false;
  }
  const std::string_view number = name.substr(before.size(), name.size() - before.size() - behind.size());
  return std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; });
}

std::vector<OutputFile> diagnosis_files(const std::filesystem::path& folder, const Diagnosis& found) {
  std::vector<OutputFile> files{{.path = folder / verdict_file, .contents = verdict_json(found)}};
  if (!found.refusals.empty()) {
    files.push_back({.path = folder / report_file, .contents = report_page(found, {})});
    return files;
  }
  files.push_back({.path = folder / improved_diagram_file, .contents = improved_text(folder, found)});
  files.push_back(
      {.path = folder / improved_parameters_file,
       .contents = parameters::parameter_text(found.improved_file, {}, "From hysteron diagnose.\n" + found.summary)});
  const Program improved = improved_program(found);
  const bool has_t = port_called_t(improved.graph) != nullptr;
  files.push_back({.path = folder / report_file, .contents = report_page(found, improved)});
  if (!found.feedforward_text.empty()) {
    files.push_back({.path = folder / feedforward_file, .contents = found.feedforward_text});
  }
  if (!found.next.time.empty()) {
    files.push_back(
        {.path = folder / next_experiment_file, .contents = record_text(command_record(found.next), has_t)});
  }
  for (std::size_t i = 0; i < found.traces.size(); ++i) {
    files.push_back({.path = folder / traces_file(i + 1, found.traces.size()),
                     .contents = record_text(trace_record(found.traces[i]), has_t)});
  }
  return files;
}

}  // namespace hysteron::diagnosis
