#include "diagnosis/effects/edges.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <variant>

#include "support/element_name.hpp"

namespace hysteron::diagnosis {
namespace {

using language::ExpressionId;
using language::Span;

/// A place that reads a signal.
struct Read {
  Span span{};
  std::string consumer{};  ///< the pin or variable, where it takes the signal as it is; else empty
};

/// The edges of one FUNCTION_BLOCK, by local names.
class BlockEdges {
 public:
  BlockEdges(const Definitions& definitions, std::uint32_t index)
      : definitions_(definitions), source_(*definitions.source), definition_(definitions.list[index]), index_(index) {
    for (const language::Statement& statement : definition_.block->statements) {
      if (const auto* const call = std::get_if<language::Call>(&statement)) {
        take_call(*call);
      } else {
        take_assignment(std::get<language::Assignment>(statement));
      }
    }
  }

  [[nodiscard]] std::vector<Edge> list() const {
    std::vector<Edge> result;
    for (const auto& [name, reads] : reads_) {
      if (of_vectors_.contains(name)) {
        continue;
      }
      Edge edge{.name = name, .definition = index_, .local = name, .source = name};
      for (const Read& read : reads) {
        edge.reads.push_back(read.span);
      }
      if (reads.size() == 1 && !is_output(name)) {
        if (!reads.front().consumer.empty()) {
          edge.aliases.push_back(reads.front().consumer);
        }
        result.push_back(std::move(edge));
        continue;
      }
      result.push_back(std::move(edge));
      for (const Read& read : reads) {  // one branch of several; an output's port is one that the text does not show
        if (!read.consumer.empty()) {
          result.push_back({.name = read.consumer,
                            .definition = index_,
                            .local = read.consumer,
                            .source = name,
                            .reads = {read.span}});
        }
      }
    }
    for (const auto& [name, span] : computed_) {
      result.push_back({.name = name,
                        .definition = index_,
                        .local = name,
                        .source = std::string(source_.text_of(span)),
                        .reads = {span}});
    }
    return joined(std::move(result));
  }

 private:
  [[nodiscard]] const Declared* find(std::string_view name) const {
    const std::uint32_t* const found = definition_.by_name.find(name);
    return found == nullptr ? nullptr : &definition_.variables[*found];
  }

  /// An output of the block itself, which the world reads as well.
  [[nodiscard]] bool is_output(std::string_view name) const {
    const Declared* const declared = find(name);
    return declared != nullptr && declared->kind == Declared::Kind::Output;
  }

  /// Whether a name with a pin is an LREAL signal of this block: an input, a variable, an output of an instance.
  [[nodiscard]] bool is_signal(const language::Reference& reference) const {
    const Declared* const declared = find(reference.name.text);
    if (declared == nullptr) {
      return false;
    }
    switch (declared->kind) {
      case Declared::Kind::Input:
      case Declared::Kind::Output:
      case Declared::Kind::Local:
        return reference.pin.text.empty() && declared->field.type == Type::Real;
      case Declared::Kind::LibraryBlock:
        return std::ranges::any_of(declared->block->outputs, [&](const Field& field) {
          return field.type == Type::Real && language::same_name(field.name, reference.pin.text);
        });
      case Declared::Kind::UserBlock:
        return std::ranges::any_of(definitions_.list[declared->definition].variables, [&](const Declared& inner) {
          return inner.kind == Declared::Kind::Output && inner.field.type == Type::Real &&
                 language::same_name(inner.field.name, reference.pin.text);
        });
      case Declared::Kind::Parameter:
      case Declared::Kind::Constant:
      case Declared::Kind::Unknown:
        return false;
    }
    return false;
  }

  /// Whether a pin of an instance takes a signal that may be changed: LREAL and no parameter.
  [[nodiscard]] bool is_signal_pin(std::string_view instance, std::string_view pin) const {
    const Declared* const declared = find(instance);
    if (declared == nullptr) {
      return false;
    }
    if (declared->kind == Declared::Kind::LibraryBlock) {
      return std::ranges::any_of(declared->block->inputs, [&](const Field& field) {
        return field.type == Type::Real && language::same_name(field.name, pin);
      });
    }
    if (declared->kind == Declared::Kind::UserBlock) {
      return std::ranges::any_of(definitions_.list[declared->definition].variables, [&](const Declared& inner) {
        return inner.kind == Declared::Kind::Input && inner.field.type == Type::Real &&
               language::same_name(inner.field.name, pin);
      });
    }
    return false;
  }

  [[nodiscard]] static std::string full_name(const language::Reference& reference) {
    std::string name = language::upper(reference.name.text);
    if (!reference.pin.text.empty()) {
      name += "." + language::upper(reference.pin.text);
    }
    return name;
  }

  /// A vector of the text is read by all of its elements at one place, which no edit of one of them can hold; one value
  /// that stands for every element is read there once.
  void take_read(const std::string& name, const Read& read) {
    if (element_of(name) && !source_.text_of(read.span).ends_with(']')) {
      of_vectors_.insert(name);
    }
    std::vector<Read>& reads = reads_[name];
    if (std::ranges::none_of(reads, [&](const Read& one) { return one.span.offset == read.span.offset; })) {
      reads.push_back(read);
    }
  }

  /// Whether a target is a whole vector in the text, of which one element is looked at here.
  [[nodiscard]] bool is_of_vector(const language::Name& target) const {
    const std::size_t behind = source_.text->find_first_not_of(" \t\r\n", target.span.offset + target.span.length);
    return element_of(target.text) && (behind == std::string::npos || (*source_.text)[behind] != '[');
  }

  /// Notes every signal that an expression reads. `consumer` names what takes the value of the whole expression.
  /// Returns how many were read.
  std::size_t take_reads(ExpressionId id, const std::string& consumer) {
    if (id == language::no_expression) {
      return 0;
    }
    const language::Expression& expression = source_.expressions[id];
    std::size_t count = 0;
    if (const auto* const reference = std::get_if<language::Reference>(&expression.node)) {
      if (is_signal(*reference)) {
        take_read(full_name(*reference), {.span = expression.span, .consumer = consumer});
        count = 1;
      }
    } else if (const auto* const unary = std::get_if<language::Unary>(&expression.node)) {
      count = take_reads(unary->operand, {});
    } else if (const auto* const binary = std::get_if<language::Binary>(&expression.node)) {
      count = take_reads(binary->left, {}) + take_reads(binary->right, {});
    } else if (const auto* const call = std::get_if<language::FunctionCall>(&expression.node)) {
      for (const language::FunctionArgument& argument : call->arguments) {
        count += take_reads(argument.value, {});
      }
    }
    return count;
  }

  [[nodiscard]] bool is_bare(ExpressionId id) const {
    return std::holds_alternative<language::Reference>(source_.expressions[id].node);
  }

  void take_call(const language::Call& call) {
    for (const language::Argument& argument : call.arguments) {
      const bool signal = is_signal_pin(call.instance.text, argument.pin.text);
      const std::string pin = language::upper(call.instance.text) + "." + language::upper(argument.pin.text);
      const std::size_t count = take_reads(argument.value, signal ? pin : std::string());
      if (signal && count > 0 && !is_bare(argument.value) && !is_of_vector(argument.pin)) {
        computed_.emplace(pin, source_.expressions[argument.value].span);
      }
    }
  }

  void take_assignment(const language::Assignment& assignment) {
    const Declared* const target = find(assignment.target.text);
    const bool signal = target != nullptr && target->field.type == Type::Real;
    const std::string name = language::upper(assignment.target.text);
    const std::size_t count = take_reads(assignment.value, signal ? name : std::string());
    if (signal && count > 0 && !is_bare(assignment.value) && !is_of_vector(assignment.target)) {
      computed_.emplace(name, source_.expressions[assignment.value].span);
    }
  }

  /// One edge for each wire: a variable that only renames a signal, or that is computed in one place, is its alias.
  [[nodiscard]] static std::vector<Edge> joined(std::vector<Edge> list) {
    std::map<std::string, std::size_t> places;
    std::vector<bool> gone(list.size(), false);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto [found, first] = places.emplace(list[i].name, i);
      if (first) {
        continue;
      }
      Edge& kept = list[found->second];
      if (list[i].source != kept.name) {  // nearer to where the signal is computed
        kept.source = list[i].source;
        kept.reads = list[i].reads;
      }
      gone[i] = true;
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
      for (std::size_t k = 0; !gone[i] && k < list[i].aliases.size(); ++k) {  // grows while it is walked through
        const auto found = places.find(list[i].aliases[k]);
        if (found == places.end() || found->second == i || gone[found->second]) {
          continue;
        }
        gone[found->second] = true;
        for (const std::string& alias : list[found->second].aliases) {
          list[i].aliases.push_back(alias);
        }
      }
    }
    std::vector<Edge> result;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!gone[i]) {
        result.push_back(std::move(list[i]));
      }
    }
    return result;
  }

  const Definitions& definitions_;
  const language::SourceFile& source_;
  const Definition& definition_;
  std::uint32_t index_;
  std::map<std::string, std::vector<Read>> reads_{};
  std::map<std::string, Span> computed_{};
  std::set<std::string> of_vectors_{};  ///< elements that are read as a part of their vector
};

void add_instances(const Definitions& definitions, std::uint32_t index, const std::string& prefix,
                   std::vector<BlockInstance>& instances) {
  instances.push_back({.definition = index, .prefix = prefix});
  for (const Declared& declared : definitions.list[index].variables) {
    if (declared.kind == Declared::Kind::UserBlock) {
      add_instances(definitions, declared.definition, prefix + language::upper(declared.field.name) + ".", instances);
    }
  }
}

}  // namespace

std::vector<BlockInstance> instances_of(const Definitions& definitions, std::uint32_t top) {
  std::vector<BlockInstance> instances;
  add_instances(definitions, top, {}, instances);
  return instances;
}

std::vector<Edge> edges_of(const Definitions& definitions, std::uint32_t top) {
  std::vector<Edge> edges;
  std::set<std::string> taken;
  for (const BlockInstance& instance : instances_of(definitions, top)) {
    for (Edge& edge : BlockEdges(definitions, instance.definition).list()) {
      edge.prefix = instance.prefix;
      edge.name.insert(0, instance.prefix);
      for (std::string& alias : edge.aliases) {
        alias.insert(0, instance.prefix);
      }
      // The pin of an instance, seen from outside, is the input of the block, seen from inside.
      if (taken.contains(edge.name)) {
        continue;
      }
      taken.insert(edge.name);
      taken.insert(edge.aliases.begin(), edge.aliases.end());
      edges.push_back(std::move(edge));
    }
  }
  return edges;
}

std::uint32_t top_definition(const Definitions& definitions, std::string_view name) {
  const std::uint32_t* const found = definitions.by_name.find(name);
  return found == nullptr ? 0 : *found;
}

const Edge* find_edge(const std::vector<Edge>& edges, std::string_view name) {
  for (const Edge& edge : edges) {
    const bool is_alias =
        std::ranges::any_of(edge.aliases, [&](const std::string& alias) { return language::same_name(alias, name); });
    if (language::same_name(edge.name, name) || is_alias) {
      return &edge;
    }
  }
  return nullptr;
}

std::vector<Edge> edges_of_text(const std::string& text, std::string_view top) {
  Diagnostics none;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", text, none));
  const Definitions definitions = define(source, none);
  return edges_of(definitions, top_definition(definitions, top));
}

}  // namespace hysteron::diagnosis
