#include "codegen/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/elaborate.hpp"
#include "codegen/graph/portability.hpp"
#include "codegen/graph/remaining_loops.hpp"
#include "codegen/graph/text_order.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

/// A cause without the indexes of elements: a fault of a vector is one fault.
std::string without_indexes(const std::string& cause) {
  std::string text;
  for (std::size_t i = 0; i < cause.size(); ++i) {
    const std::size_t end = cause[i] == '[' ? cause.find_first_not_of("0123456789", i + 1) : std::string::npos;
    if (end != std::string::npos && end > i + 1 && cause[end] == ']') {
      i = end;
    } else {
      text += cause[i];
    }
  }
  return text;
}

/// Keeps of neighbours that differ by an index the first, which says how many there are.
void join_elements(std::vector<Diagnostic>& list) {
  std::vector<Diagnostic> kept;
  std::size_t more = 0;
  const auto finish = [&] {
    if (more > 0) {
      kept.back().cause += fmt::format(" (and {} more element{})", more, more == 1 ? "" : "s");
    }
    more = 0;
  };
  for (Diagnostic& one : list) {
    const bool element = !kept.empty() && kept.back().number == one.number && kept.back().cause != one.cause &&
                         kept.back().place.file == one.place.file && kept.back().place.line == one.place.line &&
                         kept.back().place.column == one.place.column &&
                         without_indexes(kept.back().cause) == without_indexes(one.cause);
    if (element) {
      ++more;
      continue;
    }
    finish();
    kept.push_back(std::move(one));
  }
  if (!kept.empty()) {
    finish();
  }
  list = std::move(kept);
}

/// Sorted by place, each once: a block that is instantiated twice has its faults once.
void tidy_up(const Diagnostics& found, bool any_order, Diagnostics& diagnostics) {
  std::vector<Diagnostic> list = found.all();
  const auto key = [](const Diagnostic& one) {
    return std::tie(one.place.file, one.place.line, one.place.column, one.number, one.cause);
  };
  std::ranges::stable_sort(list, [&](const Diagnostic& a, const Diagnostic& b) { return key(a) < key(b); });
  const auto same = [&](const Diagnostic& a, const Diagnostic& b) { return key(a) == key(b); };
  list.erase(std::unique(list.begin(), list.end(), same), list.end());
  join_elements(list);
  for (Diagnostic& one : list) {
    if (any_order && one.number == error::hidden_delay) {
      one.severity = Severity::Warning;
      one.mend = "With --any-order this is this step's value all the same. " + one.mend;
    }
    diagnostics.add(std::move(one));
  }
}

bool blocks_work(const Diagnostics& diagnostics) {
  return std::ranges::any_of(diagnostics.all(), [](const Diagnostic& one) {
    return one.severity == Severity::Error && one.number != error::hidden_delay;
  });
}

/// Whether nothing is wrong but loops.
bool has_only_loops(const Diagnostics& diagnostics) {
  return std::ranges::all_of(diagnostics.all(), [](const Diagnostic& one) {
    return one.severity != Severity::Error || one.number == error::algebraic_loop;
  });
}

/// All blocks of a file, elaborated each by itself, those that others contain first.
struct Checked {
  Definitions definitions;
  std::vector<Program> programs;  ///< beside definitions.list
};

/// Reports reads on the wrong side of a call or an assignment. A loop through a variable that is read before its
/// assignment is memory: HY402 in place of HY401. Where the order of the text means nothing it is a loop. Says whether
/// there were loops.
bool check_order(const Definitions& definitions, std::uint32_t index, const Graph& graph, bool any_order,
                 Diagnostics& own) {
  const bool has_loops = own.has_errors();
  if (has_loops && any_order) {
    return true;
  }
  Diagnostics found;
  if (has_loops) {
    found = remaining_loops(definitions, index, remembered_reads(definitions, index, graph));
  }
  check_text_order(definitions, index, graph, found.has_errors(), found);
  for (const Diagnostic& one : own.all()) {
    if (one.number != error::algebraic_loop) {
      found.add(one);
    }
  }
  own = std::move(found);
  return has_loops;
}

/// By definition, whether another one contains it.
std::vector<bool> find_contained(const Definitions& definitions) {
  std::vector<bool> contained(definitions.list.size(), false);
  for (const Definition& definition : definitions.list) {
    for (const Declared& declared : definition.variables) {
      if (declared.kind == Declared::Kind::UserBlock) {
        contained[declared.definition] = true;
      }
    }
    for (const std::uint32_t inner : definition.in_place) {
      contained[inner] = true;
    }
  }
  return contained;
}

/// What is left to say of a block that another one contains: its sample time is that of the outermost.
Diagnostics without_sample_time(const Diagnostics& found) {
  Diagnostics rest;
  for (const Diagnostic& one : found.all()) {
    if (one.number != error::missing_sample_time) {
      rest.add(one);
    }
  }
  return rest;
}

Checked check_all(std::shared_ptr<const language::SourceFile> source, const CompileOptions& options,
                  Diagnostics& diagnostics) {
  Checked result{.definitions = define(std::move(source), diagnostics), .programs = {}};
  Definitions& definitions = result.definitions;
  result.programs.resize(definitions.list.size());
  const std::vector<bool> contained = find_contained(definitions);
  bool blocked = false;  // a loop that is told as memory leaves no order of computation
  for (const std::uint32_t index : definitions.callees_first) {
    Definition& definition = definitions.list[index];
    Program& program = result.programs[index];
    Diagnostics own;
    if (definition.usable) {
      OuterPlaces places;
      ElaborateOptions elaboration{.keep_names = options.keep_names};
      const bool named_top = language::same_name(definition.block->name.text, options.top);
      if (named_top) {
        elaboration.noisy_outputs = options.noisy_outputs;
      }
      program.graph = elaborate(definitions, index, own, elaboration, &places);
      if (contained[index] && !named_top) {
        own = without_sample_time(own);
      }
      blocked = blocked || blocks_work(diagnostics);
      if (!own.has_errors() && !blocked) {
        program.schedule = schedule(program.graph, places, own);
      }
      if (!blocked && has_only_loops(own)) {
        blocked = check_order(definitions, index, program.graph, options.any_order, own);
      }
      if (!blocked && !blocks_work(own)) {
        units::check(program.graph, program.schedule, own);
        const auto late = outputs_with_feedthrough(program.graph);
        definition.late.assign(definition.variables.size(), true);
        std::size_t output = 0;
        for (std::size_t i = 0; i < definition.variables.size(); ++i) {
          if (definition.variables[i].kind == Declared::Kind::Output) {
            definition.late[i] = late[output++];
          }
        }
      }
    }
    diagnostics.add_all(own);
  }
  return result;
}

/// Matrices of a held input belong to one sample time.
void require_held_time(const Graph& graph, Diagnostics& diagnostics) {
  for (const Node& node : graph.nodes) {
    if (graph.sample_time_ns <= 0 && node.block != nullptr && node.block->sized != nullptr &&
        node.block->sized->kind->is_discretised) {
      diagnostics.error(
          error::missing_sample_time, graph.place(node.span),
          fmt::format("'{}' is discretised at the sample time, and '{}' states none", node.path, graph.name),
          "Write it behind the name of the block: (* @ts 1ms *).");
    }
  }
}

/// The block to be run: the named one, or the only one that no other contains.
std::int64_t find_top(const Definitions& definitions, const std::string& wanted, Diagnostics& diagnostics) {
  const auto& source = *definitions.source;
  const std::vector<bool> contained = find_contained(definitions);
  std::vector<std::string> names;
  std::int64_t top = -1;
  for (std::size_t i = 0; i < definitions.list.size(); ++i) {
    const auto name = definitions.list[i].block->name.text;
    if (!wanted.empty() && language::same_name(name, wanted)) {
      return static_cast<std::int64_t>(i);
    }
    if (!contained[i] || !wanted.empty()) {
      names.emplace_back(name);
      top = static_cast<std::int64_t>(i);
    }
  }
  if (wanted.empty() && names.size() == 1) {
    return top;
  }
  const bool recursive = std::ranges::any_of(definitions.list, [](const Definition& one) { return !one.usable; });
  if (!definitions.list.empty() && !recursive) {
    diagnostics.error(error::ambiguous_top, {.file = source.path},
                      wanted.empty() ? fmt::format("the file has several top blocks: {}", fmt::join(names, ", "))
                                     : fmt::format("there is no block '{}'", wanted),
                      fmt::format("Choose one with --top NAME: {}.", fmt::join(names, ", ")));
  }
  return -1;
}

}  // namespace

void check(std::shared_ptr<const language::SourceFile> source, Diagnostics& diagnostics) {
  Diagnostics found;
  const Checked checked = check_all(std::move(source), {}, found);
  const std::vector<bool> contained = find_contained(checked.definitions);
  for (std::size_t i = 0; i < contained.size(); ++i) {
    if (!blocks_work(found)) {
      check_portability(checked.definitions, static_cast<std::uint32_t>(i), found);
    }
    if (!contained[i]) {
      require_held_time(checked.programs[i].graph, found);
    }
  }
  tidy_up(found, false, diagnostics);
}

Program compile(std::shared_ptr<const language::SourceFile> source, const CompileOptions& options,
                Diagnostics& diagnostics) {
  Diagnostics found;
  Checked checked = check_all(std::move(source), options, found);
  const std::int64_t top = find_top(checked.definitions, options.top, found);
  if (top >= 0) {
    require_held_time(checked.programs[static_cast<std::size_t>(top)].graph, found);
  }
  tidy_up(found, options.any_order, diagnostics);
  return top < 0 ? Program{} : std::move(checked.programs[static_cast<std::size_t>(top)]);
}

namespace {

Program compile_source(language::SourceFile parsed, const CompileOptions& options, Diagnostics& syntax,
                       Diagnostics& warnings) {
  if (syntax.has_errors()) {
    throw InputError(std::move(syntax));
  }
  Program program = compile(std::make_shared<const language::SourceFile>(std::move(parsed)), options, syntax);
  if (syntax.has_errors()) {
    throw InputError(std::move(syntax));
  }
  warnings.add_all(syntax);
  return program;
}

}  // namespace

Program compile_file(const std::string& path, const CompileOptions& options, Diagnostics& warnings) {
  Diagnostics syntax;
  auto parsed = language::parse_file(path, syntax);
  return compile_source(std::move(parsed), options, syntax, warnings);
}

Program compile_text(std::string text, const CompileOptions& options) {
  Diagnostics syntax;
  Diagnostics warnings;
  auto parsed = language::parse(options.path, std::move(text), syntax);
  return compile_source(std::move(parsed), options, syntax, warnings);
}

namespace {

/// What formatting says of reads whose statement the data flow would have elsewhere: to move one changes what an IEC
/// compiler makes of the text, so it is refused, unless the text's order means nothing.
void report_order(const Diagnostics& found, bool any_order, Diagnostics& diagnostics) {
  Diagnostics order;
  for (Diagnostic one : found.all()) {
    if (one.number == error::hidden_delay || one.number == error::read_after_call) {
      one.severity = any_order ? Severity::Warning : Severity::Error;
      order.add(std::move(one));
    }
  }
  tidy_up(order, any_order, diagnostics);
}

/// An order of statements whose vectors have become their elements, as one of the statements of the text: each stands
/// where its last element does.
std::vector<std::uint32_t> of_the_text(const language::FunctionBlock& block, std::vector<std::uint32_t> order) {
  if (block.origins.empty()) {
    return order;
  }
  std::vector<std::uint32_t> written;
  for (std::size_t i = order.size(); i-- > 0;) {
    const std::uint32_t origin = block.origins[order[i]];
    if (std::ranges::find(written, origin) == written.end()) {
      written.push_back(origin);
    }
  }
  std::ranges::reverse(written);
  return written;
}

}  // namespace

std::string format_text(std::string path, std::string text, Diagnostics& diagnostics, const FormatOptions& options) {
  auto parsed = language::parse(std::move(path), std::move(text), diagnostics);
  if (diagnostics.has_errors()) {
    return *parsed.text;
  }
  const auto source = std::make_shared<const language::SourceFile>(std::move(parsed));
  Diagnostics found;
  const Checked checked = check_all(source, {.any_order = options.any_order}, found);
  if (!blocks_work(found)) {
    report_order(found, options.any_order, diagnostics);
  }
  if (diagnostics.has_errors()) {
    return *source->text;
  }
  language::StatementOrders orders(source->blocks.size());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    if (options.any_order && !blocks_work(found)) {
      orders[i] =
          of_the_text(checked.definitions.source->blocks[i],
                      statement_order(checked.definitions, static_cast<std::uint32_t>(i), checked.programs[i].graph));
    }
  }
  return language::format(*source, orders);
}

}  // namespace hysteron
