#include "diagnosis/effects/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "blocks/families.hpp"
#include "codegen/compile.hpp"
#include "codegen/graph/units.hpp"
#include "diagnosis/effects/insertion.hpp"
#include "diagnosis/effects/motions.hpp"

namespace hysteron::diagnosis {
namespace {

Wire wire_of(const Graph& graph, const Node& node, std::string_view pin) {
  for (std::size_t i = 0; i < node.block->inputs.size(); ++i) {
    if (node.block->inputs[i].name == pin) {
      return graph.wire(node, i);
    }
  }
  return {};
}

/// What a signal comes from: inputs and nodes, through blocks, delays and all, but not through the node `barrier`.
std::vector<Wire> sources_of(const Graph& graph, const Wire& signal, const Wire& barrier) {
  std::vector<bool> seen(graph.nodes.size(), false);
  std::vector<Wire> sources;
  std::vector<Wire> left{signal};
  while (!left.empty()) {
    const Wire wire = left.back();
    left.pop_back();
    sources.push_back(wire);
    if (wire.from != Wire::From::Node || seen[wire.index] || wire.index == barrier.index) {
      continue;
    }
    seen[wire.index] = true;
    const Node& node = graph.nodes[wire.index];
    for (std::size_t i = 0; i < node.wire_count; ++i) {
      left.push_back(graph.wire(node, i));
    }
  }
  return sources;
}

bool depends_on(const Graph& graph, const Wire& signal, const Wire& source, const Wire& barrier) {
  return std::ranges::any_of(sources_of(graph, signal, barrier),
                             [&](const Wire& wire) { return wire.from == source.from && wire.index == source.index; });
}

class Enumeration {
 public:
  Enumeration(const Variant& base, const std::string& top, const CandidateOptions& options)
      : base_(base),
        top_(top),
        options_(options),
        source_(parsed(base.text)),
        definitions_(defined(source_)),
        index_(top_definition(definitions_, base.program->graph.name)),
        edges_(edges_of(definitions_, index_)),
        places_(instances_of(definitions_, index_)),
        units_(units::Solution(base.program->graph, base.program->schedule).outputs()),
        kinds_(effect_kinds(definitions_)) {}

  std::vector<Candidate> list() {
    for (const EffectKind& kind : kinds_) {
      if (!is_tried(options_.effects, kind.id) || (options_.effects.empty() && !kind.untried.empty())) {
        continue;
      }
      if (kind.change == Change::Insert) {
        for (const Edge& edge : edges_) {
          if (!serves_effect(edge) && (!kind.of_record || is_port(edge))) {
            insert(kind, edge);
          }
        }
      } else {
        change_instances(kind);
      }
    }
    return std::move(candidates_);
  }

 private:
  // The text compiled before: there is nothing to report.
  static std::shared_ptr<const language::SourceFile> parsed(const std::string& text) {
    Diagnostics none;
    return std::make_shared<const language::SourceFile>(language::parse("text", text, none));
  }
  static Definitions defined(const std::shared_ptr<const language::SourceFile>& source) {
    Diagnostics none;
    return define(source, none);
  }

  /// Whether the effect is there already: twice the same one on two edges is a search for a better fit, not for a
  /// cause.
  [[nodiscard]] bool present(const std::string& effect) const {
    return !options_.again &&
           std::ranges::any_of(base_.effects, [&](const Applied& applied) { return applied.effect == effect; });
  }

  /// Whether an instance is an effect that was added, or carries one: no motion of the machine.
  [[nodiscard]] bool added_before(const std::string& instance) const {
    return std::ranges::any_of(base_.effects, [&](const Applied& applied) { return applied.instance == instance; });
  }

  /// Whether an edge leads to nothing but a further pin of an effect that was added: no wire of the machine.
  [[nodiscard]] bool serves_effect(const Edge& edge) const {
    return std::ranges::any_of(base_.effects, [&](const Applied& applied) {
      const bool is_pin = std::ranges::any_of(
          applied.wires, [&](const auto& wire) { return edge.name == applied.instance + "." + wire.first; });
      const auto is_of = [&](const std::string& helper) {
        return !helper.empty() && (edge.name == helper + ".XIN" || edge.name == helper + ".XOUT");
      };
      return is_pin || is_of(applied.delay) || is_of(applied.rate);
    });
  }

  /// What may drive a further input: signals of the same block that come from a block with memory, another input of
  /// the diagram, a column of the records that nothing uses.
  [[nodiscard]] std::vector<std::string> drivers(const EffectKind& kind, const Edge& edge) const {
    if (options_.driver) {
      return {options_.driver->signal};
    }
    std::vector<std::string> result;
    if (kind.family == name_of(Family::Coupling)) {
      if (!edge.prefix.empty()) {
        return result;
      }
      for (const Declared& declared : definitions_.list[index_].variables) {
        if (declared.kind == Declared::Kind::Input && declared.field.type == Type::Real &&
            declared.field.name != edge.local) {
          result.push_back(language::upper(declared.field.name));
        }
      }
      result.insert(result.end(), options_.columns.begin(), options_.columns.end());
      return result;
    }
    for (const Declared& declared : definitions_.list[edge.definition].variables) {
      if (declared.kind != Declared::Kind::LibraryBlock || declared.block->states.empty() ||
          declared.block->about.group != Group::Dynamics || declared.block->about.name == "HY_DELAY" ||
          declared.block->about.effect == "delay" || added_before(edge.prefix + language::upper(declared.field.name))) {
        continue;
      }
      const std::string instance = language::upper(declared.field.name);
      const Node* const node = find_node(base_.program->graph, edge.prefix + instance);
      for (std::size_t i = 0; i < declared.block->outputs.size(); ++i) {
        const Field& output = declared.block->outputs[i];
        if (output.type == Type::Real && may_drive(kind, node, i)) {
          result.push_back(instance + "." + std::string(output.name));
        }
      }
    }
    return result;
  }

  /// Whether an output of a block may be the velocity or position that an effect depends on.
  [[nodiscard]] bool may_drive(const EffectKind& kind, const Node* node, std::size_t output) const {
    const std::string_view unit = unit_of(node, output);
    return kind.by_velocity   ? may_be_velocity(node, output) && !is_no_velocity(unit)
           : kind.by_position ? !is_no_position(unit)
                              : true;
  }

  /// Of an output of a block, where the diagram says enough; else empty.
  [[nodiscard]] std::string_view unit_of(const Node* node, std::size_t output) const {
    return node == nullptr ? std::string_view()
                           : units_[static_cast<std::size_t>(node - base_.program->graph.nodes.data())][output];
  }

  void insert(const EffectKind& kind, const Edge& edge) {
    if (present(kind.id)) {
      return;
    }
    if (kind.auxiliaries.empty()) {
      insert(kind, edge, {});
      return;
    }
    if (!options_.loads.empty() && !edge.prefix.empty()) {
      return;
    }
    for (const std::string& driver : drivers(kind, edge)) {
      std::vector<std::pair<std::string, std::string>> wires{{kind.auxiliaries.front(), driver}};
      for (std::size_t i = 1; i < kind.auxiliaries.size() && i <= options_.loads.size(); ++i) {
        wires.emplace_back(kind.auxiliaries[i], options_.loads[i - 1]);
      }
      if (!insert(kind, edge, wires) && kind.fed_back) {
        insert(kind, edge, wires, true);
      }
    }
  }

  /// Whether an edge is an input or an output of the whole diagram.
  [[nodiscard]] bool is_port(const Edge& edge) const {
    const auto names_edge = [&](const Declared& declared) {
      return (declared.kind == Declared::Kind::Input || declared.kind == Declared::Kind::Output) &&
             find_edge(edges_, declared.field.name) == &edge;
    };
    return std::ranges::any_of(definitions_.list[index_].variables, names_edge);
  }

  /// False where the diagram refuses it. What is fed back may need a delay, or it is a loop without one.
  bool insert(const EffectKind& kind, const Edge& edge, const std::vector<std::pair<std::string, std::string>>& wires,
              bool delayed = false) {
    std::string base_name = edge.local;
    std::ranges::replace(base_name, '.', '_');
    std::ranges::replace(base_name, '[', '_');  // an element of a vector
    std::erase(base_name, ']');
    if (base_name.ends_with("_XOUT")) {
      base_name.resize(base_name.size() - 5);
    }
    const std::string instance =
        free_name(source_->blocks[edge.definition], fmt::format("{}_{}", base_name, language::upper(kind.id)));
    Candidate candidate{.kind = kind, .variant = base_};
    Applied applied{.effect = kind.id,
                    .simpler = kind.simpler,
                    .block = kind.block,
                    .edge = edge.name,
                    .at_port = is_port(edge),
                    .instance = edge.prefix + instance,
                    .wires = wires};
    Insertion insertion{
        .block = kind.block, .instance = instance, .input = kind.input, .output = kind.output, .wires = wires};
    const bool is_given = options_.driver && !wires.empty();
    if (is_given && options_.driver->is_rate) {
      applied.rate = edge.prefix + put_between("HY_DERIVATIVE", "RATE", edge, insertion);
      applied.wires.front().second += "'";
    }
    if (delayed) {
      applied.delay = edge.prefix + put_between("HY_DELAY", wires.front().first + "1", edge, insertion);
    }
    if (is_given && options_.driver->is_backwards) {
      insertion.wires.front().second.insert(0, "-");
      applied.wires.front().second.insert(0, "-");
    }
    const auto is_column = [&](const auto& wire) {
      return std::ranges::find(options_.columns, wire.second) != options_.columns.end();
    };
    if (const auto column = std::ranges::find_if(wires, is_column); column != wires.end()) {
      insertion.new_input = column->second;
    }
    candidate.variant.text = with_effect(*source_, edge, insertion);
    candidate.family = edge.name;
    for (const auto& [pin, driver] : wires) {
      candidate.family += "|" + driver;
    }
    return add(std::move(candidate), std::move(applied));
  }

  /// Puts a block between the effect's first further input and what drives it; gives the name of that block.
  std::string put_between(const std::string& block, const std::string& what, const Edge& edge,
                          Insertion& insertion) const {
    std::string name = free_name(source_->blocks[edge.definition], fmt::format("{}_{}", insertion.instance, what));
    std::string& driver = insertion.wires.front().second;
    insertion.helpers.push_back({.block = block, .instance = name, .signal = std::exchange(driver, name + ".XOUT")});
    return name;
  }

  void change_instances(const EffectKind& kind) {
    for (const BlockInstance& place : places_) {
      for (const Declared& declared : definitions_.list[place.definition].variables) {
        if (declared.kind != Declared::Kind::LibraryBlock) {
          continue;
        }
        const bool enriched = kind.change == Change::Enrich && declared.block->about.name == kind.block;
        if (declared.block->about.name != kind.enriches && !enriched) {
          continue;
        }
        const std::string instance = place.prefix + language::upper(declared.field.name);
        if (present(kind.id) || !is_neutral(kind, instance)) {
          continue;
        }
        Candidate candidate{.kind = kind, .variant = base_};
        if (kind.change == Change::Enrich && !enriched) {
          candidate.variant.text = with_block(*source_, *declared.variable, kind.block);
        }
        candidate.family = kind.of_output ? instance + ".XOUT" : instance;
        add(std::move(candidate), {.effect = kind.id,
                                   .block = kind.block,
                                   .edge = instance + ".XOUT",
                                   .is_own = (enriched || kind.change == Change::Free) && !added_before(instance),
                                   .instance = instance});
      }
    }
  }

  /// Whether an effect that an instance may have already is switched off there.
  [[nodiscard]] bool is_neutral(const EffectKind& kind, const std::string& instance) const {
    return std::ranges::all_of(kind.parameters, [&](const EffectParameter& one) {
      const auto found = find_parameter(base_.program->graph, instance + "." + one.name);
      return !one.strength || found < 0 ||
             base_.program->graph.parameters[static_cast<std::size_t>(found)].value.front() == one.field.neutral;
    });
  }

  /// False where it does not fit: a loop without delay, units that do not agree.
  bool add(Candidate candidate, Applied applied) {
    for (const EffectParameter& parameter : candidate.kind.parameters) {
      applied.parameters.push_back(parameter);
      applied.paths.push_back(applied.instance + "." + parameter.name);
    }
    const std::string instance = applied.instance;
    candidate.variant.effects.push_back(std::move(applied));
    try {
      candidate.variant.program = compiled(candidate.variant, top_);
    } catch (const InputError&) {
      return false;
    }
    const Graph& graph = candidate.variant.program->graph;
    const Node* const node = find_node(graph, instance);
    if (node != nullptr) {
      candidate.input = wire_of(graph, *node, candidate.kind.input);
      for (const std::string& pin : candidate.kind.auxiliaries) {
        const Wire wire = wire_of(graph, *node, pin);
        if (wire.from != Wire::From::Literal) {  // a further pin that stays at its default
          candidate.auxiliary.push_back(wire);
        }
      }
      const Wire changed{.from = Wire::From::Node, .index = static_cast<std::uint32_t>(node - graph.nodes.data())};
      candidate.upstream = sources_of(graph, candidate.input, changed).size();
      if (candidate.kind.of_output) {
        candidate.input = changed;
      }
      candidate.variant.effects.back().is_displaced = is_displaced(candidate);
      if (!options_.driver && !makes_sense(candidate, changed)) {
        return true;
      }
    }
    candidates_.push_back(std::move(candidate));
    return true;
  }

  /// A wire as it was before effects were added to it.
  [[nodiscard]] Wire before_effects(const Candidate& candidate, Wire wire) const {
    const Graph& graph = candidate.variant.program->graph;
    for (bool moved = true; moved;) {
      moved = false;
      for (const Applied& one : candidate.variant.effects) {
        const auto kind = std::ranges::find(kinds_, one.block, &EffectKind::block);
        if (!one.is_own && kind != kinds_.end() && wire.from == Wire::From::Node &&
            language::same_name(graph.nodes[wire.index].path, one.instance)) {
          wire = wire_of(graph, graph.nodes[wire.index], kind->input);
          moved = true;
        }
      }
    }
    return wire;
  }

  /// Whether a converter or a logger is put between two parts of the machine: where no signal is that an input gives or
  /// an output shows.
  [[nodiscard]] bool is_displaced(const Candidate& candidate) const {
    const FamilyText* const family = text_of_family(candidate.kind);
    if (candidate.kind.change != Change::Insert || family == nullptr || !family->of_a_port) {
      return false;
    }
    const Wire signal = before_effects(candidate, candidate.input);
    return signal.from != Wire::From::Input &&
           std::ranges::none_of(candidate.variant.program->graph.outputs,
                                [&](const Port& port) { return before_effects(candidate, port.wire) == signal; });
  }

  /// What is fed back comes from what the effect changes; a coupling is of another signal than the one that is there
  /// already; what is periodic in the signal itself has a position there. A load may come from anywhere.
  [[nodiscard]] static bool makes_sense(const Candidate& candidate, const Wire& changed) {
    const Program& program = *candidate.variant.program;
    const Graph& graph = program.graph;
    if (candidate.kind.by_position && candidate.auxiliary.empty() &&
        is_no_position(units::Solution(graph, program.schedule).outputs()[changed.index].front())) {
      return false;
    }
    if (candidate.auxiliary.empty()) {
      return true;
    }
    const Wire& driver = candidate.auxiliary.front();
    if (candidate.kind.by_velocity && !is_velocity(graph, driver, changed, candidate.input)) {
      return false;
    }
    return candidate.kind.fed_back
               ? depends_on(graph, driver, changed, changed)
               : driver.from != Wire::From::Input || !depends_on(graph, candidate.input, driver, changed);
  }

  const Variant& base_;
  const std::string& top_;
  const CandidateOptions& options_;
  std::shared_ptr<const language::SourceFile> source_;
  Definitions definitions_;
  std::uint32_t index_;
  std::vector<Edge> edges_;
  std::vector<BlockInstance> places_;
  std::vector<std::vector<std::string>> units_;  ///< of the base, by node and output
  std::vector<EffectKind> kinds_;
  std::vector<Candidate> candidates_{};
};

}  // namespace

const Node* find_node(const Graph& graph, std::string_view path) {
  const auto found = std::ranges::find_if(
      graph.nodes, [&](const Node& node) { return node.block != nullptr && language::same_name(node.path, path); });
  return found == graph.nodes.end() ? nullptr : &*found;
}

std::string in_the_diagram(std::string edge, const std::vector<Applied>& effects) {
  const auto of_block = [](const std::string& one, const Applied& effect) {
    return one.starts_with(effect.instance + ".");
  };
  for (bool moved = true; moved;) {
    moved = false;
    for (const Applied& other : effects) {
      if (of_block(edge, other) && !of_block(other.edge, other)) {
        edge = other.edge;
        moved = true;
      }
    }
  }
  return edge;
}

void set_parameter(Graph& graph, std::string_view path, double value) {
  if (const std::int64_t found = find_parameter(graph, path); found >= 0) {
    graph.parameters[static_cast<std::size_t>(found)].value.front() = value;
  }
}

std::shared_ptr<const Program> compiled(const Variant& variant, const std::string& top) {
  auto program = std::make_shared<Program>(
      compile_text(variant.text, {.top = top, .any_order = true, .noisy_outputs = variant.noisy_outputs}));
  for (const Applied& applied : variant.effects) {
    for (const auto& [path, value] : applied.settings) {
      set_parameter(program->graph, path, value);
    }
  }
  return program;
}

bool Applied::has(Role role) const {
  return std::ranges::any_of(parameters, [&](const EffectParameter& one) { return one.role == role; });
}

bool Applied::holds(const Applied& other) const {
  return other.effect == simpler && other.parameters.size() < parameters.size();
}

std::string Applied::path_of(FieldRole role) const {
  const auto found =
      std::ranges::find_if(parameters, [&](const EffectParameter& one) { return one.field.role == role; });
  return found == parameters.end() ? std::string() : paths[static_cast<std::size_t>(found - parameters.begin())];
}

const EffectParameter& Applied::parameter(const std::string& path) const {
  return parameters[static_cast<std::size_t>(std::ranges::find(paths, path) - paths.begin())];
}

bool Applied::has_end() const {
  const auto is_end = [](const EffectParameter& one) {
    return one.role == Role::Instant && std::isinf(one.field.preset);
  };
  return std::ranges::count(parameters, Role::Instant, &EffectParameter::role) == 2 &&
         std::ranges::count_if(parameters, is_end) == 1 &&
         std::ranges::count(parameters, true, &EffectParameter::strength) == 1;
}
bool Applied::has_gap() const {
  return std::ranges::any_of(parameters, [](const EffectParameter& one) { return is_gap(one.role); });
}

bool is_tried(const std::vector<std::string>& effects, std::string_view effect) {
  return effects.empty() || std::ranges::find(effects, effect) != effects.end();
}

std::vector<Candidate> candidates_of(const Variant& base, const std::string& top, const CandidateOptions& options) {
  return Enumeration(base, top, options).list();
}

}  // namespace hysteron::diagnosis
