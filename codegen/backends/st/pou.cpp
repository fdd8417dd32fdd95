#include "codegen/backends/st/pou.hpp"

#include <fmt/format.h>

#include <bit>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/comment.hpp"
#include "codegen/backends/st/names.hpp"
#include "codegen/backends/st/printer.hpp"
#include "codegen/graph/defaults.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/program_hash.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

constexpr std::size_t widest_line = 110;

/// The elements of a long array stand in lines of their own: some editors cut a line that is too long.
std::string value_text(const StVariable& variable) {
  if (variable.length == 1) {
    return variable.values.front();
  }
  std::string text = "[";
  std::size_t line = 0;  // where the present one begins
  for (std::size_t i = 0; i < variable.values.size(); ++i) {
    text += i == 0 ? "" : ",";
    if (text.size() - line + variable.values[i].size() > widest_line) {
      line = text.size() + 1;
      text += "\n      ";
    } else {
      text += i == 0 ? "" : " ";
    }
    text += variable.values[i];
  }
  return text + "]";
}

class StBlock {
 public:
  StBlock(const Program& program, const StOptions& options)
      : program_(program),
        graph_(program.graph),
        dialect_(options.dialect),
        float32_(options.float32),
        library_(options.library),
        ahead_(options.outputs_ahead),
        calls_(options.calls),
        routine_(calls_ != nullptr ? calls_->made.routine : make_routine(program, {.outputs_ahead = ahead_})),
        names_(graph_, routine_, dialect_, calls_, options.keeps_pins),
        printer_(graph_, routine_, names_.layout(), names_.own(), dialect_, float32_),
        writer_(graph_, routine_, printer_, names_.identifiers(), names_.layout(), names_.own()) {}

  StBlockAndCaller run() {
    refuse_long_names(graph_, routine_, names_.layout(), dialect_);
    StBlockAndCaller made;
    made.block.name = names_.block();
    made.block.body = write_body();
    made.block.head = head();
    made.block.sections = sections();
    made.interface = interface();
    made.caller = caller();
    return made;
  }

 private:
  /// Nothing to begin anew: a block of the library without memory.
  [[nodiscard]] bool has_no_memory() const { return library_ && routine_.cells.empty(); }

  std::string write_body() {
    if (library_) {
      writer_.name_outputs_at_once(ahead_);
    }
    std::string text;
    if (!has_no_memory()) {
      write_beginning(text);
    }
    if (library_ && !has_no_memory()) {
      write_step_unless_reset(text);
    } else {
      writer_.write(routine_.step, text);
    }
    writer_.write_counter(text);
    return text;
  }

  void write_beginning(std::string& text) {
    std::string reset;
    writer_.write_reset_body(reset);
    std::string started;
    printer_.print_variable(names_.started(), started);
    text += "  IF ";
    printer_.print_variable(names_.reset(), text);
    append(text, " OR NOT ", started, " THEN\n", reset, "    ", started, " := TRUE;\n  END_IF;\n\n");
  }

  /// Outputs of memory alone stand behind: they have their first values where a call lets the memory begin anew.
  void write_step_unless_reset(std::string& text) {
    std::vector<Statement> now;
    std::vector<Statement> behind;
    for (const Statement& one : routine_.step) {
      const bool ahead = one.kind == Statement::Kind::SetOutput && one.target < ahead_.size() && ahead_[one.target];
      (ahead ? behind : now).push_back(one);
    }
    text += "  IF NOT ";
    printer_.print_variable(names_.reset(), text);
    text += " THEN\n";
    writer_.indent("    ");
    writer_.write(now, text);
    writer_.indent("  ");
    text += "  END_IF;\n";
    writer_.write(behind, text);
  }

  // --- the declaration ---

  [[nodiscard]] std::string type(Type of) const { return std::string(st_type(of, float32_)); }

  [[nodiscard]] StVariable of_field(std::string_view name, const Field& field, std::string remark) const {
    return {.name = std::string(name),
            .type = type(field.type),
            .length = field.length,
            .values = {},
            .remark = std::move(remark)};
  }

  /// Where the blocks of the library stand in the same file, arrays are handed from one to another.
  [[nodiscard]] bool has_array_types() const {
    return (library_ || calls_ != nullptr) && dialect_.shape == StDialect::Shape::OneFile;
  }

  [[nodiscard]] StVariable of_ports(const std::vector<Port>& ports, const PortGroup& group, std::string_view name,
                                    std::string_view meaning, bool with_value) const {
    const Port& port = ports[group.first];
    StVariable variable{.name = std::string(variable_of(name)),
                        .type = type(port.type),
                        .length = group.length,
                        .values = {},
                        .remark = st_remark(port.unit, port.minimum, port.maximum, false, meaning)};
    for (std::uint32_t i = 0; with_value && i < group.length; ++i) {
      variable.values.push_back(printer_.literal(port.type, ports[group.first + i].preset));
    }
    return variable;
  }

  [[nodiscard]] std::vector<StSection> sections() const {
    std::vector<StSection> list;
    if (dialect_.shape == StDialect::Shape::Source) {
      std::vector<StVariable> both = inputs();
      for (StVariable& one : parameters()) {
        both.push_back(std::move(one));
      }
      list.push_back({.keyword = "VAR_INPUT", .variables = std::move(both)});
    } else {
      list.push_back({.keyword = "VAR_INPUT", .variables = inputs()});
      list.push_back({.keyword = "VAR_INPUT",
                      .remark = library_ ? "parameters" : "parameters, at their tuned values",
                      .variables = parameters()});
    }
    list.push_back({.keyword = "VAR_OUTPUT", .variables = outputs()});
    list.push_back({.keyword = "VAR CONSTANT", .variables = constants()});
    if (calls_ != nullptr) {
      list.push_back({.keyword = "VAR", .remark = "blocks", .variables = instances()});
    }
    list.push_back({.keyword = "VAR", .remark = "memory, from step to step", .variables = memory()});
    list.push_back({.keyword = dialect_.temporary_section ? "VAR_TEMP" : "VAR",
                    .remark = "values within a step",
                    .variables = locals(),
                    .names_share_lines = true});
    std::erase_if(list, [](const StSection& one) { return one.variables.empty(); });
    return list;
  }

  [[nodiscard]] std::vector<StVariable> inputs() const {
    std::vector<StVariable> list;
    for (const PortGroup& group : names_.groups(graph_.inputs)) {
      const Port& port = graph_.inputs[group.first];
      list.push_back(
          of_ports(graph_.inputs, group, names_.layout().inputs[group.first], port.meaning, has_default(graph_, port)));
    }
    list.push_back({.name = std::string(names_.reset()),
                    .type = "BOOL",
                    .values = {"FALSE"},
                    .remark = library_ ? "TRUE: the memory begins anew, and no step is made"
                                       : "TRUE: the memory begins anew, before this step"});
    if (has_no_memory()) {
      list.pop_back();
    }
    return list;
  }

  [[nodiscard]] std::vector<StVariable> parameters() const {
    std::vector<StVariable> list;
    for (std::size_t i = 0; i < graph_.parameters.size(); ++i) {
      if (calls_ == nullptr || (!calls_->made.is_setting[i] && graph_.parameters[i].field.length == 1)) {
        list.push_back(parameter(i));
      }
    }
    if (library_ && printer_.uses_sample_time) {
      list.push_back({.name = std::string(names_.own().sample_time),
                      .type = type(Type::Real),
                      .values = {printer_.literal(Type::Real, graph_.sample_time())},
                      .remark = "[s] sample time: how often the block is called"});
    }
    return list;
  }

  [[nodiscard]] StVariable parameter(std::size_t i) const {
    const Field& field = graph_.parameters[i].field;
    StVariable variable =
        of_field(names_.layout().parameters[i].name, field,
                 st_remark(field.unit, field.minimum, field.maximum, field.above_minimum, field.meaning));
    if (has_array_types() && field.length > 1) {
      variable.array_type = st_array_type(field.length);
    }
    for (std::size_t element = 0; element < field.length; ++element) {
      variable.values.push_back(printer_.literal(field.type, graph_.parameters[i].value[element]));
    }
    return variable;
  }

  /// The blocks of the diagram, with the parameters that are theirs alone, and the arrays that are handed to them.
  [[nodiscard]] std::vector<StVariable> instances() const {
    std::vector<StVariable> list;
    for (std::size_t i = 0; i < calls_->made.instances.size(); ++i) {
      const BlockInstance& one = calls_->made.instances[i];
      const Node& node = graph_.nodes[one.node];
      std::vector<std::string> settings;
      for (const std::uint32_t index : one.settings) {
        const Parameter& given = graph_.parameters[index];
        if (std::bit_cast<std::uint64_t>(given.value.front()) != std::bit_cast<std::uint64_t>(given.field.preset)) {
          settings.push_back(fmt::format("{} := {}", printer_.pin_name(given.field.name),
                                         printer_.literal(given.field.type, given.value.front())));
        }
      }
      if (calls_->blocks[i].sample_time && node.rate.every > 1) {
        const double seconds = static_cast<double>(graph_.sample_time_ns * node.rate.every) * 1e-9;
        settings.push_back(fmt::format("TS := {}", printer_.literal(Type::Real, seconds)));
      }
      StVariable variable{.name = std::string(names_.layout().instances[one.node]), .type = calls_->blocks[i].type};
      if (!settings.empty()) {
        variable.values = {fmt::format("({})", fmt::join(settings, ", "))};
      }
      list.push_back(std::move(variable));
    }
    for (std::size_t i = 0; i < graph_.parameters.size(); ++i) {
      if (graph_.parameters[i].field.length > 1) {
        list.push_back(parameter(i));
      }
    }
    return list;
  }

  [[nodiscard]] std::vector<StVariable> outputs() const {
    std::vector<StVariable> list;
    for (const PortGroup& group : names_.groups(graph_.outputs)) {
      const Port& port = graph_.outputs[group.first];
      list.push_back(of_ports(graph_.outputs, group, names_.layout().outputs[group.first], port.meaning,
                              library_ && port.preset != 0.0));
    }
    return list;
  }

  [[nodiscard]] std::vector<StVariable> constants() const {
    std::vector<StVariable> list;
    const auto add = [&](std::string_view name, double value, std::string_view remark) {
      list.push_back({.name = std::string(name),
                      .type = type(Type::Real),
                      .values = {printer_.literal(Type::Real, value)},
                      .remark = std::string(remark)});
    };
    if (printer_.uses_sample_time && !library_) {
      add(names_.own().sample_time, graph_.sample_time(), "sample time, in seconds");
    }
    if (printer_.uses_largest) {
      add(names_.own().largest, infinity, "stands for infinity");
    }
    return list;
  }

  [[nodiscard]] std::vector<StVariable> memory() const {
    std::vector<StVariable> list;
    const std::size_t first = calls_ != nullptr ? calls_->made.output_cells : 0;
    const std::vector<std::uint32_t> lengths = declared_lengths(std::span(routine_.cells).subspan(first));
    for (std::size_t i = first; i < routine_.cells.size(); ++i) {
      Field field = routine_.cells[i].field;
      field.length = static_cast<std::uint16_t>(lengths[i - first]);
      if (field.length > 0) {
        list.push_back(of_field(variable_of(names_.layout().cells[i].name), field, std::string(field.meaning)));
      }
    }
    list.push_back(
        {.name = std::string(names_.started()), .type = "BOOL", .values = {"FALSE"}, .remark = "a step has run"});
    if (has_no_memory()) {
      list.clear();
    }
    return list;
  }

  [[nodiscard]] std::vector<StVariable> locals() const {
    std::vector<StVariable> list;
    for (const StLocal& local : writer_.locals) {
      list.push_back({.name = std::string(local.name), .type = type(local.type), .length = local.length});
    }
    if (writer_.uses_place) {
      list.push_back({.name = std::string(names_.own().place), .type = "DINT", .remark = "place in an array"});
    }
    if (writer_.uses_term) {
      list.push_back({.name = std::string(writer_.term_name), .type = "DINT", .remark = "term of a sum"});
    }
    return list;
  }

  std::string head() const {
    std::string text = fmt::format(
        "(* {}: generated by Hysteron from a block diagram; edit the diagram, not this file.\n\n", graph_.name);
    append(text, fmt::format(
                     "   Call each instance once in every cycle of a task of {} ms, and in no other: its sample "
                     "time is {} s.\n",
                     number_text(static_cast<double>(graph_.sample_time_ns) / 1e6), number_text(graph_.sample_time())));
    append(text, "   Its first call, and ", names_.reset(), ", let its memory begin anew.\n");
    if (calls_ != nullptr) {
      append(
          text, "   The blocks that it calls stand in the same ",
          dialect_.shape == StDialect::Shape::OneFile || dialect_.shape == StDialect::Shape::Source ? "file" : "folder",
          ". Their parameters stand with their declarations.\n");
    } else {
      append(text, fmt::format("   State: {} bytes. Operations a step: {} (calls of EXP, LN, EXPT and the like: {}).\n",
                               state_bytes(routine_, float32_), routine_.operations, routine_.function_calls));
    }
    append(text,
           fmt::format("   Dialect: {}. Hash of diagram and parameters: {}.\n", dialect_.name, program_hash(program_)));
    append(text, names_.renamed());
    append(text, "\n", st_comment(schedule_lines(program_, "  ", "and so on.")), "*)\n");
    return text;
  }

  // --- what calls it ---

  [[nodiscard]] StInterface interface() const {
    const Layout& layout = names_.layout();
    StInterface made{.inputs = {layout.inputs.begin(), layout.inputs.end()},
                     .outputs = {layout.outputs.begin(), layout.outputs.end()},
                     .reset = std::string(names_.reset())};
    for (const Member& parameter : layout.parameters) {
      made.parameters.emplace_back(parameter.name);
    }
    return made;
  }

  [[nodiscard]] StPou caller() {
    const std::string instance(names_.identifiers().make({graph_.name, "1"}));
    StPou program;
    program.name = names_.identifiers().make({graph_.name, "program"});
    program.head = fmt::format(
        "(* An example of a program that calls {}; generated by Hysteron. Its task has a cycle of {} ms. *)\n",
        names_.block(), number_text(static_cast<double>(graph_.sample_time_ns) / 1e6));
    StSection section{.keyword = "VAR", .variables = {{.name = instance, .type = std::string(names_.block())}}};
    std::string arguments;
    std::string elements;  // compilers differ on which arrays may be handed over in a call
    for (const PortGroup& group : names_.groups(graph_.inputs)) {
      const std::string_view first = names_.layout().inputs[group.first];
      section.variables.push_back(of_ports(graph_.inputs, group, first, graph_.inputs[group.first].meaning, true));
      for (std::uint32_t i = group.first; group.is_array() && i < group.first + group.length; ++i) {
        append(elements, "  ", instance, ".", names_.layout().inputs[i], " := ", names_.layout().inputs[i], ";\n");
      }
      if (!group.is_array()) {
        append(arguments, arguments.empty() ? "" : ", ", first, " := ", first);
      }
    }
    std::string results;
    for (const PortGroup& group : names_.groups(graph_.outputs)) {
      section.variables.push_back(of_ports(graph_.outputs, group, names_.layout().outputs[group.first], "", false));
    }
    for (const std::string_view name : names_.layout().outputs) {
      append(results, "  ", name, " := ", instance, ".", name, ";\n");
    }
    program.sections.push_back(std::move(section));
    program.body = fmt::format("{}  {}({}{}{} := FALSE);\n{}", elements, instance, arguments,
                               arguments.empty() ? "" : ", ", names_.reset(), results);
    return program;
  }

  const Program& program_;
  const Graph& graph_;
  StDialect dialect_;
  bool float32_;
  bool library_;
  std::vector<bool> ahead_;
  const StCalls* calls_;
  Routine routine_;
  StBlockNames names_;
  StPrinter printer_;
  StWriter writer_;
};

void append_declaration(std::string& text, std::string_view names, const StVariable& variable) {
  append(text, "    ", names, " : ",
         !variable.array_type.empty() ? variable.array_type
         : variable.length > 1        ? fmt::format("ARRAY[0..{}] OF {}", variable.length - 1, variable.type)
                                      : variable.type);
  if (!variable.values.empty()) {
    append(text, " := ", value_text(variable));
  }
  text += ';';
  if (!variable.remark.empty()) {
    append(text, "  (* ", st_comment(variable.remark), " *)");
  }
  text += '\n';
}

void append_names(std::string& text, const std::vector<StVariable>& variables) {
  std::string line;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const StVariable& one = variables[i];
    append(line, line.empty() ? "" : ", ", one.name);
    const bool last = i + 1 == variables.size() || variables[i + 1].type != one.type ||
                      variables[i + 1].length != one.length || !one.remark.empty() || !variables[i + 1].remark.empty();
    if (last || line.size() + variables[i + 1].name.size() > widest_line) {
      append_declaration(text, line, one);
      line.clear();
    }
  }
}

}  // namespace

std::string st_array_type(std::uint16_t length) {
  return fmt::format("HY_ARRAY_{}", length);
}

std::string st_declarations(const std::vector<StSection>& sections) {
  std::string text;
  for (const StSection& section : sections) {
    append(text, "  ", section.keyword);
    if (!section.remark.empty()) {
      append(text, "  (* ", section.remark, " *)");
    }
    text += '\n';
    if (section.names_share_lines) {
      append_names(text, section.variables);
    } else {
      for (const StVariable& one : section.variables) {
        append_declaration(text, one.name, one);
      }
    }
    text += "  END_VAR\n";
  }
  return text;
}

StBlockAndCaller make_st_pou(const Program& program, const StOptions& options) {
  require_generable(program.graph);
  return StBlock(program, options).run();
}

}  // namespace hysteron
