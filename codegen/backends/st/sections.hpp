// What a FUNCTION_BLOCK declares: inputs, parameters, outputs, constants, memory, and the values within a step.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/backends/st/names.hpp"
#include "codegen/backends/st/pou.hpp"
#include "codegen/backends/st/printer.hpp"
#include "codegen/backends/st/writer.hpp"

namespace hysteron {

/// Of a block whose body has been written: what that uses is declared.
class StSections {
 public:
  StSections(const Graph& graph, const Routine& routine, const StOptions& options, const StBlockNames& names,
             const StPrinter& printer, const StWriter& writer)
      : graph_(graph), routine_(routine), options_(options), names_(names), printer_(printer), writer_(writer) {}

  [[nodiscard]] std::vector<StSection> all() const;
  /// Ports that are one variable.
  [[nodiscard]] StVariable of_ports(const std::vector<Port>& ports, const PortGroup& group, std::string_view name,
                                    std::string_view meaning, bool with_value) const;
  /// Nothing to begin anew: a block of the library without memory.
  [[nodiscard]] bool has_no_memory() const { return options_.library && routine_.cells.empty(); }

 private:
  [[nodiscard]] std::string type(Type of) const { return std::string(st_type(of, options_.float32)); }
  [[nodiscard]] StVariable of_field(std::string_view name, const Field& field, std::string remark) const;
  /// Where the blocks of the library stand in the same file, arrays are handed from one to another.
  [[nodiscard]] bool has_array_types() const;
  [[nodiscard]] std::vector<StVariable> inputs() const;
  [[nodiscard]] std::vector<StVariable> parameters() const;
  [[nodiscard]] StVariable parameter(std::size_t i) const;
  /// The blocks of the diagram, with the parameters that are theirs alone, and the arrays that are handed to them.
  [[nodiscard]] std::vector<StVariable> instances() const;
  [[nodiscard]] std::vector<StVariable> outputs() const;
  [[nodiscard]] std::vector<StVariable> constants() const;
  [[nodiscard]] std::vector<StVariable> memory() const;
  [[nodiscard]] std::vector<StVariable> locals() const;

  const Graph& graph_;
  const Routine& routine_;
  const StOptions& options_;
  const StBlockNames& names_;
  const StPrinter& printer_;
  const StWriter& writer_;
};

}  // namespace hysteron
