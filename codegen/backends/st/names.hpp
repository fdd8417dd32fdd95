// The names of a block in Structured Text: one flat list, in which nothing is a word of some compiler.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/backends/st/pou.hpp"
#include "codegen/backends/st/printer.hpp"

namespace hysteron {

class StBlockNames {
 public:
  /// `calls`: null where no block stays a block. `keeps_pins`: see StOptions.
  StBlockNames(const Graph& graph, const Routine& routine, const StDialect& dialect, const StCalls* calls,
               bool keeps_pins);
  StBlockNames(const StBlockNames&) = delete;
  StBlockNames& operator=(const StBlockNames&) = delete;
  ~StBlockNames() = default;

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] const StNames& own() const { return own_; }
  [[nodiscard]] std::string_view block() const { return block_; }
  [[nodiscard]] std::string_view reset() const { return reset_; }
  [[nodiscard]] std::string_view started() const { return started_; }
  /// The ports as they are declared.
  [[nodiscard]] std::vector<PortGroup> groups(const std::vector<Port>& ports) const;
  /// What gives the names of values, none of which is one of those above.
  [[nodiscard]] Identifiers& identifiers() { return identifiers_; }

  /// Lines for the head of the file: which ports, and which block, have another name than in the diagram.
  [[nodiscard]] const std::string& renamed() const { return renamed_; }

 private:
  std::string_view keep(std::string_view name);
  void name_ports(const std::vector<Port>& ports, std::vector<std::string>& names, std::vector<std::string_view>& list);
  void name_instances(const Graph& graph, const StCalls& calls);

  const StDialect& dialect_;
  bool keeps_pins_;
  Identifiers identifiers_;
  Layout layout_;
  StNames own_;
  std::string_view block_;
  std::string_view reset_;
  std::string_view started_;
  std::vector<std::string> inputs_;
  std::vector<std::string> outputs_;
  std::deque<std::string> outputs_of_instances_;  ///< LAG.XOUT
  std::deque<std::string> elements_;              ///< of states that are arrays: X[2]
  std::string renamed_;
};

/// Throws HY732 with all names of the diagram that are longer than the dialect allows.
void refuse_long_names(const Graph& graph, const Routine& routine, const Layout& layout, const StDialect& dialect);

}  // namespace hysteron
