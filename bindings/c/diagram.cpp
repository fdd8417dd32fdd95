#include "bindings/c/diagram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/graph/defaults.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/language/syntax.hpp"
#include "codegen/parameters/apply.hpp"
#include "support/errors.hpp"
#include "support/json_number.hpp"
#include "support/names.hpp"

namespace hysteron::bindings {
namespace {

using Json = nlohmann::ordered_json;

/// What a text without a file is called in messages.
constexpr const char* memory_diagram = "diagram";
constexpr const char* memory_parameters = "parameters";

Json port_json(const Port& port) {
  return {{"name", port.name},
          {"unit", port.unit},
          {"meaning", port.meaning},
          {"type", type_name(port.type)},
          {"minimum", number_or_null<Json>(port.minimum)},
          {"maximum", number_or_null<Json>(port.maximum)}};
}

parameters::Value value_of(const std::string& name, const nlohmann::json& value) {
  if (value.is_boolean()) {
    return value.get<bool>();
  }
  if (value.is_number_integer()) {
    return value.get<std::int64_t>();
  }
  if (value.is_number()) {
    return value.get<double>();
  }
  if (value.is_array() && !value.empty() &&
      std::ranges::all_of(value, [](const nlohmann::json& one) { return one.is_number(); })) {
    return value.get<std::vector<double>>();
  }
  throw InputError(error::wrong_value_type, {.file = memory_parameters},
                   fmt::format("The parameter {} is {}.", name, value.dump()),
                   "give a number, TRUE or FALSE, or a list of numbers.");
}

/// The parameter file that options name, with the values that they give over it.
parameters::ParameterFile parameters_of(Options& options, parameters::ParameterFile file) {
  const std::string path = options.text("params");
  const std::string text = options.text("params_text");
  if (!path.empty() && !text.empty()) {
    throw InputError(error::bad_usage, {}, "params and params_text both give a parameter file.", "give one of them.");
  }
  if (!path.empty()) {
    file = parameters::read_parameter_file(path);
  } else if (!text.empty()) {
    file = parameters::parse_parameter_file(memory_parameters, text);
  }
  for (const auto& [name, value] : options.members("parameters")) {
    std::erase_if(file.values, [&name = name](const auto& one) { return equal_ignoring_case(one.path, name); });
    file.values.push_back({.path = name,
                           .value = value_of(name, value),
                           .place = {.file = memory_parameters},
                           .value_place = {.file = memory_parameters}});
  }
  return file;
}

std::unique_ptr<hysteron_diagram> with(std::shared_ptr<const Program> compiled, parameters::ParameterFile file,
                                       const Diagnostics& warnings) {
  auto result = std::make_unique<hysteron_diagram>();
  result->program = *compiled;
  parameters::apply(file, result->program.graph);
  result->compiled = std::move(compiled);
  result->file = std::move(file);
  result->warnings = warnings;
  result->json = diagram_json(result->program);
  return result;
}

hysteron_diagram* compiled(language::SourceFile parsed, Diagnostics& diagnostics, Options& options, Call& call) {
  // Names of inner variables are kept: which of them a run will trace is not known yet.
  const CompileOptions how{.top = options.text("top"), .any_order = options.flag("any_order"), .keep_names = true};
  parameters::ParameterFile file = parameters_of(options, {});
  options.finish();
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  auto program = std::make_shared<const Program>(
      compile(std::make_shared<const language::SourceFile>(std::move(parsed)), how, diagnostics));
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  call.warn(diagnostics);
  return with(std::move(program), std::move(file), diagnostics).release();
}

}  // namespace

std::string diagram_json(const Program& program) {
  const Graph& graph = program.graph;
  Json json{{"schema", "hysteron-diagram/1"},
            {"name", graph.name},
            {"sample_time", graph.sample_time_ns > 0 ? Json(graph.sample_time()) : Json(nullptr)},
            {"inputs", Json::array()},
            {"outputs", Json::array()},
            {"parameters", Json::array()}};
  for (const Port& input : graph.inputs) {
    Json one = port_json(input);
    one["default"] = has_default(graph, input) ? number_or_null<Json>(input.preset) : Json(nullptr);
    json["inputs"].push_back(std::move(one));
  }
  for (const Port& output : graph.outputs) {
    json["outputs"].push_back(port_json(output));
  }
  const std::vector<std::string> units = units::Solution(graph, program.schedule).parameters();
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    const Parameter& parameter = graph.parameters[i];
    const Field& field = parameter.field;
    Json value = Json::array();
    for (const double one : parameter.value) {
      value.push_back(field.type == Type::Bool ? Json(one != 0.0) : number_or_null<Json>(one));
    }
    json["parameters"].push_back({{"name", parameter.path},
                                  {"unit", units[i]},
                                  {"meaning", field.meaning},
                                  {"type", type_name(field.type)},
                                  {"minimum", number_or_null<Json>(field.minimum)},
                                  {"maximum", number_or_null<Json>(field.maximum)},
                                  {"above_minimum", field.above_minimum},
                                  {"value", field.length > 1 ? value : value.front()}});
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

records::ReadOptions read_options_of(Options& options, const hysteron_diagram* diagram) {
  RecordOptions written{.time = options.text("time"), .rate = options.text("rate")};
  for (const auto& [name, in_file] : options.members("columns")) {
    if (!in_file.is_string() && !in_file.is_number_integer()) {
      throw InputError(error::bad_usage, {}, fmt::format("The column of {} is {}.", name, in_file.dump()),
                       "give its name in the file, or its number from 1 on.");
    }
    written.columns.push_back(
        fmt::format("{}={}", name, in_file.is_string() ? in_file.get<std::string>() : in_file.dump()));
  }
  written.skip = options.text("skip");
  written.range = options.text("range");
  written.rows = options.text("rows");
  written.decimal = options.text("decimal");
  for (const auto& [name, way] : options.members_or_text("resample")) {
    if (!way.is_string()) {
      throw InputError(error::bad_usage, {}, fmt::format("The way in which {} is resampled is {}.", name, way.dump()),
                       "give it a text: linear, hold or average.");
    }
    const bool of_all = name.empty() || name == "*";
    written.resample.push_back(of_all ? way.get<std::string>() : fmt::format("{}={}", name, way.get<std::string>()));
  }
  if (diagram != nullptr) {
    written = with_settings(std::move(written), diagram->file.record);
  }
  return read_options(written, diagram != nullptr ? &diagram->program : nullptr);
}

}  // namespace hysteron::bindings

using hysteron::Diagnostics;
using hysteron::bindings::Call;
using hysteron::bindings::Options;
using hysteron::bindings::require;

extern "C" {

hysteron_diagram* hysteron_compile_file(const char* path, const char* options, hysteron_messages** messages) {
  Call call(messages);
  return call([&]() -> hysteron_diagram* {
    require(path, "The path of the diagram");
    Options given(options);
    Diagnostics diagnostics;
    auto parsed = hysteron::language::parse_file(path, diagnostics);
    return hysteron::bindings::compiled(std::move(parsed), diagnostics, given, call);
  });
}

hysteron_diagram* hysteron_compile_text(const char* text, const char* options, hysteron_messages** messages) {
  Call call(messages);
  return call([&]() -> hysteron_diagram* {
    require(text, "The text of the diagram");
    call.has_text(hysteron::bindings::memory_diagram, text);
    Options given(options);
    Diagnostics diagnostics;
    auto parsed = hysteron::language::parse(hysteron::bindings::memory_diagram, text, diagnostics);
    return hysteron::bindings::compiled(std::move(parsed), diagnostics, given, call);
  });
}

hysteron_diagram* hysteron_with_parameters(const hysteron_diagram* diagram, const char* options,
                                           hysteron_messages** messages) {
  Call call(messages);
  return call([&]() -> hysteron_diagram* {
    require(diagram, "The diagram");
    Options given(options);
    auto file = hysteron::bindings::parameters_of(given, diagram->file);
    given.finish();
    return hysteron::bindings::with(diagram->compiled, std::move(file), diagram->warnings).release();
  });
}

const char* hysteron_diagram_json(const hysteron_diagram* diagram) {
  return diagram != nullptr ? diagram->json.c_str() : nullptr;
}

size_t hysteron_input_count(const hysteron_diagram* diagram) {
  return diagram != nullptr ? diagram->program.graph.inputs.size() : 0;
}

size_t hysteron_output_count(const hysteron_diagram* diagram) {
  return diagram != nullptr ? diagram->program.graph.outputs.size() : 0;
}

const char* hysteron_input_name(const hysteron_diagram* diagram, size_t index) {
  return index < hysteron_input_count(diagram) ? diagram->program.graph.inputs[index].name.c_str() : nullptr;
}

const char* hysteron_output_name(const hysteron_diagram* diagram, size_t index) {
  return index < hysteron_output_count(diagram) ? diagram->program.graph.outputs[index].name.c_str() : nullptr;
}

void hysteron_diagram_free(hysteron_diagram* diagram) {
  delete diagram;
}

}  // extern "C"
