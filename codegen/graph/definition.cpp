#include "codegen/graph/definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <tuple>

#include "codegen/graph/body/body.hpp"
#include "codegen/graph/call_order.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/graph/other_names.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/graph/vectors.hpp"
#include "codegen/language/annotation.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

using language::Annotation;
using language::SourceFile;
using language::upper;
using language::Variable;

using Keys = std::span<const std::string_view>;
constexpr std::array<std::string_view, 7> input_keys{"unit", "min", "max", "param", "neutral", "role", "doc"};
constexpr std::array<std::string_view, 2> value_keys{"unit", "doc"};
constexpr std::array<std::string_view, 3> instance_keys{"every", "phase", "doc"};
constexpr std::array<std::string_view, 4> fmu_keys{"file", "every", "phase", "doc"};
constexpr std::array<std::string_view, 5> block_keys{"ts", "effect", "family", "doc", "body"};

std::string known_keys(Keys keys) {
  std::string text;
  for (const auto key : keys) {
    text += (text.empty() ? "@" : ", @") + std::string(key);
  }
  return text;
}

bool is_of_library(std::string_view name) {
  return find_block_type(name) != nullptr || find_sized_kind(name) != nullptr ||
         language::same_name(name, fmu_type_name);
}

bool number_of(std::string_view text, double& value) {
  const auto* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  return problem == std::errc{} && stop == end && !std::isnan(value);
}

class Reader {
 public:
  Reader(Definitions& definitions, Diagnostics& diagnostics)
      : definitions_(definitions), source_(*definitions.source), diagnostics_(diagnostics) {}

  void read_all() {
    // A text for a PLC brings the library along; where all is executed from top to bottom, its own blocks are meant.
    const bool only_bodies = std::ranges::all_of(source_.blocks, &language::FunctionBlock::sequential);
    for (const auto& block : source_.blocks) {
      const auto index = static_cast<std::uint32_t>(definitions_.list.size());
      Definition& definition = definitions_.list.emplace_back();
      definition.block = &block;
      if (!block.sequential) {  // what PLC compilers have inside, a library of blocks may define
        check_name(block.name);
      }
      if (is_of_library(block.name.text) && !only_bodies) {
        error(error::duplicate_name, block.name.span, fmt::format("'{}' is a block of the library", block.name.text),
              "Choose another name; names that begin with HY_ belong to the library.");
      }
      if (!definitions_.by_name.add(block.name.text, index)) {
        error(error::duplicate_name, block.name.span, fmt::format("the block '{}' is defined twice", block.name.text),
              "Rename one of the two.");
      }
    }
    find_in_place();
    for (std::uint32_t index = 0; index < definitions_.list.size(); ++index) {
      Definition& definition = definitions_.list[index];
      if (definition.block->sequential) {
        read_sequential(definition, is_in_place(index));
      } else {
        read(definition);
      }
    }
    sort_by_calls(definitions_, diagnostics_);
  }

 private:
  void error(int number, language::Span span, std::string cause, std::string mend) {
    diagnostics_.error(number, source_.place(span), std::move(cause), std::move(mend));
  }

  void check_name(const language::Name& name) {
    if (is_reserved(name.text)) {
      error(error::reserved_name, name.span, fmt::format("'{}' is a name that IEC 61131-3 keeps for itself", name.text),
            "Choose another name, such as " + upper(name.text) + "_1.");
    }
  }

  void read(Definition& definition) {
    read_head(definition);
    definition.variables.reserve(definition.block->variables.size());
    definition.by_name.reserve(definition.block->variables.size());
    for (const Variable& variable : definition.block->variables) {
      add_variable(definition, variable, variable.name.text, [&] { return declare(variable); });
    }
  }

  template <class Declare>
  void add_variable(Definition& definition, const Variable& variable, std::string_view name, Declare declare) {
    if (!definition.block->sequential) {
      check_name({name, variable.name.span});
    }
    if (is_of_library(name)) {
      error(error::reserved_name, variable.name.span, fmt::format("'{}' is a block of the library", name),
            "Choose another name; names that begin with HY_ belong to the library.");
    }
    if (!definition.by_name.add(name, static_cast<std::uint32_t>(definition.variables.size()))) {
      error(error::duplicate_name, variable.name.span, fmt::format("'{}' is declared twice", name),
            "Rename one of the two; upper and lower case do not differ.");
    }
    definition.variables.push_back(declare());
  }

  /// What another body executes in place may have arrays at its border: they are variables of that body.
  [[nodiscard]] bool is_in_place(std::uint32_t index) const {
    return std::ranges::any_of(definitions_.list, [&](const Definition& one) {
      return std::ranges::find(one.in_place, index) != one.in_place.end();
    });
  }

  /// Of a sequential body: the border. What is inside of it, the body knows.
  void read_sequential(Definition& definition, bool in_place) {
    read_head(definition);
    Graph scratch;
    GraphBuilder builder(scratch);
    const auto report = [&](int number, language::Span span, std::string cause, std::string mend) {
      if (number == error::other_meaning_elsewhere) {
        return;  // told when the body is executed
      }
      definition.usable = false;
      error(number, span, std::move(cause), std::move(mend));
    };
    bodies::Body body(*source_.bodies, source_.bodies->units[definition.block->body],
                      {.builder = builder, .report = report, .add_parameter = [](const auto&) { return Wire{}; }});
    for (const bodies::BorderPort& port : body.ports(in_place)) {
      const Variable& variable = definition.block->variables[port.declaration];
      if (in_place && port.within && definition.by_name.contains(upper(port.name))) {
        continue;  // the caller names the member itself
      }
      add_variable(definition, variable, port.name, [&] { return declare_border(variable, port, false); });
      if (!port.output.empty()) {
        add_variable(definition, variable, port.output, [&] { return declare_border(variable, port, true); });
      }
    }
  }

  Declared declare_border(const Variable& variable, const bodies::BorderPort& port, bool output) {
    Declared declared{.variable = &variable};
    declared.field.name = definitions_.names.emplace_back(output ? port.output : port.name);
    declared.port = upper(port.name);
    declared.field.type = bodies::info(port.type).carrier;
    declared.field.preset = port.initial;
    declared.has_preset = true;  // IEC 61131-3: what is not connected has its initial value
    output = output || port.role == language::body::Role::Output;
    declared.kind = output ? Declared::Kind::Output : Declared::Kind::Input;
    if (!output || port.role == language::body::Role::Output) {
      check_keys(variable.annotations, output ? Keys(value_keys) : Keys(input_keys));
    }
    if (port.range && !output) {
      std::tie(declared.field.minimum, declared.field.maximum) = *port.range;
    }
    for (const Annotation& annotation : variable.annotations) {
      if (!port.within || declared.field.type == Type::Real || language::same_name(annotation.key, "doc")) {
        annotate(annotation, false, declared);  // those of a structure hold for the numbers in it
      }
    }
    check_role(variable, declared);
    return declared;
  }

  /// Which blocks of the file each body executes in place.
  void find_in_place() {
    for (Definition& definition : definitions_.list) {
      if (!definition.block->sequential) {
        continue;
      }
      for (const Variable& variable : definition.block->variables) {
        if (const std::uint32_t* const found = definitions_.by_name.find(variable.type.text)) {
          definition.in_place.push_back(*found);
        }
      }
    }
  }

  void read_head(Definition& definition) {
    definition.sample_time_span = definition.block->name.span;
    check_keys(definition.block->annotations, block_keys);
    for (const Annotation& annotation : definition.block->annotations) {
      const std::string key = language::upper(annotation.key);
      if (key == "TS") {
        definition.sample_time_span = annotation.span;
        if (!language::duration_of(annotation.value, definition.sample_time_ns)) {
          error(error::bad_annotation, annotation.span, fmt::format("'{}' is not a sample time", annotation.value),
                "Write a positive whole number of nanoseconds with its unit: @ts 50us, @ts 1ms, @ts 0.5s.");
        }
      } else if (key == "EFFECT") {
        definition.effect = annotation.value;
      } else if (key == "FAMILY") {
        take_family(annotation, definition);
      }
    }
  }

  void take_family(const Annotation& annotation, Definition& definition) {
    const auto is_effect = [](const Annotation& one) { return language::same_name(one.key, "effect"); };
    if (std::ranges::none_of(definition.block->annotations, is_effect)) {
      error(error::bad_annotation, annotation.span, "@family speaks of an effect, and the block names none",
            "Name the effect: @effect sag.");
    }
    if (const auto* const family =
            one_of(family_texts, annotation, "a family of effects", "; without @family the effect is one by itself")) {
      definition.family = family->name;
    }
  }

  /// Of texts the one that an annotation names; null, and an error that lists them, where it names none.
  template <class Text, std::size_t Count>
  const Text* one_of(const std::array<Text, Count>& texts, const Annotation& annotation, std::string_view what,
                     std::string_view otherwise) {
    std::string names;
    for (const auto& one : texts) {
      if constexpr (requires { one.stated; }) {
        if (!one.stated) {
          continue;
        }
      }
      if (language::same_name(one.name, annotation.value)) {
        return &one;
      }
      names += fmt::format("{}{}", names.empty() ? "" : ", ", one.name);
    }
    error(error::bad_annotation, annotation.span, fmt::format("'{}' is not {}", annotation.value, what),
          fmt::format("Write one of {}{}.", names, otherwise));
    return nullptr;
  }

  Declared declare(const Variable& variable) {
    Declared declared;
    declared.variable = &variable;
    declared.field.name = variable.name.text;
    if (elementary_type(variable.type.text, declared.field.type)) {
      declare_elementary(variable, declared);
    } else if (const BlockType* block = find_block_type(variable.type.text)) {
      declared.kind = Declared::Kind::LibraryBlock;
      declared.block = block;
    } else if (const BlockType* sized = find_sized_block(variable.type.text)) {
      declared.kind = Declared::Kind::LibraryBlock;
      declared.block = sized;
    } else if (find_sized_kind(variable.type.text) != nullptr) {
      declared.kind = Declared::Kind::Unknown;  // its sizes do not agree, which has been told
    } else if (language::same_name(variable.type.text, fmu_type_name)) {
      declare_fmu(variable, declared);
    } else if (const std::uint32_t* const found = definitions_.by_name.find(variable.type.text)) {
      declared.kind = Declared::Kind::UserBlock;
      declared.definition = *found;
    } else {
      unknown_type(variable);
      declared.kind = Declared::Kind::Unknown;  // one fault, one message: whatever names it is passed over
    }
    const bool instance = declared.kind == Declared::Kind::LibraryBlock || declared.kind == Declared::Kind::UserBlock;
    if (instance && variable.section != language::Section::Local) {
      error(error::type_mismatch, variable.type.span,
            fmt::format("the instance '{}' stands among inputs, outputs or constants", variable.name.text),
            "Declare instances between VAR and END_VAR.");
    }
    if (declared.kind != Declared::Kind::Unknown) {  // of which nobody knows what it is
      const bool input = declared.kind == Declared::Kind::Input;
      check_keys(variable.annotations, declared.block != nullptr && declared.block->fmu != nullptr ? Keys(fmu_keys)
                                       : instance                                                  ? Keys(instance_keys)
                                       : input                                                     ? Keys(input_keys)
                                                                                                   : Keys(value_keys));
      for (const Annotation& annotation : variable.annotations) {
        annotate(annotation, instance, declared);
      }
      check_role(variable, declared);
    }
    if (declared.rate.phase >= declared.rate.every) {
      error(error::bad_annotation, variable.name.span,
            fmt::format("@phase {} is not below @every {}", declared.rate.phase, declared.rate.every),
            "Give a phase from 0 to every − 1.");
      declared.rate.phase = 0;
    }
    const Field& field = declared.field;
    if (field.minimum > field.maximum) {
      error(error::bad_annotation, variable.name.span,
            fmt::format("@min {} is above @max {}", field.minimum, field.maximum), "Write the lower bound as @min.");
    } else if (!instance && declared.has_preset && (field.preset < field.minimum || field.preset > field.maximum)) {
      error(error::parameter_out_of_range, variable.name.span,
            fmt::format("the default {} of '{}' lies outside its range", field.preset, field.name),
            fmt::format("Give a value from {} to {}.", field.minimum, field.maximum));
    }
    return declared;
  }

  /// The file is named as seen from the folder of the diagram.
  void declare_fmu(const Variable& variable, Declared& declared) {
    declared.kind = Declared::Kind::Unknown;
    const auto file = std::ranges::find_if(variable.annotations, [](const Annotation& one) {
      return language::same_name(one.key, "file") && !one.value.empty();
    });
    if (file == variable.annotations.end()) {
      error(error::unusable_fmu, variable.name.span, fmt::format("the FMU '{}' names no file", variable.name.text),
            fmt::format("Write it beside the declaration: {} : HY_FMU;  (* @file motor.fmu *)", variable.name.text));
      return;
    }
    try {
      declared.block = &fmu_block(fmu_path(source_, file->value));
      declared.kind = Declared::Kind::LibraryBlock;
    } catch (const InputError& problem) {
      for (const Diagnostic& one : problem.diagnostics().all()) {
        error(one.number, file->span, one.cause, one.mend);
      }
    }
  }

  void declare_elementary(const Variable& variable, Declared& declared) {
    using language::Section;
    switch (variable.section) {
      case Section::Input:
        declared.kind = Declared::Kind::Input;
        break;
      case Section::Output:
        declared.kind = Declared::Kind::Output;
        break;
      case Section::Local:
        declared.kind = Declared::Kind::Local;
        break;
      case Section::Constant:
        declared.kind = Declared::Kind::Constant;
        break;
    }
    if (variable.initial != language::no_expression) {
      Type type = Type::Real;
      const auto span = source_.expressions[variable.initial].span;
      if (!constant_value(source_, variable.initial, declared.field.preset, type)) {
        error(error::type_mismatch, span,
              fmt::format("the initial value of '{}' is not a constant", variable.name.text),
              "Write a literal or an operation on literals.");
      } else if (type != declared.field.type) {
        error(error::type_mismatch, span,
              fmt::format("'{}' is {}, its initial value is {}", variable.name.text, type_name(declared.field.type),
                          type_name(type)),
              fmt::format("Write {}.", literal_text(declared.field.type, declared.field.preset)));
      }
      declared.has_preset = true;
    } else if (variable.section == Section::Constant) {
      error(error::undriven_output, variable.name.span,
            fmt::format("the constant '{}' has no value", variable.name.text), "Give it one: := 1.0.");
    }
  }

  void annotate(const Annotation& annotation, bool instance, Declared& declared) {
    const std::string key = language::upper(annotation.key);
    Field& field = declared.field;
    const auto number = [&](double& target) {
      if (!number_of(annotation.value, target)) {
        error(error::bad_annotation, annotation.span, fmt::format("'{}' is not a number", annotation.value),
              fmt::format("Write @{} and a number.", annotation.key));
      }
    };
    if (key == "DOC") {
      field.meaning = annotation.value;
    } else if (instance && (key == "EVERY" || key == "PHASE")) {
      double value = 0.0;
      if (!number_of(annotation.value, value) || value != std::floor(value) || value < (key == "EVERY" ? 1.0 : 0.0) ||
          value > 1e6) {
        error(error::bad_annotation, annotation.span, fmt::format("'{}' is not a number of steps", annotation.value),
              key == "EVERY" ? "Write a whole number from 1 to 1000000: @every 4."
                             : "Write a whole number from 0 on, below that of @every: @phase 1.");
      } else {
        (key == "EVERY" ? declared.rate.every : declared.rate.phase) = static_cast<std::uint32_t>(value);
      }
    } else if (!instance && key == "UNIT") {
      field.unit = annotation.value;
      std::string reason;
      if (!units::is_unit(annotation.value, reason)) {
        error(error::unknown_unit, annotation.span, fmt::format("'{}' is not a unit: {}", annotation.value, reason),
              "Write SI symbols: um, V, m/s, N*m, 1/K, degC, % or 1.");
        field.unit = {};
      }
    } else if (is_input(declared) && key == "MIN") {
      number(field.minimum);
    } else if (is_input(declared) && key == "MAX") {
      number(field.maximum);
    } else if (is_input(declared) && key == "NEUTRAL") {
      number(field.neutral);
      declared.kind = Declared::Kind::Parameter;
    } else if (is_input(declared) && key == "PARAM") {
      declared.kind = Declared::Kind::Parameter;
    } else if (is_input(declared) && key == "ROLE") {
      const RoleText* const role = one_of(role_texts, annotation, "a role", "");
      field.role = role != nullptr ? role->role : field.role;
    }
  }

  /// A role says what a parameter is for; a signal has none.
  void check_role(const Variable& variable, const Declared& declared) {
    if (declared.field.role != FieldRole::Number &&
        (declared.kind != Declared::Kind::Parameter || declared.field.type != Type::Real)) {
      error(error::bad_annotation, variable.name.span,
            fmt::format("'{}' has a @role and is no parameter of type LREAL", declared.field.name),
            "Add @param, or leave @role out.");
    }
  }

  static bool is_input(const Declared& declared) {
    return declared.kind == Declared::Kind::Input || declared.kind == Declared::Kind::Parameter;
  }

  /// Refuses annotations that do not fit, and a second one of a kind: it would contradict the first, or say nothing.
  void check_keys(const std::vector<Annotation>& annotations, Keys keys) {
    for (std::size_t i = 0; i < annotations.size(); ++i) {
      const Annotation& one = annotations[i];
      const auto is_same = [&](std::string_view key) { return language::same_name(key, one.key); };
      if (std::ranges::none_of(keys, is_same)) {
        error(error::bad_annotation, one.span, fmt::format("@{} is not an annotation that fits here", one.key),
              fmt::format("Known here: {}.", known_keys(keys)));
        continue;
      }
      const auto before = annotations.begin() + static_cast<std::ptrdiff_t>(i);
      const auto first = std::find_if(annotations.begin(), before, [&](const Annotation& a) { return is_same(a.key); });
      if (first != before) {
        diagnostics_.error(error::bad_annotation, source_.place(one.span), fmt::format("@{} is given twice", one.key),
                           "Keep one of the two.", {{source_.place(first->span), "the other is here"}});
      }
    }
  }

  void unknown_type(const Variable& variable) {
    std::string mend = "`hysteron blocks` lists the library; other types are LREAL, BOOL, DINT and WORD.";
    if (is_one_of(variable.type.text,
                  {"REAL", "INT", "UINT", "UDINT", "SINT", "LINT", "TIME", "LTIME", "STRING", "BYTE", "DWORD"})) {
      mend = "Use LREAL for numbers and for seconds, DINT for counts, BOOL for truth values.";
    } else if (const std::string near = nearest_block(variable.type.text); !near.empty()) {
      mend = fmt::format("Did you mean {}? `hysteron blocks` lists the library.", near);
    }
    error(error::unknown_block, variable.type.span, fmt::format("there is no block or type '{}'", variable.type.text),
          mend);
  }

  std::string nearest_block(std::string_view name) const;

  Definitions& definitions_;
  const SourceFile& source_;
  Diagnostics& diagnostics_;
};

std::string Reader::nearest_block(std::string_view name) const {
  std::string prefixed = "HY_" + upper(name);
  if (find_block_type(prefixed) != nullptr) {
    return prefixed;
  }
  if (const std::string_view block = block_of_other_name(name); !block.empty()) {
    return std::string(block);
  }
  std::vector<std::string_view> candidates;
  for (const BlockType* const type : documented_blocks()) {
    candidates.push_back(type->about.name);
  }
  for (const Definition& definition : definitions_.list) {
    candidates.push_back(definition.block->name.text);
  }
  return std::string(nearest_name(name, candidates));
}

}  // namespace

Definitions define(std::shared_ptr<const language::SourceFile> source, Diagnostics& diagnostics) {
  Definitions definitions;
  Diagnostics of_vectors;
  definitions.source = expand_vectors(std::move(source), of_vectors);
  Reader(definitions, diagnostics).read_all();
  if (of_vectors.has_errors()) {  // what could not become elements is missing in the text
    std::ranges::for_each(definitions.list, [](Definition& one) { one.usable = false; });
  }
  diagnostics.add_all(of_vectors);
  return definitions;
}

}  // namespace hysteron
