#include "codegen/backends/shared/layout.hpp"

#include <fmt/format.h>

namespace hysteron {
namespace {

constexpr std::size_t longest_schedule = 200;  // a longer diagram's schedule is its step itself
constexpr std::size_t schedule_width = 116;

std::size_t bytes_of_type(Type type, bool float32) {
  switch (type) {
    case Type::Real:
      return float32 ? 4 : 8;
    case Type::Bool:
      return 1;
    case Type::Int:
      return 4;
    case Type::Word:
      return 2;
  }
  return 0;
}

}  // namespace

std::size_t state_bytes(const Routine& routine, bool float32) {
  std::size_t bytes = 0;
  for (const CellInfo& cell : routine.cells) {
    bytes += bytes_of_type(cell.field.type, float32) * cell.field.length;
  }
  return bytes;
}

std::string schedule_lines(const Program& program, std::string_view comment, std::string_view ellipsis) {
  std::string text = fmt::format("{} Schedule:", comment);
  std::size_t width = text.size();
  std::size_t count = 0;
  for (const Action& action : program.schedule.actions) {
    const Node& node = program.graph.nodes[action.node];
    if (node.block == nullptr) {
      continue;
    }
    if (++count > longest_schedule) {
      text += fmt::format(" {}", ellipsis);
      break;
    }
    const std::string entry = fmt::format(" {}{}", node.path,
                                          action.kind == Action::Kind::Output   ? " (output)"
                                          : action.kind == Action::Kind::Update ? " (update)"
                                                                                : "");
    if (width + entry.size() > schedule_width) {
      text += fmt::format("\n{}  ", comment);
      width = comment.size() + 2;
    }
    text += entry + ",";
    width += entry.size() + 1;
  }
  if (text.ends_with(',')) {
    text.back() = '.';
  }
  return text + "\n";
}

}  // namespace hysteron
