// The elaborator: what elaborate.cpp and elaborate_pins.cpp share. Not for others; see elaborate.hpp.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/elaborate.hpp"
#include "codegen/graph/finish.hpp"
#include "codegen/graph/lowering.hpp"
#include "codegen/graph/names.hpp"
#include "support/errors.hpp"

namespace hysteron {

using language::ExpressionId;
using language::Span;
using language::upper;

/// A definition being instantiated: its variables stand in a row of slots.
struct Instance {
  const Definition* definition = nullptr;
  std::string path{};  ///< "" at the top, else ending in a dot
  std::uint32_t first_slot = 0;
  Rate rate{};
  std::uint32_t level = 0;  ///< in how many blocks it lies
  bool top = false;
};

/// What an instance variable became: a node, or the slots of a nested definition.
struct Part {
  std::uint32_t node = 0;
  std::uint32_t first_slot = 0;
  bool called = false;
  Span call{};
  std::vector<std::string_view> given{};  ///< the pins that the call names, also where the value is refused
  bool is_misnamed = false;               ///< the call names a pin that does not exist
};

struct Pin {
  bool found = false;
  bool parameter = false;
  std::uint32_t index = 0;  ///< pin of a library block, variable of a definition
  Field field{};
};

class Elaborator {
 public:
  Elaborator(const Definitions& definitions, Diagnostics& diagnostics, const ElaborateOptions& options)
      : definitions_(definitions),
        source_(*definitions.source),
        options_(options),
        diagnostics_(diagnostics),
        builder_(graph_) {
    graph_.source = definitions.source;
  }
  /// Reads of variables that are a constant instead: what remains of loops where these are memory.
  void remember(const std::unordered_set<const language::Reference*>& reads) { remembered_ = &reads; }
  Graph run(std::uint32_t top, OuterPlaces& places);

 private:
  void error(int number, Span span, std::string cause, std::string mend, std::vector<Note> notes = {});
  static Wire alias(std::uint32_t slot, Type type) { return {Wire::From::Alias, type, 0, slot}; }
  std::uint32_t add_slots(const Definition& definition);
  static Port port_of(const Declared& declared);
  void declare_top(const Instance& instance, std::size_t variable);
  void declare_noise(const Instance& instance, const NoisyOutput& noisy);
  /// A parameter that nothing in the text drives: it may be set from outside.
  Wire open_parameter(const std::string& path, const Declared& declared, double value);
  void elaborate(const Instance& instance);
  void elaborate_body(const Instance& instance);
  void note_unit(const Instance& instance, std::size_t variable);
  void note_name(const Instance& instance, std::size_t variable);
  Rate rate_within(Rate outer, const Declared& declared);
  /// An inner @ts has to be what the instance gets.
  void check_sample_time(const Declared& declared, Rate rate);
  void instantiate(const Instance& instance, std::size_t variable, Part& part);
  // `INV : HY_M_INVERSE := (C1 := 0.05)`: constants, given once.
  void apply_settings(const Instance& instance, const Declared& declared, Part& part);
  /// `sized`: of a block whose sizes the lists say, where a list of one number is one number.
  bool constant_array(ExpressionId id, const Field& field, std::vector<double>& values, bool sized);
  static bool is_sized(const Declared& declared) {
    return declared.kind == Declared::Kind::LibraryBlock && declared.block->sized != nullptr;
  }
  /// What says a size, or becomes parameters, and is no pin.
  static bool is_size_setting(const Declared& declared, std::string_view name);
  /// Coefficients in s become the matrices of a block that holds its input.
  void discretise(const Instance& instance, const Declared& declared, Part& part, Rate rate);
  Pin find_pin(const Declared& declared, const language::Name& name);
  std::vector<std::string> pin_names(const Declared& declared, bool inputs);
  /// Which of the pins, `inputs` or `outputs`, is meant by a name, and which there are.
  static std::string one_of_pins(std::string_view name, const std::vector<std::string>& pins, std::string_view kind);
  /// Its name without sizes.
  static std::string_view type_of(const Declared& declared);
  Wire& pin_wire(const Declared& declared, const Part& part, const Pin& pin);
  void set_span(const Instance& instance, const Declared& declared, const Part& part, const Pin& pin, Span span);
  /// Refuses a second value for a pin.
  bool claim(const Declared& declared, const Part& part, const Pin& pin, const language::Argument& argument);
  void set_constant(const Instance& instance, const Declared& declared, const Part& part, const Pin& pin,
                    const std::vector<double>& values, const language::Argument& argument);
  void check_range(const Field& field, double value, Span span);
  /// What the parameters that the text fixes have to keep among themselves; of a finished graph.
  void check_relations();
  void elaborate_call(const Instance& instance, std::vector<Part>& parts, const language::Call& call);
  void wrong_type(Span span, const std::string& target, Type wanted, Type given);
  void elaborate_assignment(const Instance& instance, std::vector<Part>& parts, const language::Assignment& assignment);
  Wire lower(const Instance& instance, const std::vector<Part>& parts, ExpressionId id, const std::string& path);
  Wire resolve(const Instance& instance, const std::vector<Part>& parts, const language::Reference& reference);
  void unknown_name(const Definition& definition, const language::Name& name);
  void close(const Instance& instance, std::size_t variable, const Part& part);
  void check_called(const Declared& declared, const Part& part);
  Wire unconnected(const std::string& path, const Declared& declared, const Field& field, bool parameter,
                   const Part& part);

  const Definitions& definitions_;
  const language::SourceFile& source_;
  const ElaborateOptions& options_;
  const std::unordered_set<const language::Reference*>* remembered_ = nullptr;
  Diagnostics& diagnostics_;
  Graph graph_;
  GraphBuilder builder_;
  std::vector<Slot> slots_;
  std::vector<Parameter> open_parameters_;
  std::map<std::string_view, std::string> owners_{};  ///< of global variables that are memory: the path of an instance
  std::vector<std::uint32_t> levels_;                 ///< beside the nodes: in how many blocks each is written
  std::unordered_map<std::uint32_t, Wire> noisy_;     ///< by the slot of an output: what its readers get
  std::unordered_map<std::string, std::size_t> given_;  ///< by path: how many numbers the text gives a parameter
};

}  // namespace hysteron
