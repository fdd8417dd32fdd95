#include "codegen/backends/fmu/model_description.hpp"

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/graph/unit.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

constexpr double zero_celsius = 273.15;  // K

void set(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
}
void set(pugi::xml_node node, const char* name, const char* value) {
  node.append_attribute(name).set_value(value);
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream stream;
  document.save(stream, "  ", pugi::format_indent, pugi::encoding_utf8);
  return stream.str();
}

pugi::xml_node begin(pugi::xml_document& document, const char* root) {
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  set(declaration, "version", "1.0");
  set(declaration, "encoding", "UTF-8");
  return document.append_child(root);
}

/// As xs:double spells it.
std::string number(double value) {
  return value == infinity ? "INF" : value == -infinity ? "-INF" : value != value ? "NaN" : number_text(value);
}

/// FMI knows whole powers of the SI's bases and of the radian. A unit beyond is a name without a meaning there.
void describe_unit(pugi::xml_node node, const std::string& text) {
  std::string reason;
  const auto unit = units::parse_unit(text, reason);
  const auto whole = [](const units::Fraction& power) { return power.under == 1; };
  if (!unit || !std::ranges::all_of(unit->powers, whole)) {
    return;
  }
  constexpr std::size_t kelvin = 4;
  constexpr std::size_t celsius = 5;
  constexpr std::array<const char*, units::dimensions> bases{"m", "kg", "s", "A", "K", "", "mol", "cd"};
  auto powers = unit->powers;
  const bool temperature =
      powers[celsius].over == 1 && std::ranges::count_if(powers, [](const auto& power) { return !power.zero(); }) == 1;
  powers[kelvin] = powers[kelvin] + powers[celsius];  // a difference of 1 °C is one of 1 K
  powers[celsius] = {};
  pugi::xml_node base = node.append_child("BaseUnit");
  for (std::size_t i = 0; i < bases.size(); ++i) {
    if (!powers[i].zero()) {
      base.append_attribute(bases[i]).set_value(powers[i].over);
    }
  }
  if (const auto& power = powers[units::radians]; !power.zero()) {
    base.append_attribute("rad").set_value(power.over);
  }
  if (unit->factor != 1.0) {
    set(base, "factor", number(unit->factor));
  }
  if (temperature) {
    set(base, "offset", number(zero_celsius));
  }
}

/// FMI gives a unit to floating-point variables alone.
bool has_unit(const FmuVariable& variable) {
  return variable.type == Type::Real && !variable.unit.empty();
}

void add_units(pugi::xml_node root, std::span<const FmuVariable> variables) {
  std::vector<std::string> names;
  for (const FmuVariable& one : variables) {
    if (has_unit(one)) {
      names.push_back(one.unit);
    }
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (names.empty()) {
    return;
  }
  pugi::xml_node list = root.append_child("UnitDefinitions");
  for (const std::string& name : names) {
    pugi::xml_node unit = list.append_child("Unit");
    set(unit, "name", name);
    describe_unit(unit, name);
  }
}

/// Of an array, its elements one after the other.
std::string start_text(const FmuVariable& one, const FmuOptions& options) {
  std::string text;
  for (const double start : one.start) {
    text += text.empty() ? "" : " ";
    if (one.type == Type::Bool) {
      text += start != 0.0 ? "true" : "false";
    } else {
      const bool single = one.type == Type::Real && options.float32 && start - start == 0.0;
      text += single ? number_text(static_cast<float>(start)) : number(start);
    }
  }
  return text;
}

void add_type_attributes(pugi::xml_node node, const FmuVariable& one, const FmuOptions& options) {
  if (has_unit(one)) {
    set(node, "unit", one.unit);
  }
  double low = one.minimum;
  double high = one.maximum;
  if (one.type == Type::Word && options.version == FmiVersion::Two) {  // an Integer there
    low = std::max(low, 0.0);
    high = std::min(high, 65535.0);
  }
  if (one.type != Type::Bool && low > -infinity) {
    set(node, "min", number(low));
  }
  if (one.type != Type::Bool && high < infinity) {
    set(node, "max", number(high));
  }
  if (one.role != FmuVariable::Role::Output) {
    set(node, "start", start_text(one, options));
  }
}

/// An output changes at samples alone; a real input may be a signal that never rests.
void add_role(pugi::xml_node node, const FmuVariable& one) {
  switch (one.role) {
    case FmuVariable::Role::Input:
      set(node, "causality", "input");
      set(node, "variability", one.type == Type::Real ? "continuous" : "discrete");
      break;
    case FmuVariable::Role::Output:
      set(node, "causality", "output");
      set(node, "variability", "discrete");
      set(node, "initial", "calculated");
      break;
    case FmuVariable::Role::Parameter:
      set(node, "causality", "parameter");
      set(node, "variability", "tunable");
      set(node, "initial", "exact");
      break;
  }
  if (!one.meaning.empty()) {
    set(node, "description", one.meaning);
  }
}

void add_variables(pugi::xml_node root, std::span<const FmuVariable> variables, const FmuOptions& options) {
  const bool three = options.version == FmiVersion::Three;
  pugi::xml_node list = root.append_child("ModelVariables");
  if (three) {
    pugi::xml_node time = list.append_child("Float64");
    set(time, "name", "time");
    set(time, "valueReference", "0");
    set(time, "causality", "independent");
    set(time, "variability", "continuous");
  }
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const FmuVariable& one = variables[i];
    pugi::xml_node node = list.append_child(three ? fmi_type_name(one.type, options) : "ScalarVariable");
    set(node, "name", one.name);
    set(node, "valueReference", std::to_string(i + 1));
    add_role(node, one);
    add_type_attributes(three ? node : node.append_child(fmi_type_name(one.type, options)), one, options);
    if (one.array) {
      set(node.append_child("Dimension"), "start", std::to_string(one.start.size()));
    }
  }
}

/// Each output depends on what FMI assumes where nothing is said: on every input.
void add_structure(pugi::xml_node root, std::span<const FmuVariable> variables, FmiVersion version) {
  const bool three = version == FmiVersion::Three;
  pugi::xml_node structure = root.append_child("ModelStructure");
  for (const char* const kind : {"Output", "InitialUnknown"}) {
    pugi::xml_node list = structure;
    for (std::size_t i = 0; i < variables.size(); ++i) {
      if (variables[i].role != FmuVariable::Role::Output) {
        continue;
      }
      if (!three && list == structure) {
        list = structure.append_child((std::string(kind) + "s").c_str());
      }
      // FMI 2.0 counts the variables of the file, where the first is 1: the same number.
      set(list.append_child(three ? kind : "Unknown"), three ? "valueReference" : "index", std::to_string(i + 1));
    }
  }
}

}  // namespace

const char* fmi_type_name(Type type, const FmuOptions& options) {
  const bool three = options.version == FmiVersion::Three;
  switch (type) {
    case Type::Real:
      return !three ? "Real" : options.float32 ? "Float32" : "Float64";
    case Type::Bool:
      return "Boolean";
    case Type::Int:
      return three ? "Int32" : "Integer";
    default:
      return three ? "UInt16" : "Integer";
  }
}

std::string model_description(const FmuModel& model, std::span<const FmuVariable> variables,
                              std::span<const std::string> sources, const FmuOptions& options) {
  const bool three = options.version == FmiVersion::Three;
  pugi::xml_document document;
  pugi::xml_node root = begin(document, "fmiModelDescription");
  set(root, "fmiVersion", three ? "3.0" : "2.0");
  set(root, "generationTool", "Hysteron");
  set(root, "modelName", model.name);
  set(root, three ? "instantiationToken" : "guid", model.token);
  set(root, "variableNamingConvention", "structured");

  pugi::xml_node simulation = root.append_child("CoSimulation");
  set(simulation, "modelIdentifier", model.identifier);
  set(simulation, three ? "canGetAndSetFMUState" : "canGetAndSetFMUstate", "true");
  set(simulation, three ? "canSerializeFMUState" : "canSerializeFMUstate", "true");
  set(simulation, "canHandleVariableCommunicationStepSize", "true");
  if (three) {
    set(simulation, "fixedInternalStepSize", number(model.sample_time));
  } else {
    set(simulation, "canNotUseMemoryManagementFunctions", "true");
    pugi::xml_node files = simulation.append_child("SourceFiles");
    for (const std::string& source : sources) {
      set(files.append_child("File"), "name", source);
    }
  }
  add_units(root, variables);
  pugi::xml_node category = root.append_child("LogCategories").append_child("Category");
  set(category, "name", "logStatusError");
  set(category, "description", "why a call was refused");
  set(root.append_child("DefaultExperiment"), "stepSize", number(model.sample_time));
  add_variables(root, variables, options);
  add_structure(root, variables, options.version);
  return text_of(document);
}

std::string build_description(const FmuModel& model, std::span<const std::string> sources) {
  pugi::xml_document document;
  pugi::xml_node root = begin(document, "fmiBuildDescription");
  set(root, "fmiVersion", "3.0");
  pugi::xml_node configuration = root.append_child("BuildConfiguration");
  set(configuration, "modelIdentifier", model.identifier);
  pugi::xml_node files = configuration.append_child("SourceFileSet");
  set(files, "language", "C99");
  set(files, "compilerOptions", std::string(cpp_numeric_flags));
  for (const std::string& source : sources) {
    set(files.append_child("SourceFile"), "name", source);
  }
  pugi::xml_node library = configuration.append_child("Library");
  set(library, "name", "m");
  return text_of(document);
}

}  // namespace hysteron
