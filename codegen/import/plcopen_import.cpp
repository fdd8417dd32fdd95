#include "codegen/import/plcopen_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/import/drawing.hpp"
#include "codegen/import/network_text.hpp"
#include "codegen/import/types.hpp"
#include "codegen/plcopen/tc6.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

using import::DrawnPou;
using import::DrawnVariable;

/// Words of a documentation as a comment of a declaration: our own annotations as they stand, others as @doc.
std::string comment_of(const std::string& remark) {
  std::string text;
  for (const char c : remark) {
    const bool blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
    if (blank && (text.empty() || text.back() == ' ')) {
      continue;
    }
    text += blank ? ' ' : c;
  }
  for (const std::string_view mark : {"(*", "*)"}) {
    for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark)) {
      text.erase(at, mark.size());
    }
  }
  if (text.empty() || text.starts_with('@')) {
    return text;
  }
  std::erase(text, '@');
  return "@doc " + text;
}

class Importer {
 public:
  Importer(const std::string& file, const std::vector<DrawnPou>& project, const ImportOptions& options,
           Diagnostics& warnings)
      : file_(file), project_(project), options_(options), warnings_(warnings) {
    for (const DrawnPou& pou : project) {
      if (find_block_type(pou.name) == nullptr && pou.kind == tc6::function_block) {
        own_.emplace(in_capitals(pou.name), &pou);
      }
    }
    targets_ = import::targets_of_all(file, own_);
  }

  std::string run() {
    std::string text;
    for (const DrawnPou& pou : project_) {
      if (is_wanted(pou)) {
        text += (text.empty() ? "" : "\n") + text_of(pou);
      }
    }
    if (refused_.has_errors()) {
      throw InputError(std::move(refused_));
    }
    if (text.empty()) {
      throw InputError(error::untranslatable_element, {.file = file_},
                       options_.pou.empty() ? "The project has no function block, and no program that is drawn."
                                            : fmt::format("The project has no POU {}.", options_.pou),
                       fmt::format("choose one by --pou NAME: {}.", names()));
    }
    Diagnostics ignored;
    return format_text(file_, text, ignored, {.any_order = true});
  }

 private:
  [[nodiscard]] std::string names() const {
    std::string list;
    for (const DrawnPou& pou : project_) {
      list += (list.empty() ? "" : ", ") + pou.name;
    }
    return list;
  }

  /// Blocks of the library come along in what we export, and so does a program that only calls one block.
  [[nodiscard]] bool is_wanted(const DrawnPou& pou) const {
    if (find_block_type(pou.name) != nullptr) {
      return false;
    }
    if (!options_.pou.empty()) {
      return equal_ignoring_case(pou.name, options_.pou) || is_called(pou.name, options_.pou, 0);
    }
    return pou.kind == tc6::function_block || (pou.kind == tc6::program && pou.language != tc6::structured_text);
  }

  [[nodiscard]] bool is_called(const std::string& name, const std::string& by, std::size_t depth) const {
    if (depth > project_.size()) {
      return false;
    }
    for (const DrawnPou& pou : project_) {
      for (std::size_t i = 0; equal_ignoring_case(pou.name, by) && i < pou.variables.size(); ++i) {
        const std::string& type = pou.variables[i].type;
        if (equal_ignoring_case(type, name) || (own_.contains(in_capitals(type)) && is_called(name, type, depth + 1))) {
          return true;
        }
      }
    }
    return false;
  }

  void refuse(std::uint32_t line, std::string cause, std::string mend) {
    refused_.error(error::untranslatable_element, {.file = file_, .line = line, .column = 1}, std::move(cause),
                   std::move(mend));
  }

  /// Whether a name can stand in a text.
  bool is_good_name(const std::string& name, std::uint32_t line) {
    const auto is_letter = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    const bool good = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
                      std::ranges::all_of(name, is_letter);
    if (!good) {
      refuse(line, fmt::format("\"{}\" is no name of IEC 61131-3", name.substr(0, 60)), "Rename it in the editor.");
    }
    return good;
  }

  std::string text_of(const DrawnPou& pou) {
    if (!is_good_name(pou.name, pou.line)) {
      return "";
    }
    tell_of_both(pou);
    std::string remark = comment_of(pou.remark);
    if (remark.find("@ts") == std::string::npos) {
      if (const std::string cycle = cycle_of(pou); !cycle.empty()) {
        remark = fmt::format("@ts {}{}{}", cycle, remark.empty() ? "" : " ", remark);
      }
    }
    if (pou.language == tc6::structured_text) {
      return fmt::format("FUNCTION_BLOCK {}{}\n{}\n{}\nEND_FUNCTION_BLOCK\n", pou.name, comment(remark),
                         declarations(pou, nullptr), pou.text);
    }
    if (pou.language != tc6::function_diagram && pou.language != tc6::ladder_diagram) {
      refuse(pou.line,
             fmt::format("{} is written in {}", pou.name, pou.language.empty() ? "no language" : pou.language),
             "Only FBD, LD and ST are read. Let the editor turn it into one of them.");
      return "";
    }
    import::NetworkText network;
    try {
      network = import::text_of_network(file_, pou, own_, targets_);
    } catch (const InputError& error) {
      refused_.add_all(error.diagnostics());
      return "";
    }
    tell_of_equal_orders(pou);
    return fmt::format("FUNCTION_BLOCK {}{}\n{}\n{}END_FUNCTION_BLOCK\n", pou.name, comment(remark),
                       declarations(pou, &network), network.statements);
  }

  static std::string comment(const std::string& remark) {
    return remark.empty() ? "" : fmt::format("  (* {} *)", remark);
  }

  [[nodiscard]] std::string cycle_of(const DrawnPou& pou) const {
    if (!options_.cycle.empty()) {
      return options_.cycle;
    }
    const auto seconds = import::seconds_of(pou.cycle);
    constexpr double nanoseconds = 1e9;
    return seconds && *seconds > 0.0 ? fmt::format("{:.0f}ns", *seconds * nanoseconds) : "";
  }

  // --- declarations ---

  std::string declarations(const DrawnPou& pou, const import::NetworkText* network) {
    using Section = DrawnVariable::Section;
    std::string text;
    for (const auto& [section, keyword] : {std::pair{Section::Input, "VAR_INPUT"},
                                           {Section::Output, "VAR_OUTPUT"},
                                           {Section::Both, "VAR_IN_OUT"},
                                           {Section::Constant, "VAR CONSTANT"},
                                           {Section::Local, "VAR"}}) {
      std::string lines;
      for (const DrawnVariable& variable : network != nullptr ? apart(pou, *network) : pou.variables) {
        if (variable.section == section && is_good_name(variable.name, variable.line)) {
          lines += network != nullptr ? declaration(pou, variable, *network) : plain_declaration(variable);
        }
      }
      if (section == Section::Local && network != nullptr) {
        lines += network->locals;
      }
      if (!lines.empty()) {
        text += fmt::format("  {}\n{}  END_VAR\n", keyword, lines);
      }
    }
    return text;
  }

  /// A network has inputs and outputs alone: what is both becomes one of each, as far as it is read and assigned.
  static std::vector<DrawnVariable> apart(const DrawnPou& pou, const import::NetworkText& network) {
    using Section = DrawnVariable::Section;
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
      return std::ranges::find(names, in_capitals(name)) != names.end();
    };
    std::vector<DrawnVariable> list;
    for (const DrawnVariable& one : pou.variables) {
      if (one.section != Section::Both) {
        list.push_back(one);
        continue;
      }
      DrawnVariable variable = one;
      const bool assigned = has(network.assigned, import::name_of_output(one));
      if (!assigned || !one.external || has(network.taken_in, one.name)) {
        variable.section = Section::Input;
        list.push_back(variable);
      }
      if (assigned) {
        variable.section = Section::Output;
        variable.name = import::name_of_output(one);
        variable.initial.clear();
        list.push_back(variable);
      }
    }
    return list;
  }

  /// What is of the project or of the caller has to be wired where the block is called.
  void tell_of_both(const DrawnPou& pou) {
    for (const DrawnVariable& one : pou.variables) {
      if (one.section == DrawnVariable::Section::Both) {
        warnings_.warning(error::untranslatable_element, {.file = file_, .line = one.line, .column = 1},
                          fmt::format("{} of {} is {}: its value comes in by {}, and its new value goes out by {}",
                                      one.name, pou.name, one.external ? "a variable of the project" : "a VAR_IN_OUT",
                                      one.name, import::name_of_output(one)),
                          "Wire both where the block is called.");
      }
    }
  }

  /// An order is one element's alone; of equal ones the wires say more than the number.
  void tell_of_equal_orders(const DrawnPou& pou) {
    std::map<std::uint64_t, std::vector<const import::DrawnElement*>> by_order;
    for (const import::DrawnElement& one : pou.elements) {
      if (import::is_executed(one) && one.order) {
        by_order[*one.order].push_back(&one);
      }
    }
    for (const auto& [order, elements] : by_order) {
      if (elements.size() > 1) {
        warnings_.warning(
            error::untranslatable_element, {.file = file_, .line = elements[1]->line, .column = 1},
            fmt::format("localId {} of {} has executionOrderId {}, as localId {} has: of equal ones, what "
                        "feeds another runs before it",
                        elements[1]->id, pou.name, order, elements[0]->id),
            "Give each a number of its own where another order is meant.");
      }
    }
  }

  [[nodiscard]] std::string type_of(const std::string& type) const {
    if (import::known_type(type)) {
      return in_capitals(type);
    }
    const BlockType* const block = own_.contains(in_capitals(type)) ? nullptr : import::known_block(type);
    return block != nullptr ? std::string(block->about.name) : type;
  }

  /// For a text as body: types as they are, which the compiler judges.
  [[nodiscard]] std::string plain_declaration(const DrawnVariable& variable) const {
    const std::string remark = comment_of(variable.remark);
    return fmt::format("    {} : {}{};{}\n", variable.name, type_of(variable.type),
                       variable.initial.empty() ? "" : " := " + variable.initial, comment(remark));
  }

  std::string declaration(const DrawnPou& pou, const DrawnVariable& variable, const import::NetworkText& network) {
    const std::string key = in_capitals(variable.name);
    const auto known = import::known_type(variable.type);
    if (!known) {
      const bool is_block = own_.contains(in_capitals(variable.type)) || import::known_block(variable.type) != nullptr;
      if (!is_block) {
        refuse(variable.line,
               fmt::format("{} of {} is of type {}, which no diagram has", variable.name, pou.name, variable.type),
               "Use LREAL, REAL, DINT, INT, BOOL, WORD, TIME, an array of one of them, or a function block.");
        return "";
      }
      const bool called = std::ranges::find(network.called, key) != network.called.end();
      return called ? fmt::format("    {} : {};{}\n", variable.name, type_of(variable.type),
                                  comment(comment_of(variable.remark)))
                    : "";  // declared, and never drawn
    }
    if (!known->note.empty()) {
      warnings_.warning(error::untranslatable_element, {.file = file_, .line = variable.line, .column = 1},
                        fmt::format("{} of {} is a {}: {}", variable.name, pou.name, variable.type, known->note),
                        "Compare what both compute.");
    }
    std::string initial = import::with_known_literals(variable.initial);
    const bool assigned = std::ranges::find(network.assigned, key) != network.assigned.end();
    if (assigned) {
      initial.clear();  // its first value is that of the delay, where one reads it
    } else if (initial.empty() && variable.section != DrawnVariable::Section::Input) {
      initial = literal_text(known->carried.type, 0.0);
    }
    return fmt::format("    {} : {}{};{}\n", variable.name, import::declared_text(known->carried),
                       initial.empty() ? "" : " := " + value_text(known->carried, initial),
                       comment(comment_of(variable.remark)));
  }

  /// A first value as a text has it; of a vector the list, in which what is not given is 0.
  static std::string value_text(const import::Carried& carried, const std::string& initial) {
    if (!carried.is_vector()) {
      return import::real_text(carried.type, initial);
    }
    const std::vector<std::string> given = import::elements_of_list(initial);
    std::string list;
    for (std::int64_t place = carried.low; place <= carried.high; ++place) {
      const auto at = static_cast<std::size_t>(place - carried.low);
      list += (list.empty() ? "" : ", ") +
              (at < given.size() ? import::real_text(carried.type, given[at]) : literal_text(carried.type, 0.0));
    }
    return "[" + list + "]";
  }

  const std::string& file_;
  const std::vector<DrawnPou>& project_;
  const ImportOptions& options_;
  Diagnostics& warnings_;
  Diagnostics refused_;
  import::OwnBlocks own_;
  import::Targets targets_;
};

}  // namespace

std::string import_plcopen(const std::string& file, const std::string& xml, const ImportOptions& options,
                           Diagnostics& warnings) {
  const std::vector<DrawnPou> project = import::read_project(file, xml);
  return Importer(file, project, options, warnings).run();
}

}  // namespace hysteron
