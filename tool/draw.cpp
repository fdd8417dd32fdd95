#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "codegen/backends/drawing/diagram_dot.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/overwriting.hpp"
#include "tool/commands.hpp"
#include "tool/graphviz.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view draw_examples = R"(Examples:
  hysteron draw feedforward.st --out feedforward.svg
  hysteron draw axis.st --top POSITION_LOOP --out loop.png
  hysteron draw axis.st --out axis.dot      the text that Graphviz draws from

Boxes are what the text declares, with their pins and units; a FUNCTION_BLOCK of the text is a frame round what is
inside, and one with a sequential body a box with its pins and statements. Wires of LREAL are black, of DINT and WORD
blue, of BOOL dashed. A picture is drawn by the program dot of Graphviz, from the path or as the environment variable
GRAPHVIZ_DOT names it.
Exit codes: 0 done; 2 an error in the diagram, no Graphviz, or the file cannot be written.
)";

/// Above it, Graphviz takes minutes, and nobody reads the picture.
constexpr std::size_t most_boxes = 1500;

struct DrawOptions {
  std::string file;
  std::string top;
  std::string out;
};

/// svg, png, pdf or dot.
std::string format_of(const std::string& out) {
  const std::string ending = fs::path(out).extension().string();
  for (const std::string format : {"svg", "png", "pdf", "dot"}) {
    if (equal_ignoring_case(ending, "." + format)) {
      return format;
    }
  }
  throw InputError(error::bad_usage, {.file = out}, fmt::format("No picture is called {}.", out),
                   "end the name of --out in .svg, .png, .pdf or .dot.");
}

int draw(const DrawOptions& options, Console& console) {
  const std::string format = format_of(options.out);
  Diagnostics warnings;
  const Program written = compile_file(options.file, {.top = options.top, .any_order = true}, warnings);
  // Sorted by the data flow, so that what is read early is feedback and not a slip in the order.
  const std::string sorted = format_text(options.file, *written.graph.source->text, warnings, {.any_order = true});
  const Program program = compile_text(sorted, {.top = written.graph.name, .any_order = true, .path = options.file});
  refuse_to_overwrite({.file = options.out, .mend = "give another name for --out."}, {{.file = options.file}});
  const DiagramDot diagram = diagram_dot(program);
  if (format != "dot" && diagram.boxes > most_boxes) {
    throw InputError(
        error::graphviz_failed, {.file = options.file},
        fmt::format("The diagram has {} boxes; {} are the most that are drawn.", diagram.boxes, most_boxes),
        "draw a block of it by --top NAME, or take the text by --out NAME.dot.");
  }
  write_file_atomically(options.out,
                        format == "dot" ? diagram.text : drawn_by_graphviz(diagram.text, format, "--out NAME.dot"));
  console.print(fmt::format("{}: {} boxes\n", options.out, diagram.boxes));
  return exit_ok;
}

}  // namespace

Action add_draw(CLI::App& app) {
  const auto options = std::make_shared<DrawOptions>();
  app.add_option("FILE", options->file, "The diagram, a file in Structured Text.")->required()->option_text(" ");
  app.add_option("--top", options->top, "The block to draw, where it is not the only one that no other contains.")
      ->option_text("NAME");
  app.add_option("--out", options->out, "The picture: its ending says which, .svg, .png, .pdf or .dot.")
      ->required()
      ->option_text("X.svg");
  app.footer(std::string(draw_examples));
  return [options](Console& console) { return draw(*options, console); };
}

}  // namespace hysteron::tool
