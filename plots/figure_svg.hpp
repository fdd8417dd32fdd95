// A figure as an SVG that stands alone.
#pragma once

#include <span>
#include <string>

#include "plots/figure.hpp"

namespace hysteron::plots {

/// The panels of all figures, one below the other. Of more points than a pixel can show, the extremes are kept; values
/// that are not finite are gaps.
[[nodiscard]] std::string figures_svg(std::span<const Figure> figures);

}  // namespace hysteron::plots
