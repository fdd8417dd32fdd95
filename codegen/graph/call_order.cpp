#include "codegen/graph/call_order.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "support/errors.hpp"

namespace hysteron {
namespace {

/// The most that a block may hold, and the most levels of blocks in blocks.
constexpr std::uint64_t most_instances = 2'000'000;
constexpr std::uint32_t most_levels = 1000;

class CallOrder {
 public:
  CallOrder(Definitions& definitions, Diagnostics& diagnostics)
      : definitions_(definitions), source_(*definitions.source), diagnostics_(diagnostics) {}

  void sort_by_calls() {
    enum class Mark : std::uint8_t { New, Open, Done };
    std::vector<Mark> marks(definitions_.list.size(), Mark::New);
    // An explicit stack: files may nest definitions deeply.
    struct Visit {
      std::uint32_t definition;
      std::size_t next;
    };
    for (std::uint32_t root = 0; root < definitions_.list.size(); ++root) {
      std::vector<Visit> stack;
      if (marks[root] == Mark::New) {
        stack.push_back({root, 0});
        marks[root] = Mark::Open;
      }
      while (!stack.empty()) {
        auto& [current, next] = stack.back();
        auto& variables = definitions_.list[current].variables;
        if (next == variables.size()) {
          marks[current] = Mark::Done;
          definitions_.callees_first.push_back(current);
          stack.pop_back();
          continue;
        }
        const Declared& declared = variables[next++];
        if (declared.kind != Declared::Kind::UserBlock) {
          continue;
        }
        if (marks[declared.definition] == Mark::Open) {
          error(error::recursive_block, declared.variable->type.span,
                fmt::format("'{}' contains itself through '{}'", declared.variable->type.text,
                            declared.variable->name.text),
                "A block cannot be a part of itself; feed back through a delay instead.");
          definitions_.list[current].usable = false;
          definitions_.list[declared.definition].usable = false;
        } else if (marks[declared.definition] == Mark::New) {
          marks[declared.definition] = Mark::Open;
          stack.push_back({declared.definition, 0});
        }
      }
    }
  }

  /// Hierarchy is flattened: blocks that hold two of each other, thirty times over, would be 2^30 instances. Reported
  /// where the bound is first passed.
  void limit_size() {
    struct Size {
      std::uint64_t instances = 0;
      std::uint32_t levels = 1;
    };
    std::vector<Size> sizes(definitions_.list.size());
    for (const std::uint32_t index : definitions_.callees_first) {
      Size& size = sizes[index];
      for (const Declared& declared : definitions_.list[index].variables) {
        if (declared.kind == Declared::Kind::LibraryBlock) {
          ++size.instances;
        } else if (declared.kind == Declared::Kind::UserBlock) {
          const Size& inner = sizes[declared.definition];
          size.instances += 1 + inner.instances;
          size.levels = std::max(size.levels, inner.levels + 1);
        }
      }
      if (size.instances > most_instances || size.levels > most_levels) {
        const language::Name& name = definitions_.list[index].block->name;
        const bool many = size.instances > most_instances;
        error(error::nested_too_deeply, name.span,
              many ? fmt::format("'{}' with all blocks inside it has {} instances; {} are the most", name.text,
                                 size.instances, most_instances)
                   : fmt::format("blocks are nested {} levels deep in '{}'; {} are the most", size.levels, name.text,
                                 most_levels),
              many ? "Every instance of a block brings all instances inside it: use fewer of them."
                   : "Put what is inside into fewer blocks.");
        std::ranges::for_each(definitions_.list, [](Definition& one) { one.usable = false; });
        return;
      }
    }
  }

 private:
  void error(int number, language::Span span, std::string cause, std::string mend) {
    diagnostics_.error(number, source_.place(span), std::move(cause), std::move(mend));
  }

  Definitions& definitions_;
  const language::SourceFile& source_;
  Diagnostics& diagnostics_;
};

}  // namespace

void sort_by_calls(Definitions& definitions, Diagnostics& diagnostics) {
  CallOrder order(definitions, diagnostics);
  order.sort_by_calls();
  order.limit_size();
}

}  // namespace hysteron
