// A page of HTML that needs nothing beside itself, with figures that can be zoomed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plots/figure.hpp"

namespace hysteron::plots {

struct Page {
  std::string title{};
  std::string style{};   ///< beside style()
  std::string body{};    ///< what stands in the page, as HTML
  std::string data{};    ///< `<script type="application/json" …>` elements
  std::string script{};  ///< behind plot_script() and zoom_script()
};

/// The whole of it. Nothing may be loaded from anywhere, whatever a name in the data may say.
[[nodiscard]] std::string page_text(const Page& page);

/// A page of figures: their places, in the order in which they are added, and the data that its script draws from.
class FigurePage {
 public:
  /// HTML of the place of a figure, to be put into the body.
  [[nodiscard]] std::string place(const Figure& figure);
  [[nodiscard]] std::string text(const std::string& title, const std::string& body) const;

 private:
  std::string figures_;
  std::size_t count_ = 0;
};

/// Colours, text, tables, plots; light, dark and on paper.
[[nodiscard]] std::string_view style();
/// Axes, lines, keys.
[[nodiscard]] std::string_view plot_script();
/// A figure that is zoomed; needs the plot script before it.
[[nodiscard]] std::string_view zoom_script();
/// Draws the figures of a FigurePage.
[[nodiscard]] std::string_view figure_script();

}  // namespace hysteron::plots
