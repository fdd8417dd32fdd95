#include "codegen/backends/c_family/names.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "codegen/backends/c_family/c_library_names.hpp"
#include "codegen/backends/c_family/words.hpp"
#include "codegen/backends/shared/port_groups.hpp"
#include "support/element_name.hpp"

namespace hysteron {

std::string field_identifier(std::string_view name) {
  std::string text = identifier_text({name}, LetterCase::Lower);
  return std::ranges::find(cpp_keywords, text) == cpp_keywords.end() ? text : text + "_2";
}

std::string namespace_identifier(std::string_view name) {
  static const std::unordered_set<std::string_view> taken = [] {
    std::unordered_set<std::string_view> words(cpp_keywords.begin(), cpp_keywords.end());
    words.insert(cpp_own_words.begin(), cpp_own_words.end());
    for (std::string_view rest = c_library_names; !rest.empty();) {
      const auto length = std::min(rest.find_first_of(" \n"), rest.size());
      words.insert(rest.substr(0, length));
      rest.remove_prefix(std::min(length + 1, rest.size()));
    }
    return words;
  }();
  std::string text = identifier_text({name}, LetterCase::Lower);
  return taken.contains(text) ? text + "_2" : text;
}

std::vector<std::string> port_members(const std::vector<Port>& ports) {
  Identifiers identifiers(cpp_words);
  return port_names(port_groups(ports), [&](const PortGroup& group) { return identifiers.make({group.name}); });
}

StructLayout::StructLayout(const Graph& graph, const Routine& routine, std::span<const std::string_view> reserved)
    : members_(reserved), inputs_(port_members(graph.inputs)), outputs_(port_members(graph.outputs)) {
  NameTable instances;
  std::vector<std::string_view> groups;  // by instance
  const auto group = [&](std::string_view instance) {
    const auto [number, is_new] = instances.add(language::upper(instance));
    if (is_new) {
      groups.push_back(members_.make({instance}));
    }
    return groups[number];
  };
  // Thousands of instances have the same few fields: each is spelled once.
  NameTable written;
  std::vector<std::string_view> spelled;
  const auto field_name = [&](std::string_view name) {
    const NameTable::Entry entry = written.add(name);
    if (entry.is_new) {
      spelled.push_back(fields_[fields_.add(field_identifier(name)).number]);
    }
    return spelled[entry.number];
  };
  for (const Parameter& parameter : graph.parameters) {
    const auto dot = parameter.path.rfind('.');
    if (dot == std::string::npos) {
      layout_.parameters.push_back({.name = members_.make({parameter.path})});
    } else {
      layout_.parameters.push_back(
          {.group = group(std::string_view(parameter.path).substr(0, dot)), .name = field_name(parameter.field.name)});
    }
  }
  NameTable taken;
  std::string joined;
  for (const PortGroup& cells : cell_groups(routine.cells)) {
    const std::string_view instance = routine.cells[cells.first].instance;
    Member member{.name = field_name(cells.name)};
    if (instance.empty()) {
      member.name = members_.make({member.name});
    } else {
      member.group = group(instance);
    }
    for (;;) {
      joined.assign(member.group).append(".").append(member.name);
      if (taken.add(joined).is_new) {
        break;
      }
      member.name = field_name("last_" + std::string(member.name));
    }
    for (std::uint32_t i = 0; i < cells.length; ++i) {
      layout_.cells.push_back(member);
      if (cells.is_array()) {
        layout_.cells.back().name = elements_.emplace_back(element_name(member.name, i));
      }
    }
  }
  layout_.inputs.assign(inputs_.begin(), inputs_.end());
  layout_.outputs.assign(outputs_.begin(), outputs_.end());
}

std::vector<std::vector<std::size_t>> places_by_group(const std::vector<Member>& members) {
  // By identifier of a group, which stands but once in memory: where its first member is.
  std::unordered_map<const char*, std::size_t> first;
  std::vector<std::vector<std::size_t>> places(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!members[i].group.empty()) {
      places[first.try_emplace(members[i].group.data(), i).first->second].push_back(i);
    }
  }
  return places;
}

}  // namespace hysteron
