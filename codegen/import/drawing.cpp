#include "codegen/import/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <pugixml.hpp>
#include <string_view>

#include "codegen/plcopen/tc6.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"
#include "support/whole_number.hpp"

namespace hysteron::import {
namespace {

using pugi::xml_node;

constexpr std::size_t largest_file = 32U << 20U;
constexpr std::size_t most_elements = 20'000;  ///< of a network

/// Without the prefix of its namespace.
std::string_view local_name(const char* name) {
  const std::string_view whole(name);
  const auto colon = whole.find(':');
  return colon == std::string_view::npos ? whole : whole.substr(colon + 1);
}

bool is(xml_node node, std::string_view name) {
  return node.type() == pugi::node_element && local_name(node.name()) == name;
}

xml_node child(xml_node parent, std::string_view name) {
  for (const xml_node one : parent.children()) {
    if (is(one, name)) {
      return one;
    }
  }
  return {};
}

template <class Visit>
void for_each(xml_node parent, std::string_view name, const Visit& visit) {
  for (const xml_node one : parent.children()) {
    if (is(one, name)) {
      visit(one);
    }
  }
}

/// LREAL, ARRAY [0..9] OF LREAL, or the name of a type of the project. Empty where the element is none of these.
std::string type_text(xml_node type) {
  if (is(type, tc6::derived)) {
    return type.attribute(tc6::name).value();
  }
  if (!is(type, tc6::array)) {
    return std::string(local_name(type.name()));
  }
  std::string bounds;
  std::string base;
  for_each(type, tc6::dimension, [&](xml_node one) {
    bounds += fmt::format("{}{}..{}", bounds.empty() ? "" : ", ", one.attribute("lower").value(),
                          one.attribute("upper").value());
  });
  for (const xml_node inner : child(type, tc6::base_type).children()) {
    if (inner.type() == pugi::node_element && !is(inner, tc6::array)) {
      base = type_text(inner);
    }
  }
  return bounds.empty() || base.empty() ? std::string() : fmt::format("ARRAY [{}] OF {}", bounds, base);
}

/// All text below a node. Without recursion, since a hostile file nests as deep as it likes.
std::string text_below(xml_node top) {
  std::string text;
  xml_node node = top.first_child();
  while (node) {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
      text += node.value();
    }
    if (!node.first_child().empty()) {
      node = node.first_child();
      continue;
    }
    while (node != top && !node.next_sibling()) {
      node = node.parent();
    }
    if (node == top) {
      break;
    }
    node = node.next_sibling();
  }
  return text;
}

/// What stands in XML is often broken into lines.
std::string without_blanks(std::string_view text) {
  return std::string(trimmed(text, " \t\r\n"));
}

template <class Number>
Number number_of(const char* text) {
  Number value{};
  const std::string_view view(text);
  std::from_chars(view.data(), view.data() + view.size(), value);
  return value;
}

std::optional<std::uint64_t> stated_number(const char* text) {
  return whole_number<std::uint64_t>(trimmed(text, " \t\r\n"));
}

/// Some editors count from 0; others write 0 on each element whose place nobody chose. An order is one element's alone:
/// where several have 0, it means nothing.
void forget_unchosen_orders(std::vector<DrawnElement>& elements) {
  const auto says_zero = [](const DrawnElement& one) { return is_executed(one) && one.order == 0U; };
  if (std::ranges::count_if(elements, says_zero) > 1) {
    for (DrawnElement& one : elements) {
      one.order = one.order == 0U ? std::nullopt : one.order;
    }
  }
}

class ProjectReader {
 public:
  ProjectReader(const std::string& file, const std::string& text) : file_(file), text_(text) {}

  std::vector<DrawnPou> run() {
    if (text_.size() > largest_file) {
      throw refusal(0, fmt::format("{} bytes are more than a project has", text_.size()),
                    fmt::format("Export the POUs alone; {} bytes are the most that are read.", largest_file));
    }
    pugi::xml_document document;
    const auto result = document.load_buffer(text_.data(), text_.size());
    if (!result) {
      throw result.status == pugi::status_no_document_element
          ? refusal(0, "there is no XML element in it", "Export the file again; nothing arrived in it.")
          : refusal(line_at(result.offset), fmt::format("the XML ends being XML here: {}", result.description()),
                    "Export the file again; it may have been cut.");
    }
    const xml_node project = child(document.root(), tc6::project);
    const xml_node pous = child(child(project, tc6::types), tc6::pous);
    if (!pous) {
      throw refusal(1, fmt::format("there is no {}/{}/{} in it", tc6::project, tc6::types, tc6::pous),
                    "Export the project, or a POU of it, as PLCopen XML (TC6).");
    }
    read_cycles(project);
    std::vector<DrawnPou> list;
    for_each(pous, tc6::pou, [&](xml_node pou) { list.push_back(read_pou(pou)); });
    if (list.empty()) {
      throw refusal(line_of(pous), "the project has no POU", "Choose at least one POU for the export.");
    }
    return list;
  }

 private:
  [[nodiscard]] InputError refusal(std::uint32_t line, std::string cause, std::string mend,
                                   int number = error::not_plcopen) const {
    return InputError(number, {.file = file_, .line = line, .column = line == 0 ? 0U : 1U}, std::move(cause),
                      std::move(mend));
  }

  [[nodiscard]] std::uint32_t line_at(std::ptrdiff_t offset) const {
    const auto end = std::min(text_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    while (counted_ < end) {
      line_ += text_[counted_++] == '\n' ? 1U : 0U;
    }
    if (counted_ > end) {  // back: the nodes are mostly asked for in their order
      counted_ = 0;
      line_ = 1;
      return line_at(offset);
    }
    return line_;
  }
  [[nodiscard]] std::uint32_t line_of(xml_node node) const { return line_at(node.offset_debug()); }

  void read_cycles(xml_node project) {
    for_each(child(child(project, tc6::instances), tc6::configurations), tc6::configuration, [&](xml_node one) {
      for_each(one, tc6::resource, [&](xml_node resource) {
        for_each(resource, tc6::task, [&](xml_node task) {
          for_each(task, tc6::pou_instance, [&](xml_node instance) {
            cycles_[in_capitals(instance.attribute(tc6::type_name).value())] = task.attribute(tc6::interval).value();
          });
        });
      });
    });
  }

  // --- a POU ---

  DrawnPou read_pou(xml_node node) {
    DrawnPou pou{.name = node.attribute(tc6::name).value(),
                 .kind = node.attribute(tc6::pou_type).value(),
                 .remark = without_blanks(text_below(child(node, tc6::documentation))),
                 .line = line_of(node)};
    const auto cycle = cycles_.find(in_capitals(pou.name));
    pou.cycle = cycle == cycles_.end() ? "" : cycle->second;
    const xml_node interface = child(node, tc6::interface);
    using Section = DrawnVariable::Section;
    for (const xml_node list : interface.children()) {
      const std::string_view name = local_name(list.name());
      if (name == tc6::input_vars) {
        read_variables(list, Section::Input, pou);
      } else if (name == tc6::output_vars) {
        read_variables(list, Section::Output, pou);
      } else if (name == tc6::in_out_vars || name == tc6::external_vars) {
        read_variables(list, Section::Both, pou);
      } else if (name == tc6::local_vars || name == tc6::temporary_vars) {
        read_variables(list, list.attribute(tc6::constant).as_bool() ? Section::Constant : Section::Local, pou);
      } else if (name.ends_with("Vars") && !list.first_child().empty()) {
        throw refusal(line_of(list), fmt::format("{} has {}, which no diagram has", pou.name, name),
                      "Make them inputs and outputs of the POU.", error::untranslatable_element);
      }
    }
    for (const xml_node body : child(node, tc6::body).children()) {
      if (body.type() == pugi::node_element && pou.language.empty()) {
        pou.language = local_name(body.name());
        if (pou.language == tc6::structured_text) {
          pou.text = text_below(body);
        } else if (pou.language == tc6::function_diagram || pou.language == tc6::ladder_diagram) {
          read_network(body, pou);
        }
      }
    }
    return pou;
  }

  /// 1.5, or [1.5, 2.5] of an array; a question mark for what is neither.
  static std::string initial_of(xml_node value) {
    if (const xml_node simple = child(value, tc6::simple_value)) {
      return without_blanks(simple.attribute(tc6::value).value());
    }
    if (const xml_node array = child(value, tc6::array_value)) {
      std::string elements;
      for_each(array, tc6::value, [&](xml_node one) {
        elements += fmt::format("{}{}", elements.empty() ? "" : ", ",
                                child(one, tc6::simple_value).attribute(tc6::value).value());
      });
      return "[" + elements + "]";
    }
    return value.first_child() ? "?" : "";
  }

  void read_variables(xml_node list, DrawnVariable::Section section, DrawnPou& pou) {
    for_each(list, tc6::variable, [&](xml_node node) {
      DrawnVariable variable{.section = section,
                             .external = is(list, tc6::external_vars),
                             .name = node.attribute(tc6::name).value(),
                             .initial = initial_of(child(node, tc6::initial_value)),
                             .remark = without_blanks(text_below(child(node, tc6::documentation))),
                             .line = line_of(node)};
      const std::string_view address = node.attribute("address").value();
      if (section == DrawnVariable::Section::Local && address.starts_with("%I")) {
        variable.section = DrawnVariable::Section::Input;
      } else if (section == DrawnVariable::Section::Local && address.starts_with("%Q")) {
        variable.section = DrawnVariable::Section::Output;
      }
      for (const xml_node type : child(node, tc6::type).children()) {
        if (type.type() == pugi::node_element && variable.type.empty()) {
          variable.type = type_text(type);
        }
      }
      pou.variables.push_back(std::move(variable));
    });
  }

  // --- its network ---

  void read_network(xml_node body, DrawnPou& pou) {
    for (const xml_node node : body.children()) {
      if (node.type() != pugi::node_element) {
        continue;
      }
      if (pou.elements.size() == most_elements) {
        throw refusal(line_of(node), fmt::format("{} has more than {} elements", pou.name, most_elements),
                      "Divide it into several POUs.");
      }
      pou.elements.push_back(read_element(node));
    }
    forget_unchosen_orders(pou.elements);
    name_what_is_handed_over(pou);
  }

  /// A VAR_IN_OUT of a block has the variable that it is wired to as its expression.
  static void name_what_is_handed_over(DrawnPou& pou) {
    std::map<std::uint64_t, std::string> variables;
    for (const DrawnElement& one : pou.elements) {
      if ((one.kind == tc6::in_variable || one.kind == tc6::in_out_variable) && !one.negated) {
        variables.emplace(one.id, one.text);
      }
    }
    for (DrawnElement& element : pou.elements) {
      for (DrawnPin& pin : element.both) {
        const auto found =
            pin.links.size() == 1 && !pin.negated ? variables.find(pin.links.front().element) : variables.end();
        if (found != variables.end()) {
          pin.expression = found->second;
          pin.links.clear();
        }
      }
    }
  }

  DrawnElement read_element(xml_node node) {
    DrawnElement element{.kind = std::string(local_name(node.name())),
                         .id = number_of<std::uint64_t>(node.attribute(tc6::local_id).value()),
                         .order = stated_number(node.attribute(tc6::execution_order).value()),
                         .instance = node.attribute(tc6::instance_name).value(),
                         .storage = node.attribute(tc6::storage).value(),
                         .edge = node.attribute(tc6::edge).value(),
                         .line = line_of(node)};
    if (const auto order = node.attribute(tc6::execution_order); order && !element.order) {
      element.unread_order = fmt::format("\"{}\"", std::string_view(order.value()).substr(0, 60));
    }
    element.negated = truth_of(node, tc6::negated, element.unread) ||
                      truth_of(node, tc6::negated_out, element.unread);  // of what is read and assigned
    if (truth_of(node, tc6::negated_in, element.unread)) {
      element.unread.push_back(fmt::format("{}=\"true\"", tc6::negated_in));
    }
    const xml_node position = child(node, tc6::position);
    element.x = position.attribute("x").as_double();
    element.y = position.attribute("y").as_double();
    if (element.kind == tc6::block) {
      element.text = node.attribute(tc6::type_name).value();
      read_pins(child(node, tc6::input_variables), element.inputs, element.unread);
      read_pins(child(node, tc6::output_variables), element.outputs, element.unread);
      read_pins(child(node, tc6::in_out_variables), element.both, element.unread);
      return element;
    }
    for (const char* const name : {tc6::expression, tc6::variable}) {
      const xml_node text = child(node, name);
      element.text = text ? without_blanks(text_below(text)) : element.text;
    }
    if (element.kind == tc6::vendor_element) {
      read_pins(child(node, tc6::input_variables), element.inputs, element.unread);
      read_pins(child(node, tc6::output_variables), element.outputs, element.unread);
      return element;
    }
    if (element.kind == tc6::connector || element.kind == tc6::continuation) {
      element.text = node.attribute(tc6::name).value();
    }
    for_each(node, tc6::point_in, [&](xml_node point) {
      if (element.inputs.empty()) {
        element.inputs.emplace_back();
      }
      read_point(point, element.inputs.front());
    });
    return element;
  }

  /// TRUE or FALSE of an attribute; where it is neither, that is noted.
  static bool truth_of(xml_node node, const char* name, std::vector<std::string>& unread) {
    const std::string_view value = node.attribute(name).value();
    const bool yes = equal_ignoring_case(value, "true") || value == "1";
    if (!yes && !value.empty() && !equal_ignoring_case(value, "false") && value != "0") {
      unread.push_back(fmt::format("{}=\"{}\"", name, value.substr(0, 60)));
    }
    return yes;
  }

  static void read_pins(xml_node list, std::vector<DrawnPin>& pins, std::vector<std::string>& unread) {
    for_each(list, tc6::variable, [&](xml_node node) {
      DrawnPin pin{.name = without_blanks(node.attribute(tc6::formal_parameter).value()),
                   .negated = truth_of(node, tc6::negated, unread),
                   .storage = node.attribute(tc6::storage).value()};
      const std::string_view edge = node.attribute(tc6::edge).value();
      pin.edge = !edge.empty() && edge != "none";
      read_point(child(node, tc6::point_in), pin);
      pins.push_back(std::move(pin));
    });
  }

  static void read_point(xml_node point, DrawnPin& pin) {
    for_each(point, tc6::connection, [&](xml_node one) {
      pin.links.push_back({.element = number_of<std::uint64_t>(one.attribute(tc6::reference).value()),
                           .pin = without_blanks(one.attribute(tc6::formal_parameter).value())});
    });
    pin.expression = without_blanks(text_below(child(point, tc6::expression)));
  }

  const std::string& file_;
  const std::string& text_;
  std::map<std::string, std::string> cycles_;  ///< by POU, in capitals
  mutable std::size_t counted_ = 0;
  mutable std::uint32_t line_ = 1;
};

}  // namespace

bool is_executed(const DrawnElement& element) {
  return element.kind == tc6::block || element.kind == tc6::out_variable || element.kind == tc6::coil;
}

const DrawnElement* find_element(const DrawnPou& pou, std::uint64_t id) {
  const auto found = std::ranges::find(pou.elements, id, &DrawnElement::id);
  return found == pou.elements.end() ? nullptr : &*found;
}

const DrawnVariable* find_variable(const DrawnPou& pou, std::string_view name) {
  const auto found = std::ranges::find_if(
      pou.variables, [&](const DrawnVariable& one) { return equal_ignoring_case(one.name, name); });
  return found == pou.variables.end() ? nullptr : &*found;
}

std::vector<DrawnPou> read_project(const std::string& file, const std::string& text) {
  return ProjectReader(file, text).run();
}

}  // namespace hysteron::import
