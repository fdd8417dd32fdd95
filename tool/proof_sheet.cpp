#include "tool/proof_sheet.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/shared/layout.hpp"
#include "codegen/backends/shared/routine.hpp"
#include "codegen/backends/shared/value_bounds.hpp"
#include "codegen/program_hash.hpp"
#include "support/names.hpp"
#include "support/sha256.hpp"
#include "support/shell_words.hpp"
#include "support/text_file.hpp"
#include "tool/proof_page.hpp"
#include "tool/version.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json hash_of_file(const std::string& path) {
  return path.empty() ? Json() : Json{{"file", path}, {"sha256", sha256(read_text_file(path))}};
}

Json schedule_of(const Program& program) {
  Json list = Json::array();
  for (const hysteron::Action& action : program.schedule.actions) {
    const Node& node = program.graph.nodes[action.node];
    if (node.block != nullptr) {
      list.push_back({{"block", node.path},
                      {"type", node.block->about.name},
                      {"action", action.kind == hysteron::Action::Kind::Output   ? "output"
                                 : action.kind == hysteron::Action::Kind::Update ? "update"
                                                                                 : "step"},
                      {"every", node.rate.every},
                      {"phase", node.rate.phase}});
    }
  }
  return list;
}

/// What the parameters take in memory: as a state of the same fields would.
std::size_t parameter_bytes(const Graph& graph, bool float32) {
  Routine parameters;
  for (const Parameter& one : graph.parameters) {
    parameters.cells.push_back({.field = one.field});
  }
  return state_bytes(parameters, float32);
}

/// Within which bounds each output stays; an open end is null.
Json bounds_json(const Graph& graph, const Routine& routine, bool float32) {
  const auto end = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  const std::vector<ValueBounds> bounds = output_bounds(graph, routine, float32);
  Json list = Json::array();
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    list.push_back({{"output", graph.outputs[i].name},
                    {"unit", graph.outputs[i].unit},
                    {"low", end(bounds[i].low)},
                    {"high", end(bounds[i].high)},
                    {"always_finite", bounds[i].is_finite()}});
  }
  return list;
}

/// The bytes of this program, which the version alone does not tell.
const std::string& hash_of_generator() {
  static const std::string hash = sha256(read_text_file("/proc/self/exe"));
  return hash;
}

Json stack_json(const TargetProof& proof) {
  return proof.stack_bytes ? Json{{"bytes", *proof.stack_bytes}, {"measured", proof.way + " at -O2"}} : Json();
}

std::string command_of(const Target& target, const TargetOptions& options, const DiagramOptions& diagram) {
  std::string text = fmt::format("hysteron generate {} --target {}", shell_word(diagram.file), target.name);
  const auto add = [&](std::string_view option, const std::string& value) {
    text += value.empty() ? "" : fmt::format(" {} {}", option, shell_word(value));
  };
  add("--top", diagram.top);
  add("--params", diagram.parameters);
  const bool spelled = target.name == "st" || target.name == "plcopen";
  add("--dialect", spelled ? options.dialect : "");
  add("--body", target.name == "plcopen" ? options.body : "");
  add("--fmi", target.name == "fmu" ? options.fmi : "");
  text += diagram.any_order ? " --any-order" : "";
  text += options.float32 ? " --float32" : "";
  text += options.structured && target.name == "st" ? " --structured" : "";
  return text + " --proof --out DIR";
}

TargetProof proved(const Program& program, const Target& target, const std::vector<GeneratedFile>& files,
                   const TargetOptions& options) {
  if (target.name != "st" || options.dialect.empty() || equal_ignoring_case(options.dialect, "portable")) {
    return prove(program, target, files, options);
  }
  TargetOptions portable = options;
  portable.dialect.clear();
  Diagnostics told;
  TargetProof proof = prove(program, target, target.generate(program, portable, told), portable);
  proof.way += ", in the portable dialect";
  return proof;
}

}  // namespace

ProofSheet proof_sheet(const Program& program, const Target& target, const std::vector<GeneratedFile>& files,
                       const TargetOptions& options, const DiagramOptions& diagram) {
  const Graph& graph = program.graph;
  const Routine routine = make_routine(program);
  ProofSheet sheet;
  sheet.proof = proved(program, target, files, options);
  Json made = Json::array();
  for (const GeneratedFile& file : files) {
    made.push_back({{"file", file.name}, {"bytes", file.text.size()}, {"sha256", sha256(file.text)}});
  }
  const Json json{{"diagram", graph.name},
                  {"target", target.name},
                  {"language", target.language},
                  {"generator", fmt::format("Hysteron {}", version)},
                  {"generator_sha256", hash_of_generator()},
                  {"source", hash_of_file(diagram.file)},
                  {"parameters", hash_of_file(diagram.parameters)},
                  {"hash_of_diagram_and_parameters", program_hash(program)},
                  {"files", made},
                  {"sample_time_ns", graph.sample_time_ns},
                  {"real", options.float32 ? "32 bits" : "64 bits"},
                  {"state_bytes", state_bytes(routine, options.float32)},
                  {"parameter_bytes", parameter_bytes(graph, options.float32)},
                  {"stack_bytes", stack_json(sheet.proof)},
                  {"operations_per_step", routine.operations},
                  {"function_calls_per_step", routine.function_calls},
                  {"schedule", schedule_of(program)},
                  {"bounds", bounds_json(graph, routine, options.float32)},
                  {"equality",
                   {{"run", sheet.proof.way},
                    {"against", "the interpreter, over random inputs of a fixed seed"},
                    {"steps", sheet.proof.was_run ? sheet.proof.steps : 0},
                    {"outputs", sheet.proof.outputs},
                    {"bits", !sheet.proof.was_run        ? "not run"
                             : sheet.proof.fault.empty() ? "equal"
                                                         : "different"},
                    {"fault", sheet.proof.fault}}},
                  {"command", command_of(target, options, diagram)}};
  sheet.file = {fmt::format("{}.{}.proof.json", identifier_text({graph.name}, LetterCase::Lower), target.name),
                json.dump(2) + "\n"};
  sheet.page = {fs::path(sheet.file.name).replace_extension(".html").string(), proof_page(json)};
  return sheet;
}

}  // namespace hysteron::tool
