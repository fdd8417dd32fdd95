#include "codegen/cosimulation/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "support/numbers.hpp"

namespace hysteron::cosimulation {
namespace {

struct TypeOfFmi {
  std::string_view name;
  Type type;
  Access access;
};

/// What a double holds exactly and DINT holds whole.
constexpr std::array types_of_fmi2{
    TypeOfFmi{"Real", Type::Real, Access::Float64},
    TypeOfFmi{"Integer", Type::Int, Access::Int32},
    TypeOfFmi{"Enumeration", Type::Int, Access::Int32},
    TypeOfFmi{"Boolean", Type::Bool, Access::Boolean},
};
constexpr std::array types_of_fmi3{
    TypeOfFmi{"Float64", Type::Real, Access::Float64}, TypeOfFmi{"Float32", Type::Real, Access::Float32},
    TypeOfFmi{"Int8", Type::Int, Access::Int8},        TypeOfFmi{"UInt8", Type::Int, Access::UInt8},
    TypeOfFmi{"Int16", Type::Int, Access::Int16},      TypeOfFmi{"UInt16", Type::Int, Access::UInt16},
    TypeOfFmi{"Int32", Type::Int, Access::Int32},      TypeOfFmi{"Enumeration", Type::Int, Access::Int64},
    TypeOfFmi{"Boolean", Type::Bool, Access::Boolean},
};

/// Each element is a pin of a block.
constexpr std::size_t most_elements = 256;

std::optional<TypeOfFmi> type_of(std::uint32_t version, std::string_view name) {
  const std::span<const TypeOfFmi> all = version == 2 ? std::span<const TypeOfFmi>(types_of_fmi2) : types_of_fmi3;
  const auto found = std::ranges::find(all, name, &TypeOfFmi::name);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

/// xs:double, or a truth value.
std::optional<double> number(std::string_view text) {
  for (const auto& [word, value] : {std::pair<std::string_view, double>{"true", 1.0},
                                    {"false", 0.0},
                                    {"INF", infinity},
                                    {"-INF", -infinity},
                                    {"NaN", not_a_number}}) {
    if (text == word) {
      return value;
    }
  }
  const ParsedNumber parsed = parse_number(text);
  return parsed.status == NumberStatus::Finite ? std::optional(parsed.value) : std::nullopt;
}

/// Numbers with spaces between them; none where one cannot be read.
std::vector<double> numbers(std::string_view text) {
  std::vector<double> list;
  while (!text.empty()) {
    const auto end = std::min(text.find_first_of(" \t\r\n"), text.size());
    if (end > 0) {
      const auto one = number(text.substr(0, end));
      if (!one) {
        return {};
      }
      list.push_back(*one);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return list;
}

/// An element by its place in the row of all, the last index running fastest: [1], [2, 3]; of a single variable none.
std::string element_text(std::span<const std::size_t> sizes, std::size_t at) {
  std::string indexes;
  for (std::size_t i = sizes.size(); i-- > 0;) {
    indexes = fmt::format("{}{}{}", at % sizes[i] + 1, indexes.empty() ? "" : ",", indexes);
    at /= sizes[i];
  }
  return indexes.empty() ? std::string() : "[" + indexes + "]";
}

class Reader {
 public:
  explicit Reader(std::string_view xml) {
    const pugi::xml_parse_result result = document_.load_buffer(xml.data(), xml.size());
    if (!result) {
      throw std::runtime_error(fmt::format("its modelDescription.xml is no XML: {}", result.description()));
    }
    root_ = document_.child("fmiModelDescription");
  }

  Description read() {
    read_head();
    read_types();
    for (const pugi::xml_node node : root_.child("ModelVariables").children()) {
      if (node.type() == pugi::node_element) {
        read_variable(node);
      }
    }
    return std::move(result_);
  }

 private:
  void read_head() {
    if (!root_) {
      throw std::runtime_error("its modelDescription.xml has no fmiModelDescription");
    }
    const std::string version = root_.attribute("fmiVersion").value();
    if (version != "2.0" && !version.starts_with("3.0")) {
      throw std::runtime_error(fmt::format("it is one of FMI {}, and FMI 2.0 and 3.0 are read here",
                                           version.empty() ? std::string("1.0 or older") : version));
    }
    result_.version = version == "2.0" ? 2 : 3;
    const pugi::xml_node simulation = root_.child("CoSimulation");
    if (!simulation) {
      throw std::runtime_error(!root_.child("ModelExchange").empty()
                                   ? "it offers model exchange alone, and has no solver of its own"
                                   : "it offers no co-simulation");
    }
    if (simulation.attribute("needsExecutionTool").as_bool()) {
      throw std::runtime_error("it needs the tool that made it to be run (needsExecutionTool)");
    }
    result_.model_name = root_.attribute("modelName").value();
    result_.meaning = root_.attribute("description").value();
    result_.tool = root_.attribute("generationTool").value();
    result_.token = root_.attribute(result_.version == 2 ? "guid" : "instantiationToken").value();
    result_.model_identifier = simulation.attribute("modelIdentifier").value();
    const bool file_name = !result_.model_identifier.empty() &&
                           result_.model_identifier.find_first_of("/\\") == std::string::npos &&
                           result_.model_identifier.size() < 256 && result_.token.size() < longest_path;
    if (!file_name) {
      throw std::runtime_error("its modelIdentifier is not the name of a file");
    }
    result_.once_per_process = simulation.attribute("canBeInstantiatedOnlyOncePerProcess").as_bool();
    result_.internal_step = number(simulation.attribute("fixedInternalStepSize").value()).value_or(0.0);
  }

  void read_types() {
    for (const pugi::xml_node node : root_.child("TypeDefinitions").children()) {
      types_.emplace_back(node.attribute("name").value(), result_.version == 2 ? node.first_child() : node);
    }
  }

  /// The attribute of a variable, else that of the type that it is declared with.
  [[nodiscard]] std::string attribute(pugi::xml_node node, const char* name) const {
    if (const pugi::xml_attribute own = node.attribute(name)) {
      return own.value();
    }
    const std::string_view declared = node.attribute("declaredType").value();
    for (const auto& [type, of_type] : types_) {
      if (!declared.empty() && type == declared) {
        return of_type.attribute(name).value();
      }
    }
    return {};
  }

  void read_variable(pugi::xml_node node) {
    const std::string causality = node.attribute("causality").value();
    std::vector<ModelVariable>* const list = causality == "input"       ? &result_.inputs
                                             : causality == "output"    ? &result_.outputs
                                             : causality == "parameter" ? &result_.parameters
                                                                        : nullptr;
    if (list == nullptr) {
      return;
    }
    const pugi::xml_node typed = result_.version == 2 ? node.first_child() : node;
    ModelVariable one;
    one.name = node.attribute("name").value();
    const auto leave_out = [&](std::string reason) { result_.left_out.push_back({one.name, std::move(reason)}); };
    const auto type = type_of(result_.version, typed.name());
    if (!type) {
      leave_out(fmt::format("its type is {}", typed.name()));
      return;
    }
    std::vector<std::size_t> sizes;
    std::size_t elements = 1;
    for (const pugi::xml_node dimension : node.children("Dimension")) {
      sizes.push_back(dimension.attribute("start").as_ullong());
      if (sizes.back() == 0) {
        leave_out("a parameter of its own sets the size of this array");
        return;
      }
      elements = std::min(elements * std::min(sizes.back(), most_elements + 1), most_elements + 1);
    }
    if (elements > most_elements) {
      leave_out(fmt::format("it is an array of more than {} elements", most_elements));
      return;
    }
    one.type = type->type;
    one.access = type->access;
    one.reference = node.attribute("valueReference").as_uint();
    one.meaning = node.attribute("description").value();
    one.unit = attribute(typed, "unit");
    one.minimum = number(attribute(typed, "min")).value_or(-infinity);
    one.maximum = number(attribute(typed, "max")).value_or(infinity);
    const std::vector<double> starts = numbers(typed.attribute("start").value());
    if (starts.empty() && causality == "parameter") {
      leave_out("it states no start value");
      return;
    }
    if (starts.size() > 1 && starts.size() != elements) {
      leave_out(fmt::format("it has {} start values for {} elements", starts.size(), elements));
      return;
    }
    // The FMU means its start values, whatever its bounds say.
    if (!std::ranges::all_of(starts, [&](double start) { return !(start < one.minimum || start > one.maximum); })) {
      one.minimum = -infinity;
      one.maximum = infinity;
    }
    const std::string name = one.name;
    for (std::size_t i = 0; i < elements; ++i) {
      one.name = name + element_text(sizes, i);
      one.start = starts.empty() ? 0.0 : starts[starts.size() == 1 ? 0 : i];
      one.goes_on = i > 0;
      list->push_back(one);
    }
  }

  pugi::xml_document document_;
  pugi::xml_node root_;
  std::vector<std::pair<std::string, pugi::xml_node>> types_;
  Description result_;
};

}  // namespace

Description parse_description(std::string_view xml) {
  return Reader(xml).read();
}

}  // namespace hysteron::cosimulation
