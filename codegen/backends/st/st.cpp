#include "codegen/backends/st/st.hpp"

#include <fmt/format.h>

#include "codegen/backends/st/comment.hpp"
#include "codegen/backends/st/names.hpp"
#include "codegen/backends/st/printer.hpp"
#include "codegen/graph/defaults.hpp"
#include "codegen/graph/sample_time.hpp"
#include "codegen/program_hash.hpp"
#include "support/numbers.hpp"
#include "support/sha256.hpp"

namespace hysteron {
namespace {

class StBlock {
 public:
  StBlock(const Program& program, const StOptions& options)
      : program_(program),
        graph_(program.graph),
        dialect_(options.dialect),
        float32_(options.float32),
        routine_(make_routine(program)),
        names_(graph_, routine_, dialect_),
        printer_(graph_, routine_, names_.layout(), names_.own(), dialect_, float32_),
        writer_(graph_, routine_, printer_, names_.identifiers(), names_.layout(), names_.own()) {}

  std::vector<GeneratedFile> run() {
    refuse_long_names(graph_, routine_, names_.layout(), dialect_);
    const std::string body = write_body();
    const std::string declaration = write_declaration();
    const std::string stem = identifier_text({graph_.name}, LetterCase::Lower);
    std::vector<GeneratedFile> files{{stem + std::string(dialect_.extension), in_shape(declaration, body)}};
    if (dialect_.shape == StDialect::Shape::OneFile) {
      files.push_back({stem + "_program.st", example_program()});
    }
    return files;
  }

 private:
  std::string write_body() {
    std::string reset;
    writer_.write_reset_body(reset);
    std::string started;
    printer_.print_variable(names_.started(), started);
    std::string first = "  IF ";
    printer_.print_variable(names_.reset(), first);
    append(first, " OR NOT ", started, " THEN\n", reset, "    ", started, " := TRUE;\n  END_IF;\n\n");
    writer_.write(routine_.step, first);
    writer_.write_counter(first);
    return first;
  }

  // --- the declaration ---

  void declare(std::string& text, std::string_view name, std::string_view type, const std::string& value,
               const std::string& remark) const {
    append(text, "    ", name, " : ", type);
    if (!value.empty()) {
      append(text, " := ", value);
    }
    text += ';';
    if (!remark.empty()) {
      append(text, "  (* ", st_comment(remark), " *)");
    }
    text += '\n';
  }

  [[nodiscard]] std::string type_of_field(const Field& field) const {
    return field.length > 1 ? fmt::format("ARRAY[0..{}] OF {}", field.length - 1, st_type(field.type, float32_))
                            : std::string(st_type(field.type, float32_));
  }

  [[nodiscard]] std::string value_text(const Parameter& parameter) const {
    if (parameter.field.length == 1) {
      return printer_.literal(parameter.field.type, parameter.value.front());
    }
    std::string text = "[";
    for (const double value : parameter.value) {
      append(text, text.size() > 1 ? ", " : "", printer_.literal(parameter.field.type, value));
    }
    return text + "]";
  }

  std::string write_declaration() const {
    std::string text = head();
    const bool siemens = dialect_.shape == StDialect::Shape::Source;
    append(text, "FUNCTION_BLOCK ", siemens ? "\"" : "", names_.block(), siemens ? "\"\n" : "\n");
    if (siemens) {
      text += "{ S7_Optimized_Access := 'TRUE' }\nVERSION : 0.1\n";
    }
    if (siemens) {
      append_section(text, "VAR_INPUT", "", inputs() + parameters());
    } else {
      append_section(text, "VAR_INPUT", "", inputs());
      append_section(text, "VAR_INPUT", "parameters, at their tuned values", parameters());
    }
    append_section(text, "VAR_OUTPUT", "", outputs());
    append_section(text, "VAR CONSTANT", "", constants());
    append_section(text, "VAR", "memory, from step to step", memory());
    append_section(text, dialect_.temporary_section ? "VAR_TEMP" : "VAR", "values within a step", locals());
    return text;
  }

  static void append_section(std::string& text, std::string_view keyword, std::string_view remark,
                             const std::string& lines) {
    if (lines.empty()) {
      return;
    }
    append(text, "  ", keyword);
    if (!remark.empty()) {
      append(text, "  (* ", remark, " *)");
    }
    append(text, "\n", lines, "  END_VAR\n");
  }

  std::string inputs() const {
    std::string text;
    for (std::size_t i = 0; i < graph_.inputs.size(); ++i) {
      const Port& port = graph_.inputs[i];
      declare(text, names_.layout().inputs[i], st_type(port.type, float32_),
              has_default(graph_, port) ? printer_.literal(port.type, port.preset) : "",
              st_remark(port.unit, port.minimum, port.maximum, false, port.meaning));
    }
    declare(text, names_.reset(), "BOOL", "FALSE", "TRUE: the memory begins anew, before this step");
    return text;
  }

  std::string parameters() const {
    std::string text;
    for (std::size_t i = 0; i < graph_.parameters.size(); ++i) {
      const Field& field = graph_.parameters[i].field;
      declare(text, names_.layout().parameters[i].name, type_of_field(field), value_text(graph_.parameters[i]),
              st_remark(field.unit, field.minimum, field.maximum, field.above_minimum, field.meaning));
    }
    return text;
  }

  std::string outputs() const {
    std::string text;
    for (std::size_t i = 0; i < graph_.outputs.size(); ++i) {
      const Port& port = graph_.outputs[i];
      declare(text, names_.layout().outputs[i], st_type(port.type, float32_), "",
              st_remark(port.unit, port.minimum, port.maximum, false, port.meaning));
    }
    return text;
  }

  std::string constants() const {
    std::string text;
    if (printer_.uses_sample_time) {
      declare(text, names_.own().sample_time, st_type(Type::Real, float32_),
              printer_.literal(Type::Real, graph_.sample_time()), "sample time, in seconds");
    }
    if (printer_.uses_largest) {
      declare(text, names_.own().largest, st_type(Type::Real, float32_), printer_.literal(Type::Real, infinity),
              "stands for infinity");
    }
    return text;
  }

  std::string memory() const {
    std::string text;
    for (std::size_t i = 0; i < routine_.cells.size(); ++i) {
      const Field& field = routine_.cells[i].field;
      declare(text, names_.layout().cells[i].name, type_of_field(field), "", std::string(field.meaning));
    }
    declare(text, names_.started(), "BOOL", "FALSE", "a step has run");
    return text;
  }

  std::string locals() const {
    std::string text;
    constexpr std::size_t width = 110;
    std::string line;
    for (std::size_t i = 0; i < writer_.locals.size(); ++i) {  // names of one type share a line
      const StLocal& local = writer_.locals[i];
      append(line, line.empty() ? "" : ", ", local.name);
      const bool last = i + 1 == writer_.locals.size() || writer_.locals[i + 1].type != local.type;
      if (last || line.size() + writer_.locals[i + 1].name.size() > width) {
        declare(text, line, st_type(local.type, float32_), "", "");
        line.clear();
      }
    }
    if (writer_.uses_place) {
      declare(text, names_.own().place, "DINT", "", "place in an array");
    }
    return text;
  }

  std::string head() const {
    std::string text = fmt::format(
        "(* {}: generated by Hysteron from a block diagram; edit the diagram, not this file.\n\n", graph_.name);
    append(
        text,
        fmt::format("   Call each instance once in every cycle of a task of {} ms, and in no other: its sample "
                    "time is {} s.\n",
                    number_text(static_cast<double>(graph_.sample_time_ns) * 1e-6), number_text(graph_.sample_time())));
    append(text, "   Its first call, and ", names_.reset(), ", let its memory begin anew.\n");
    append(text, fmt::format("   State: {} bytes. Operations a step: {} (calls of EXP, LN, EXPT and the like: {}).\n",
                             state_bytes(routine_, float32_), routine_.operations, routine_.function_calls));
    append(text,
           fmt::format("   Dialect: {}. Hash of diagram and parameters: {}.\n", dialect_.name, program_hash(program_)));
    append(text, names_.renamed());
    append(text, "\n", st_comment(schedule_lines(program_, "  ", "and so on.")), "*)\n");
    return text;
  }

  // --- the file ---

  [[nodiscard]] std::string in_shape(const std::string& declaration, const std::string& body) const {
    switch (dialect_.shape) {
      case StDialect::Shape::OneFile:
        return declaration + "\n" + body + "END_FUNCTION_BLOCK\n";
      case StDialect::Shape::TwoPanes:
        return declaration + "\n(* ---- above: the declaration; below: the body ---- *)\n\n" + body;
      case StDialect::Shape::Source:
        return declaration + "BEGIN\n" + body + "END_FUNCTION_BLOCK\n";
      case StDialect::Shape::Object:
        return fmt::format(
            R"(<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1">
  <POU Name="{}" Id="{{{}}}" SpecialFunc="None">
    <Declaration><![CDATA[{}]]></Declaration>
    <Implementation>
      <ST><![CDATA[{}]]></ST>
    </Implementation>
  </POU>
</TcPlcObject>
)",
            names_.block(), identity(), declaration, body);
    }
    return "";
  }

  /// A GUID that is the same for the same name: a project then knows the object that it has.
  [[nodiscard]] std::string identity() const {
    const std::string digits = sha256(fmt::format("hysteron {}", names_.block()));
    return fmt::format("{}-{}-4{}-8{}-{}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 3),
                       digits.substr(15, 3), digits.substr(18, 12));
  }

  std::string example_program() {
    const std::string instance(names_.identifiers().make({graph_.name, "1"}));
    std::string text = fmt::format(
        "(* An example of a program that calls {}; generated by Hysteron. Its task has a cycle of {} ms. *)\n"
        "PROGRAM {}\n  VAR\n    {} : {};\n",
        names_.block(), number_text(static_cast<double>(graph_.sample_time_ns) * 1e-6),
        names_.identifiers().make({graph_.name, "program"}), instance, names_.block());
    std::string arguments;
    for (std::size_t i = 0; i < graph_.inputs.size(); ++i) {
      const Port& port = graph_.inputs[i];
      const std::string_view name = names_.layout().inputs[i];
      declare(text, name, st_type(port.type, float32_), printer_.literal(port.type, port.preset),
              st_remark(port.unit, port.minimum, port.maximum, false, port.meaning));
      append(arguments, arguments.empty() ? "" : ", ", name, " := ", name);
    }
    std::string results;
    for (std::size_t i = 0; i < graph_.outputs.size(); ++i) {
      const Port& port = graph_.outputs[i];
      const std::string_view name = names_.layout().outputs[i];
      declare(text, name, st_type(port.type, float32_), "",
              st_remark(port.unit, port.minimum, port.maximum, false, ""));
      append(results, "  ", name, " := ", instance, ".", name, ";\n");
    }
    append(text, "  END_VAR\n\n  ", instance, "(", arguments, arguments.empty() ? "" : ", ", names_.reset(),
           " := FALSE);\n", results, "END_PROGRAM\n");
    return text;
  }

  const Program& program_;
  const Graph& graph_;
  StDialect dialect_;
  bool float32_;
  Routine routine_;
  StBlockNames names_;
  StPrinter printer_;
  StWriter writer_;
};

}  // namespace

std::vector<GeneratedFile> generate_st(const Program& program, const StOptions& options) {
  require_sample_time(program.graph);
  return StBlock(program, options).run();
}

}  // namespace hysteron
