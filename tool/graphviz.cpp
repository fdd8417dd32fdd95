#include "tool/graphviz.hpp"

#include "support/errors.hpp"
#include "tool/outside_program.hpp"

namespace hysteron::tool {

std::string drawn_by_graphviz(const std::string& text, const std::string& format, const std::string& without) {
  const OutsideProgram dot{.name = "dot",
                           .variable = "GRAPHVIZ_DOT",
                           .package = "graphviz",
                           .missing = error::no_graphviz,
                           .failed = error::graphviz_failed,
                           .trial = "see whether this dot draws anything: echo 'digraph {a}' | dot -Tsvg"};
  return converted(dot, {"-T" + format}, text, without);
}

}  // namespace hysteron::tool
