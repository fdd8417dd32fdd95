#include "tool/picture_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "plots/figure_svg.hpp"
#include "plots/page.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "tool/outside_program.hpp"
#include "tool/writable.hpp"

namespace hysteron::tool {
namespace {

/// rsvg-convert, from the path or as the environment variable RSVG_CONVERT names it.
const OutsideProgram& converter() {
  static const OutsideProgram program{.name = "rsvg-convert",
                                      .variable = "RSVG_CONVERT",
                                      .package = "librsvg2-bin",
                                      .missing = error::no_graphviz,
                                      .failed = error::graphviz_failed,
                                      .trial = "see whether it converts anything: rsvg-convert X.svg -o X.png"};
  return program;
}
constexpr const char* without_png = "a name that ends in .svg or .html";

std::string ending_of(const std::string& file) {
  return in_capitals(std::filesystem::path(file).extension().string());
}

}  // namespace

void refuse_unfit_picture(const std::string& file, const std::string& option, const std::vector<InputFile>& inputs) {
  const std::string ending = ending_of(file);
  if (ending != ".SVG" && ending != ".PNG" && ending != ".HTML") {
    throw InputError(error::bad_usage, {.file = file}, fmt::format("No picture is called {}.", file),
                     fmt::format("end the name of {} in .svg, .png, or .html for a page with zoom.", option));
  }
  refuse_to_overwrite({.file = file, .mend = fmt::format("give another name for {}.", option)}, inputs);
  refuse_unwritable(file);
  if (ending == ".PNG") {
    (void)found(converter(), without_png);
  }
}

std::string picture_bytes(const std::string& file, const std::string& title, std::span<const plots::Figure> figures) {
  const std::string ending = ending_of(file);
  if (ending == ".HTML") {
    plots::FigurePage page;
    std::string body;
    for (const plots::Figure& figure : figures) {
      plots::Figure shown = figure;
      if (shown.title == title) {
        shown.title.clear();  // it stands at the top of the page
      }
      body += page.place(shown);
    }
    return page.text(title, body);
  }
  const std::string svg = plots::figures_svg(figures);
  return ending == ".PNG" ? converted(converter(), {"--format=png", "--zoom=1.5"}, svg, without_png) : svg;
}

}  // namespace hysteron::tool
