#include "codegen/backends/drawing/box_label.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/backends/drawing/dot_text.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron::dot {

std::string with_unit(std::string_view name, std::string_view unit) {
  return unit.empty() || unit == "1" ? escaped(name) : escaped(name) + " " + small_text(unit);
}

std::string pin_port(std::string_view name) {
  return fmt::format("in {}", language::upper(name));
}

std::string output_port(std::string_view name) {
  return fmt::format("out {}", language::upper(name));
}

void BoxLabel::add_input(std::string_view name, std::string_view unit) {
  left_.push_back(fmt::format("<TD PORT={} ALIGN=\"LEFT\">{}</TD>", quoted(pin_port(name)), with_unit(name, unit)));
}

void BoxLabel::add_output(std::string_view name, std::string_view unit) {
  right_.push_back(
      fmt::format("<TD PORT={} ALIGN=\"RIGHT\">{}</TD>", quoted(output_port(name)), with_unit(name, unit)));
}

std::string BoxLabel::text() const {
  std::string label = fmt::format(
      "<TABLE BORDER=\"0\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"2\"><TR><TD "
      "COLSPAN=\"2\"><B>{}</B></TD></TR>",
      escaped(name_));
  if (!type_.empty()) {
    label += fmt::format("<TR><TD COLSPAN=\"2\">{}</TD></TR>", small_text(type_));
  }
  for (const std::string& one : lines_of(settings_)) {
    label += fmt::format("<TR><TD COLSPAN=\"2\">{}</TD></TR>", small_text(one));
  }
  for (std::size_t i = 0; i < std::max(left_.size(), right_.size()); ++i) {
    label += fmt::format("<TR>{}{}</TR>", i < left_.size() ? left_[i] : "<TD></TD>",
                         i < right_.size() ? right_[i] : "<TD></TD>");
  }
  if (!body_.empty()) {
    label += fmt::format("<HR/><TR><TD COLSPAN=\"2\" ALIGN=\"LEFT\" BALIGN=\"LEFT\">{}</TD></TR>", body_);
  }
  return label + "</TABLE>";
}

}  // namespace hysteron::dot
