#include "runtime/task/layout_text.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::string_view interpreted = "-interpreter";
constexpr std::string_view compiled = "-compiled";
constexpr std::string_view of_float32 = "-float32";

}  // namespace

std::string layout_text(std::string_view diagram, bool is_compiled, bool is_float32) {
  std::string text(diagram);
  text += is_compiled ? compiled : interpreted;
  text += is_float32 ? of_float32 : "";
  return text;
}

std::string diagram_of(std::string layout) {
  for (const std::string_view engine : {interpreted, compiled}) {
    if (const auto at = layout.find(engine); at != std::string::npos) {
      layout.erase(at, engine.size());
    }
  }
  return layout;
}

LayoutEngine engine_in(std::string_view layout) {
  return {.is_interpreted = layout.find(interpreted) != std::string_view::npos,
          .is_float32 = layout.ends_with(of_float32)};
}

}  // namespace hysteron::runtime
