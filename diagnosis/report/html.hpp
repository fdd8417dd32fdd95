// Words and numbers for the report: escaped, rounded to what a reader can use, with their unit.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/markup.hpp"
#include "support/utf8.hpp"

namespace hysteron::diagnosis::report {

using hysteron::escaped;

/// A number with so many significant digits; a dash where it is not finite.
[[nodiscard]] std::string figure(double value, int digits = 3);

/// The number and its unit, which may be "1" or empty: 1.83 um. Not escaped.
[[nodiscard]] std::string quantity(double value, std::string_view unit, int digits = 3);

/// A share as 93 %, 0.4 %, > 99.9 %, below 0.1 %.
[[nodiscard]] std::string percent(double share);

/// The shares of one whole in percent that sum to 100: the largest remainders are rounded up. What is there and rounds
/// to nothing is `below 1 %`, what is nearly all `> 99 %`.
[[nodiscard]] std::vector<std::string> percents_of_whole(const std::vector<double>& shares);

/// An interval with as many digits as tell its ends apart, four or more.
[[nodiscard]] std::pair<std::string, std::string> interval_ends(double low, double high);

/// A name with its unit in brackets: Y [um]. Not escaped.
[[nodiscard]] std::string with_unit(std::string_view name, std::string_view unit);

/// An identifier as words: even_nonlinearity becomes even nonlinearity.
[[nodiscard]] std::string words_of(std::string_view identifier);

/// A share as a small bar within a line of text.
[[nodiscard]] std::string share_bar(double share, std::string_view css_class);

/// `<ul class="…">` of texts, which are escaped; nothing where there are none.
[[nodiscard]] std::string list_of(const std::vector<std::string>& texts, std::string_view css_class);

}  // namespace hysteron::diagnosis::report
