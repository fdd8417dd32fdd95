#include "codegen/graph/fmu_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "codegen/cosimulation/fmu.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/graph/sample_time.hpp"
#include "codegen/graph/unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

using cosimulation::Description;
using cosimulation::Fmu;
using cosimulation::ModelVariable;

/// More than a set of pins holds; parameters come behind them and are driven by no signal.
constexpr std::size_t most_inputs = 64;

/// A name of the language, as near to that of the FMU as can be: motor.w is motor_w, u[1] is u_1.
std::string identifier_of(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const bool fits = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (fits) {
      text += c;
    } else if (!text.empty() && text.back() != '_') {
      text += '_';
    }
  }
  while (text.ends_with('_')) {
    text.pop_back();
  }
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text.front())) != 0) {
    text = "V" + text;
  }
  return is_reserved(text) ? text + "_1" : text;
}

/// A unit as Modelica writes it (N.m, m/s2) in our symbols; empty where it is none.
std::string unit_of(const std::string& unit) {
  std::string translated;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool digit =
        std::isdigit(static_cast<unsigned char>(unit[i])) != 0 ||
        (unit[i] == '-' && i + 1 < unit.size() && std::isdigit(static_cast<unsigned char>(unit[i + 1])) != 0);
    const bool behind_letter = i > 0 && std::isalpha(static_cast<unsigned char>(unit[i - 1])) != 0;
    translated += digit && behind_letter ? "^" : "";
    translated += unit[i] == '.' ? '*' : unit[i];
  }
  std::string reason;
  for (const std::string& text : {unit, translated}) {
    if (units::parse_unit(text, reason)) {
      return text;
    }
  }
  return {};
}

/// A block and the texts that its description points to.
struct FmuBlock {
  const Fmu* fmu = nullptr;
  std::deque<std::string> texts;
  std::vector<Field> inputs;
  std::vector<Field> params;
  std::vector<Field> outputs;
  std::vector<Field> states;
  BlockType type;
};

class Maker {
 public:
  explicit Maker(const Fmu& fmu) : fmu_(fmu), block_(std::make_unique<FmuBlock>()) {}

  std::unique_ptr<FmuBlock> make() {
    const Description& about = fmu_.description();
    block_->fmu = &fmu_;
    block_->inputs = fields(about.inputs, true);
    block_->params = fields(about.parameters, false);
    block_->outputs = fields(about.outputs, false);
    // What it remembers lies in its process; of that the language sees that it is there.
    Field& steps = block_->states.emplace_back();
    steps.name = "STEPS";
    steps.meaning = "communication steps done";
    steps.type = Type::Int;
    BlockType& type = block_->type;
    type.about.name = fmu_type_name;
    type.about.title = keep(about.model_name);
    type.about.meaning = keep(about.meaning);
    type.about.group = Group::Dynamics;
    type.inputs = block_->inputs;
    type.params = block_->params;
    type.outputs = block_->outputs;
    type.states = block_->states;
    type.fmu = &fmu_;
    const ValueId memory = type.trace.tape.leaf(Op::Cell, Type::Int, 0);
    type.trace.initial = {type.trace.tape.literal(Op::IntLiteral, 0.0)};
    type.trace.next = {memory};
    type.trace.outputs.assign(block_->outputs.size(), memory);
    type.trace.feedthrough.assign(block_->outputs.size(), PinSet{});
    for (std::size_t pin = 0; pin < block_->inputs.size(); ++pin) {
      type.trace.update_pins.insert(pin);
    }
    return std::move(block_);
  }

 private:
  std::string_view keep(std::string text) { return block_->texts.emplace_back(std::move(text)); }

  std::string_view unique_name(const std::string& name) {
    const std::string plain = identifier_of(name);
    std::string text = plain;
    for (int copy = 2; !taken_.insert(in_capitals(text)).second; ++copy) {
      text = fmt::format("{}_{}", plain, copy);
    }
    return keep(std::move(text));
  }

  std::vector<Field> fields(const std::vector<ModelVariable>& variables, bool required) {
    std::vector<Field> list;
    for (const ModelVariable& one : variables) {
      Field& field = list.emplace_back();
      field.name = unique_name(one.name);
      field.unit = keep(unit_of(one.unit));
      field.meaning = keep(one.meaning);
      field.preset = one.start;
      field.minimum = one.minimum;
      field.maximum = one.maximum;
      field.type = one.type;
      field.required = required;
    }
    return list;
  }

  const Fmu& fmu_;
  std::unique_ptr<FmuBlock> block_;
  std::set<std::string> taken_{};
};

}  // namespace

const BlockType& fmu_block(const std::string& path) {
  static std::mutex lock;
  static std::map<const Fmu*, std::unique_ptr<FmuBlock>> known;
  const Fmu& fmu = Fmu::open(path);
  if (const std::size_t inputs = fmu.description().inputs.size(); inputs > most_inputs) {
    throw InputError(error::unusable_fmu, {.file = path},
                     fmt::format("{} cannot be used: it has {} inputs.", path, inputs),
                     fmt::format("export a model with at most {} inputs.", most_inputs));
  }
  const std::lock_guard guard(lock);
  auto& found = known[&fmu];
  if (!found) {
    found = Maker(fmu).make();
  }
  return found->type;
}

std::string_view name_in_fmu(const BlockType& block, std::size_t pin) {
  const Description& about = block.fmu->description();
  return pin < about.inputs.size() ? about.inputs[pin].name : about.parameters[pin - about.inputs.size()].name;
}
std::string_view output_name_in_fmu(const BlockType& block, std::size_t output) {
  return block.fmu->description().outputs[output].name;
}

std::string fmu_path(const language::SourceFile& source, std::string_view file) {
  return (std::filesystem::path(source.path).parent_path() / file).string();
}

std::string with_fmu_files(const language::SourceFile& source,
                           const std::function<std::string(std::string_view file)>& moved) {
  std::string text = *source.text;
  for (auto block = source.blocks.rbegin(); block != source.blocks.rend(); ++block) {
    for (auto variable = block->variables.rbegin(); variable != block->variables.rend(); ++variable) {
      for (const language::Annotation& annotation : variable->annotations) {
        if (annotation.key == "file") {
          text.replace(annotation.value_span.offset, annotation.value_span.length, moved(annotation.value));
        }
      }
    }
  }
  return text;
}

bool has_fmu(const Graph& graph) {
  return std::ranges::any_of(graph.nodes,
                             [](const Node& node) { return node.block != nullptr && node.block->fmu != nullptr; });
}

void check_fmu_parameters(const Graph& graph, Diagnostics& diagnostics) {
  for (const Node& node : graph.nodes) {
    if (node.block == nullptr || node.block->fmu == nullptr) {
      continue;
    }
    for (std::size_t pin = node.block->inputs.size(); pin < node.wire_count; ++pin) {
      const Wire& wire = graph.wire(node, pin);
      if (wire.from == Wire::From::Node || wire.from == Wire::From::Input) {
        const std::string_view name = node.block->pin(pin).name;
        diagnostics.error(
            error::type_mismatch, graph.place(graph.wire_spans[node.first_wire + pin]),
            fmt::format("{} is a parameter of an FMU, and a signal would drive it", name),
            "Give it a literal, or an input that is marked @param: an FMU takes its parameters when it begins.");
      }
    }
  }
}

void refuse_fmu(const Graph& graph, std::string_view why, std::string mend) {
  const auto found = std::ranges::find_if(
      graph.nodes, [](const Node& node) { return node.block != nullptr && node.block->fmu != nullptr; });
  if (found != graph.nodes.end()) {
    throw InputError(
        error::fmu_out_of_place, graph.place(found->span),
        fmt::format("{} is the FMU {}, a program for this machine: {}.", found->path, found->block->fmu->path(), why),
        std::move(mend));
  }
}

void require_generable(const Graph& graph) {
  require_sample_time(graph);
  refuse_fmu(graph, "neither generated code nor a served task can have it",
             "`hysteron run`, `tune` and `test --no-generated` can; for others, take a diagram without it, such as the "
             "controller alone.");
}

}  // namespace hysteron
