#include "codegen/backends/shared/place_pattern.hpp"

#include <cstdlib>
#include <utility>

#include "codegen/backends/shared/generated_file.hpp"

namespace hysteron {
namespace {

struct PlacedText {
  std::vector<std::string> between{std::string()};
  std::vector<std::int64_t> places{};
};

/// Digits alone in square brackets are a place.
PlacedText split_at_places(std::string_view text) {
  constexpr std::size_t longest_place = 9;
  PlacedText made;
  for (std::size_t at = 0; at < text.size(); ++at) {
    made.between.back() += text[at];
    const std::size_t end = text[at] == '[' ? text.find_first_not_of("0123456789", at + 1) : at;
    const bool is_place =
        end != std::string_view::npos && end > at + 1 && text[end] == ']' && end - at <= longest_place;
    if (is_place) {
      made.places.push_back(std::stoll(std::string(text.substr(at + 1, end - at - 1))));
      made.between.emplace_back("]");
      at = end;
    }
  }
  return made;
}

}  // namespace

PlacePattern::PlacePattern(std::string_view text) {
  PlacedText split = split_at_places(text);
  between_ = std::move(split.between);
  for (const std::int64_t place : split.places) {
    places_.push_back({.first = place});
  }
}

bool PlacePattern::takes(std::string_view text, std::size_t row, std::size_t column) {
  const PlacedText split = split_at_places(text);
  if (split.between != between_) {
    return false;
  }
  std::vector<PlaceNumber> grown = places_;
  for (std::size_t i = 0; i < grown.size(); ++i) {
    PlaceNumber& one = grown[i];
    if (row == 1 && column == 0 && !one.by_row) {
      one.by_row = split.places[i] - one.first;
    }
    if (row == 0 && column == 1 && !one.by_column) {
      one.by_column = split.places[i] - one.first;
    }
    const std::int64_t expected = one.first + one.by_row.value_or(0) * static_cast<std::int64_t>(row) +
                                  one.by_column.value_or(0) * static_cast<std::int64_t>(column);
    if (split.places[i] != expected) {
      return false;
    }
  }
  places_ = std::move(grown);
  return true;
}

std::string PlacePattern::place_text(const PlaceNumber& place, const PlaceWords& words) {
  const std::int64_t by_row = words.row.empty() ? 0 : place.by_row.value_or(0);
  const std::int64_t by_column = words.column.empty() ? 0 : place.by_column.value_or(0);
  if (by_row == 0 && by_column == 0) {
    return std::to_string(place.first);
  }
  const auto number = [&](std::int64_t value) { return std::to_string(value) + std::string(words.number_end); };
  const bool is_sum = place.first != 0 || (by_row != 0 && by_column != 0);
  std::string text;
  const auto add = [&](std::string_view sign, const std::string& part) {
    append(text, text.empty() ? "" : sign, part);
  };
  const auto add_product = [&](std::int64_t by, std::string_view name, bool wanted) {
    if (by == 0 || !wanted) {
      return;
    }
    const bool is_name = std::abs(by) == 1;
    const bool in_brackets = words.brackets && is_sum && !is_name;
    const std::string product = is_name ? std::string(name) : number(std::abs(by)) + " * " + std::string(name);
    add(by < 0 ? " - " : " + ", in_brackets ? "(" + product + ")" : product);
  };
  // What is taken off stands last: no result between is below 0.
  add_product(by_row, words.row, by_row > 0);
  add_product(by_column, words.column, by_column > 0);
  if (place.first != 0) {
    add(" + ", number(place.first));
  }
  add_product(by_row, words.row, by_row < 0);
  add_product(by_column, words.column, by_column < 0);
  return text;
}

std::string PlacePattern::text(const PlaceWords& words, std::string_view of_sum) const {
  std::string text = between_.front();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    append(text, place_text(places_[i], words), between_[i + 1]);
  }
  for (std::size_t at = text.find(PlacePattern::sum); at != std::string::npos; at = text.find(PlacePattern::sum, at)) {
    text.replace(at, PlacePattern::sum.size(), of_sum);
    at += of_sum.size();
  }
  return text;
}

PlacePattern PlacePattern::after_rows(std::size_t rows) const {
  PlacePattern later = *this;
  for (PlaceNumber& place : later.places_) {
    place.first += place.by_row.value_or(0) * static_cast<std::int64_t>(rows);
  }
  return later;
}

}  // namespace hysteron
