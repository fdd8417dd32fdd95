#include "codegen/backends/c/memory.hpp"

#include <algorithm>

#include "codegen/backends/c/dialect.hpp"
#include "codegen/backends/c_family/names.hpp"

namespace hysteron {
namespace {

class Placing {
 public:
  std::size_t add(std::size_t size, std::size_t alignment) {
    alignment_ = std::max(alignment_, alignment);
    const std::size_t place = rounded(end_, alignment);
    end_ = place + size;
    return place;
  }
  [[nodiscard]] std::size_t alignment() const { return alignment_; }
  [[nodiscard]] std::size_t size() const { return rounded(end_, alignment_); }

 private:
  static std::size_t rounded(std::size_t value, std::size_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
  }
  std::size_t end_ = 0;
  std::size_t alignment_ = 1;
};

/// Members in the order of append_grouped: those of one instance in a structure of theirs.
template <class FieldOf>
CStructurePlaces places_of(const std::vector<Member>& members, bool float32, FieldOf field_of) {
  CStructurePlaces made{.offsets = std::vector<std::size_t>(members.size())};
  const auto groups = places_by_group(members);
  const auto add = [&](Placing& placing, std::size_t i) {
    const Field& field = field_of(i);
    const std::size_t size = c_size(field.type, float32);
    return placing.add(size * field.length, size);
  };
  Placing outer;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].group.empty()) {
      made.offsets[i] = add(outer, i);
    } else if (!groups[i].empty()) {
      Placing inner;
      for (const std::size_t place : groups[i]) {
        made.offsets[place] = add(inner, place);
      }
      const std::size_t begin = outer.add(inner.size(), inner.alignment());
      for (const std::size_t place : groups[i]) {
        made.offsets[place] += begin;
      }
    }
  }
  made.size = std::max<std::size_t>(outer.size(), 1);
  return made;
}

CStructurePlaces places_of(const std::vector<Port>& ports, bool float32) {
  CStructurePlaces made;
  Placing placing;
  for (const Port& port : ports) {
    const std::size_t size = c_size(port.type, float32);
    made.offsets.push_back(placing.add(size, size));
  }
  made.size = std::max<std::size_t>(placing.size(), 1);
  return made;
}

}  // namespace

std::size_t c_size(Type type, bool float32) {
  switch (type) {
    case Type::Bool:
      return 1;
    case Type::Int:
      return 4;
    case Type::Word:
      return 2;
    default:
      return float32 ? 4 : 8;
  }
}

CMemory c_memory(const Graph& graph, const Routine& routine, bool float32) {
  const StructLayout layout(graph, routine, c_words());
  return {
      places_of(layout.names().parameters, float32,
                [&](std::size_t i) -> const Field& { return graph.parameters[i].field; }),
      places_of(layout.names().cells, float32, [&](std::size_t i) -> const Field& { return routine.cells[i].field; }),
      places_of(graph.inputs, float32), places_of(graph.outputs, float32)};
}

}  // namespace hysteron
