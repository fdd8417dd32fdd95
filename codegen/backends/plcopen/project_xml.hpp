// A project as PLCopen TC6 XML: POUs with their interfaces and bodies, and the task that runs one of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "codegen/backends/plcopen/network.hpp"
#include "codegen/backends/st/pou.hpp"

namespace hysteron::plcopen {

/// How editors want the same things written.
struct Flavour {
  std::string_view name{};
  std::string_view st_dialect{};       ///< of the literals and the text
  std::string_view file{};             ///< its name; empty: that of the diagram
  std::string_view function_result{};  ///< what the output of a function is called
  bool older_namespace = false;        ///< TC6 2.00
  bool whole_element = false;          ///< <xhtml xmlns="…"> round texts, in place of <xhtml:p> with CDATA
  bool runs = false;                   ///< a program and its task come along, so that the project runs
};

/// Without regard to case; null where there is none.
[[nodiscard]] const Flavour* find_flavour(std::string_view name);

/// Their names, as a list for a message.
[[nodiscard]] std::string flavour_names();

struct Pou {
  std::string name{};
  bool is_program = false;
  std::string documentation{};
  std::vector<StSection> sections{};
  std::variant<std::string, std::vector<Element>> body{};  ///< Structured Text, or a network
};

struct Project {
  std::string name{};
  std::vector<Pou> pous{};
  std::string program{};  ///< which POU the task runs; empty: no task
  std::int64_t cycle_ns = 0;
};

/// The same project gives the same bytes: the file states no day on which it was made.
[[nodiscard]] std::string project_xml(const Project& project, const Flavour& flavour);

}  // namespace hysteron::plcopen
