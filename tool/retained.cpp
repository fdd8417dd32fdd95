#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "codegen/language/syntax.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "runtime/task/carry.hpp"
#include "runtime/task/retain.hpp"
#include "runtime/task/staged_parameters.hpp"
#include "support/atomic_file.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/overwriting.hpp"
#include "tool/commands.hpp"
#include "tool/writable.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view retained_examples = R"(Examples:
  hysteron retained kept
  hysteron retained kept --params p.toml --out tuned_on_site.toml
  hysteron retained kept --set p.toml

Shows what a task keeps in the folder of [retain]. --out writes its parameters into a parameter file, so that what was tuned
at the machine goes back into the project. --set puts the parameters of a file into the folder, while no task runs.
Exit codes: 0 done; 2 bad input.
)";

struct Options {
  std::string folder{};
  std::string params{};
  std::string out{};
  std::string set{};
  bool json = false;
};

struct Newest {
  std::size_t slot = 0;
  runtime::RetainedValues values{};
  runtime::KeptLayout layout{};
};

[[noreturn]] void refuse(const std::string& folder, const std::string& cause, const std::string& mend) {
  throw InputError(error::unusable_retain_folder, {}, fmt::format("{}: {}", folder, cause), mend);
}

Newest newest_of(runtime::RetainFolder& folder, const std::string& name) {
  std::optional<Newest> newest;
  bool is_any = false;
  try {
    for (std::size_t slot = 0; slot < 2; ++slot) {
      const auto bytes = folder.read(slot);
      is_any = is_any || bytes.has_value();
      runtime::Slot read = bytes ? runtime::decode_slot(*bytes) : runtime::Slot{};
      if (read.status == runtime::SlotStatus::whole && (!newest || read.values.sequence > newest->values.sequence)) {
        newest = {.slot = slot, .values = std::move(read.values)};
      }
    }
  } catch (const std::system_error& problem) {
    refuse(
        name, problem.what(),
        problem.code() == std::errc::not_a_directory
            ? "name the folder that stands at `folder` under [retain] of the run file."
        : problem.code() == std::errc::permission_denied
            ? "give this user the right to read it."
            : "remove what is in its way, or see to the disk; the task starts with mismatch = \"cold\" once the slot "
              "is gone.");
  }
  if (!newest && is_any) {
    refuse(
        name, "no slot is whole.",
        "put copies of retain_a and retain_b back, or start the task with mismatch = \"cold\", which puts both aside; "
        "and see to the disk.");
  }
  if (!newest) {
    refuse(name, "there are no retained values here.",
           "name the folder that stands at `folder` under [retain] of the run file.");
  }
  newest->layout = runtime::read_description(newest->values.described, newest->values.state.size());
  if (newest->layout.parameters.size() != newest->values.parameters.size()) {
    refuse(name, "the file keeps no names: it is of an earlier version.",
           "start the task once with this version, which writes it anew.");
  }
  return std::move(*newest);
}

/// TABLE.X of TABLE.X[2]; the name itself where it is no element.
std::string without_element(const std::string& name) {
  return name.substr(0, name.find('['));
}

parameters::Value value_of(runtime::PointType type, double number) {
  switch (type) {
    case runtime::PointType::boolean:
      return number != 0.0;
    case runtime::PointType::real64:
    case runtime::PointType::real32:
      return number;
    default:
      return static_cast<std::int64_t>(number);
  }
}

/// Puts a value where the file has one of that name already, else behind the others.
void put(parameters::ParameterFile& file, const std::string& path, parameters::Value value) {
  const auto has = std::ranges::find_if(
      file.values, [&](const parameters::ParameterValue& one) { return language::same_name(one.path, path); });
  if (has == file.values.end()) {
    file.values.push_back({.path = path, .value = std::move(value)});
  } else {
    has->value = std::move(value);
  }
}

/// The retained parameters in the file; what is not finite, as a limit that is off, stays what it was.
parameters::ParameterFile with_retained(parameters::ParameterFile file, const Newest& newest) {
  std::map<std::string, std::vector<double>> arrays;
  std::set<std::string> truths;
  for (std::size_t i = 0; i < newest.layout.parameters.size(); ++i) {
    const auto& about = newest.layout.parameters[i];
    const std::string path = without_element(about.name);
    const double number = newest.values.parameters[i];
    if (path != about.name) {
      arrays[path].push_back(number);
      if (about.type == runtime::PointType::boolean) {
        truths.insert(path);
      }
    } else if (std::isfinite(number)) {
      put(file, path, value_of(about.type, number));
    }
  }
  for (const auto& [path, values] : arrays) {
    if (!std::ranges::all_of(values, [](double one) { return std::isfinite(one); })) {
      continue;
    }
    std::erase_if(file.values, [&](const parameters::ParameterValue& one) {
      const auto element = element_of(one.path);
      return element && language::same_name(element->vector, path);
    });
    if (truths.contains(path)) {
      put(file, path, std::vector<bool>(values.begin(), values.end()));
    } else {
      put(file, path, values);
    }
  }
  return file;
}

double number_of(const parameters::Value& value, std::size_t element) {
  if (const auto* const truth = std::get_if<bool>(&value)) {
    return *truth ? 1.0 : 0.0;
  }
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
    return static_cast<double>(*whole);
  }
  if (const auto* const list = std::get_if<std::vector<double>>(&value)) {
    return list->at(element);
  }
  if (const auto* const truths = std::get_if<std::vector<bool>>(&value)) {
    return truths->at(element) ? 1.0 : 0.0;
  }
  return std::get<double>(value);
}

std::size_t length_of(const parameters::Value& value) {
  if (const auto* const truths = std::get_if<std::vector<bool>>(&value)) {
    return truths->size();
  }
  const auto* const list = std::get_if<std::vector<double>>(&value);
  return list == nullptr ? 1 : list->size();
}

/// Why a retained parameter cannot take a value, a sentence; empty where it can.
std::string refusal_of(const runtime::KeptLayout::Parameter& about, const parameters::Value& given, double value) {
  const bool is_truth = about.type == runtime::PointType::boolean;
  if (is_truth != (std::holds_alternative<bool>(given) || std::holds_alternative<std::vector<bool>>(given))) {
    return fmt::format("{} is {}, and takes {}.", about.name, is_truth ? "a BOOL" : "a number",
                       is_truth ? "true or false" : "a number");
  }
  return runtime::refusal_of({.name = about.name,
                              .unit = about.unit,
                              .type = about.type,
                              .low = about.low,
                              .high = about.high,
                              .low_excluded = about.low_excluded},
                             value);
}

/// Puts the values of the file into the slot; each has to be retained there.
void take_from(const parameters::ParameterFile& file, Newest& newest) {
  Diagnostics found;
  for (const parameters::ParameterValue& one : file.values) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < newest.layout.parameters.size(); ++i) {
      if (language::same_name(without_element(newest.layout.parameters[i].name), one.path)) {
        places.push_back(i);
      }
    }
    if (places.size() != length_of(one.value)) {
      found.error(error::unknown_key, one.place,
                  places.empty() ? fmt::format("{} is not among the retained parameters.", one.path)
                                 : fmt::format("{} has {} values there, and {} here.", one.path, places.size(),
                                               length_of(one.value)),
                  "take the line out, or start the task with this diagram first; `hysteron retained` lists the names.");
      continue;
    }
    for (std::size_t element = 0; element < places.size(); ++element) {
      const auto& about = newest.layout.parameters[places[element]];
      const double value = number_of(one.value, element);
      if (const std::string why = refusal_of(about, one.value, value); !why.empty()) {
        found.error(error::parameter_out_of_range, one.value_place, why, "write a value that the diagram takes.");
      }
      newest.values.parameters[places[element]] = value;
    }
  }
  if (found.has_errors()) {
    throw InputError(std::move(found));
  }
}

void set(const Options& options, runtime::RetainFolder& folder) {
  const parameters::ParameterFile file = parameters::read_parameter_file(options.set);
  try {
    folder.open();
  } catch (const std::system_error& problem) {
    if (problem.code() == std::errc::resource_unavailable_try_again) {
      throw InputError(error::file_of_another_task, {},
                       fmt::format("A task that runs retains its values in {}.", options.folder),
                       "end that task first; while it runs, write the parameters over Modbus or on its page.");
    }
    refuse(options.folder, problem.what(), "give this user the right to write it.");
  }
  Newest newest = newest_of(folder, options.folder);
  take_from(file, newest);
  ++newest.values.sequence;
  if (const std::string problem = folder.write(1 - newest.slot, runtime::encode_slot(newest.values));
      !problem.empty()) {
    refuse(options.folder, problem, "clear what is in the way there; the values are as they were.");
  }
}

std::string table_of(const Newest& newest) {
  std::string text =
      fmt::format("state {}: {} parameters, {} numbers of state in {} bytes\n", newest.values.sequence,
                  newest.layout.parameters.size(), newest.layout.state.size(), newest.values.state.size());
  std::size_t widest = 0;
  for (const auto& one : newest.layout.parameters) {
    widest = std::max(widest, one.name.size());
  }
  for (std::size_t i = 0; i < newest.layout.parameters.size(); ++i) {
    const auto& one = newest.layout.parameters[i];
    text += fmt::format("  {:<{}}  {}{}{}\n", one.name, widest, number_text(newest.values.parameters[i]),
                        one.unit.empty() ? "" : " ", one.unit);
  }
  for (std::size_t i = 0; i < newest.layout.inputs.size() && i < newest.values.inputs.size(); ++i) {
    const auto& one = newest.layout.inputs[i];
    text += fmt::format("{}  {}  {}{}{}\n", i == 0 ? "inputs that clients wrote:\n" : "", one.name,
                        number_text(newest.values.inputs[i]), one.unit.empty() ? "" : " ", one.unit);
  }
  return text;
}

std::string json_of(const Newest& newest) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < newest.layout.parameters.size(); ++i) {
    const auto& one = newest.layout.parameters[i];
    nlohmann::ordered_json value = newest.values.parameters[i];
    if (!std::isfinite(newest.values.parameters[i])) {
      value = nullptr;
    }
    parameters.push_back({{"name", one.name}, {"value", value}, {"unit", one.unit}});
  }
  nlohmann::ordered_json states = nlohmann::ordered_json::array();
  for (const runtime::StateField& one : newest.layout.state) {
    states.push_back({{"name", one.name}, {"block", one.block}, {"unit", one.unit}, {"length", one.length}});
  }
  nlohmann::ordered_json inputs = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < newest.layout.inputs.size() && i < newest.values.inputs.size(); ++i) {
    const auto& one = newest.layout.inputs[i];
    inputs.push_back({{"name", one.name}, {"value", newest.values.inputs[i]}, {"unit", one.unit}});
  }
  const nlohmann::ordered_json all{
      {"sequence", newest.values.sequence}, {"parameters", parameters}, {"inputs", inputs}, {"states", states}};
  return all.dump(2) + "\n";
}

int retained(const Options& options, Console& console) {
  runtime::RetainFolder folder(options.folder);
  if (!options.set.empty()) {
    set(options, folder);
  }
  const Newest newest = newest_of(folder, options.folder);
  if (options.out.empty()) {
    console.print(options.json ? json_of(newest) : table_of(newest));
    return exit_ok;
  }
  std::vector<InputFile> inputs{{.file = folder.path_of(0).string(), .named_by = "DIR"},
                                {.file = folder.path_of(1).string(), .named_by = "DIR"}};
  refuse_to_overwrite({.file = options.out}, inputs);
  refuse_unwritable(options.out);
  const parameters::ParameterFile base =
      options.params.empty() ? parameters::ParameterFile{} : parameters::read_parameter_file(options.params);
  parameters::Remarks remarks;
  for (const auto& one : newest.layout.parameters) {
    remarks["PARAMETERS." + language::upper(without_element(one.name))] = {.unit = one.unit};
  }
  write_file_atomically(options.out, parameters::parameter_text(with_retained(base, newest), remarks));
  console.print(fmt::format("{}: {} parameters of state {}\n", options.out, newest.layout.parameters.size(),
                            newest.values.sequence));
  return exit_ok;
}

}  // namespace

Action add_retained(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.add_option("DIR", options->folder, "The folder of [retain].")->required()->option_text(" ");
  auto* const params =
      app.add_option("--params", options->params, "A parameter file whose other lines and comments --out keeps.")
          ->option_text("P.toml");
  auto* const out = app.add_option("--out", options->out, "The parameter file to be written.")->option_text("P.toml");
  params->needs(out);
  app.add_option("--set", options->set, "A parameter file whose values are put into the folder.")
      ->option_text("P.toml");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(retained_examples));
  return [options](Console& console) { return retained(*options, console); };
}

}  // namespace hysteron::tool
