#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "records/uneven_record.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "support/trimmed.hpp"
#include "tool/commands.hpp"
#include "tool/file_kind.hpp"
#include "tool/picture_file.hpp"
#include "tool/record_figures.hpp"
#include "tool/record_options.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view plot_examples = R"(Examples:
  hysteron plot log.csv --out log.html                   each column over time, with zoom
  hysteron plot log.csv --signal Y --xy U,Y --out y.png  one column over time, and Y over U
  hysteron plot log.csv out.csv --out fit.svg            a run against its record, and the difference
  hysteron plot monday.toml friday.toml --out drift.svg  parameters over the files that hold them

The ending of --out says what is drawn: .svg, .png, or .html, a page with zoom that needs nothing beside itself.
Columns of the same name are drawn together, in the unit of the first file. Signals of whole numbers that change seldom,
such as BOOL, are drawn as steps; what is no number is a gap. Of many rows, the extremes of each pixel are drawn. Uneven
times are drawn as they are, and where rows are missing there is a gap.
Exit codes: 0 drawn; 2 a file cannot be read, or nothing is there to draw.
)";

struct PlotOptions {
  std::vector<std::string> files;
  std::string out;
  std::vector<std::string> signals;
  std::vector<std::string> planes;
  std::string parameters;
  RecordOptions record;
};

/// Names for the legend: those of the files without their folders, where these differ.
std::vector<std::string> short_names(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const std::string name = std::filesystem::path(file).filename().string();
    const auto same = [&](const std::string& other) {
      return std::filesystem::path(other).filename() == std::filesystem::path(file).filename();
    };
    names.push_back(std::ranges::count_if(files, same) > 1 ? file : name);
  }
  return names;
}

/// All files are of one kind, which can be drawn.
FileKind common_kind(const std::vector<std::string>& files) {
  std::optional<FileKind> first;
  for (const std::string& file : files) {
    const FileKind kind = kind_of_file(file);
    first = first.value_or(kind);
    if (kind == FileKind::Diagram || kind == FileKind::Verdict) {
      throw InputError(
          error::bad_usage, {.file = file}, fmt::format("{} is {}.", file, words_of(kind)),
          kind == FileKind::Diagram
              ? fmt::format("`hysteron draw {} --out X.svg` draws it; plot takes records or parameter files.", file)
              : std::string("open the report.html beside it; plot takes records or parameter files."));
    }
    if (kind != *first) {
      throw InputError(
          error::bad_usage, {.file = file},
          fmt::format("{} is {}, and {} is {}.", files.front(), words_of(*first), file, words_of(kind)),
          "give records alone or parameter files alone; --params P.toml takes [record] of a parameter file.");
    }
  }
  return first.value();  // the command line asks for one file or more
}

/// U,Y of --xy.
std::pair<std::string, std::string> pair_of(const std::string& text) {
  const auto comma = text.find(',');
  const std::string x(trimmed(std::string_view(text).substr(0, comma)));
  const std::string y(comma == std::string::npos ? std::string_view()
                                                 : trimmed(std::string_view(text).substr(comma + 1)));
  if (x.empty() || y.empty() || y.find(',') != std::string::npos) {
    throw InputError(error::bad_usage, {}, fmt::format("--xy {} cannot be read.", text),
                     "name two columns, the one along the x axis first: --xy U,Y.");
  }
  return {x, y};
}

std::vector<NamedRecord> records_of(const PlotOptions& options, Console& console) {
  const records::ReadOptions reading = read_options(with_settings_of(options.parameters, options.record));
  const std::vector<std::string> names = short_names(options.files);
  std::vector<NamedRecord> records;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    const std::string bytes = read_text_file(options.files[i]);
    console.sources().put(options.files[i], bytes);
    records.push_back({.name = names[i], .record = records::parse_as_recorded(options.files[i], bytes, reading)});
    if (records.back().record.columns().empty()) {
      throw InputError(error::bad_usage, {.file = options.files[i]},
                       fmt::format("{} has no column of numbers.", options.files[i]),
                       fmt::format("`hysteron record {}` says what was understood of it.", options.files[i]));
    }
  }
  bring_to_one_unit(records);
  for (const auto& [name, record] : records) {
    for (const std::string& note : record.notes()) {
      Console::note(record.file(), note);
    }
    for (const records::Record::Unreadable& one : record.unreadable()) {
      Console::note(record.file(), fmt::format("{} is left out: {}", one.name, one.fault.cause));
    }
  }
  return records;
}

std::vector<plots::Figure> figures_of_records(const PlotOptions& options, Console& console) {
  const std::vector<NamedRecord> records = records_of(options, console);
  std::vector<plots::Figure> figures;
  if (options.planes.empty() || !options.signals.empty()) {
    figures.push_back(figure_over_time(records, options.signals));
  }
  for (const std::string& plane : options.planes) {
    const auto [x, y] = pair_of(plane);
    figures.push_back(figure_in_plane(records, x, y));
  }
  return figures;
}

std::vector<plots::Figure> figures_of_parameters(const PlotOptions& options) {
  if (options.files.size() < 2 || !options.planes.empty() || !options.signals.empty()) {
    throw InputError(error::bad_usage, {.file = options.files.front()},
                     options.files.size() < 2 ? "One parameter file alone gives no picture."
                                              : "Parameter files have no signals for --signal and --xy.",
                     "name two parameter files or more: their parameters are drawn over the files.");
  }
  const std::vector<std::string> names = short_names(options.files);
  std::vector<NamedParameters> files;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    files.push_back({.name = names[i], .file = parameters::read_parameter_file(options.files[i])});
  }
  std::vector<plots::Figure> figures{figure_of_parameters(files)};
  if (figures.front().panels.empty()) {
    throw InputError(error::bad_usage, {.file = options.files.front()}, "No parameter differs between these files.",
                     "give files whose values differ; `hysteron compare` says what two have in common.");
  }
  return figures;
}

int plot(const PlotOptions& options, Console& console) {
  std::vector<InputFile> inputs{{.file = options.parameters, .named_by = "--params"}};
  for (const std::string& file : options.files) {
    inputs.push_back({.file = file});
  }
  refuse_unfit_picture(options.out, "--out", inputs);
  const FileKind kind = common_kind(options.files);
  const std::vector<plots::Figure> figures =
      kind == FileKind::Parameters ? figures_of_parameters(options) : figures_of_records(options, console);
  std::string title;
  for (const std::string& name : short_names(options.files)) {
    title += (title.empty() ? "" : ", ") + name;
  }
  write_file_atomically(options.out, picture_bytes(options.out, title, figures));
  std::size_t panels = 0;
  for (const plots::Figure& figure : figures) {
    panels += figure.panels.size();
  }
  console.print(fmt::format("{}: {} plot{}\n", options.out, panels, panels == 1 ? "" : "s"));
  return exit_ok;
}

}  // namespace

Action add_plot(CLI::App& app) {
  const auto options = std::make_shared<PlotOptions>();
  app.add_option("FILE", options->files, "Records, or parameter files.")->required()->option_text("FILE...");
  app.add_option("--out", options->out, "The picture: .svg, .png, or .html for a page with zoom.")
      ->required()
      ->option_text("FILE");
  app.add_option("--signal", options->signals, "Draws these columns alone; may be repeated.")
      ->option_text("Y")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--xy", options->planes, "Draws one column over another: Y over U; may be repeated.")
      ->option_text("U,Y")
      ->allow_extra_args(false);
  add_record_options(app, options->record);
  app.add_option("--params", options->parameters, "Takes [record] of a parameter file, where no option says otherwise.")
      ->option_text("P.toml");
  app.footer(std::string(plot_examples));
  return [options](Console& console) { return plot(*options, console); };
}

}  // namespace hysteron::tool
