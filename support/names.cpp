#include "support/names.hpp"

#include <algorithm>
#include <vector>

namespace hysteron {
namespace {

constexpr char capital(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

template <class Candidate>
std::string_view nearest(std::string_view name, std::span<const Candidate> candidates) {
  std::string_view best;
  std::size_t limit = name.size() / 3;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate, limit);
    if (distance <= limit) {
      best = candidate;
      if (distance == 0) {
        break;
      }
      limit = distance - 1;
    }
  }
  return best;
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return capital(x) == capital(y); });
}

bool is_one_of(std::string_view name, std::span<const std::string_view> known) {
  return std::ranges::any_of(known, [&](std::string_view one) { return equal_ignoring_case(one, name); });
}

std::string in_capitals(std::string_view name) {
  std::string result(name);
  std::transform(result.begin(), result.end(), result.begin(), capital);
  return result;
}

std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > limit) {
    return limit + 1;
  }
  // Optimal string alignment, three rows of the table of distances between prefixes.
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = capital(a[i - 1]) == capital(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && capital(a[i - 1]) == capital(b[j - 2]) && capital(a[i - 2]) == capital(b[j - 1])) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    if (*std::min_element(row.begin(), row.end()) > limit && *std::min_element(last.begin(), last.end()) > limit) {
      return limit + 1;
    }
  }
  return std::min(row[b.size()], limit + 1);
}

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  return nearest(name, candidates);
}
std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates) {
  return nearest(name, candidates);
}

std::string_view meant_member(std::string_view name, std::span<const std::string> members) {
  if (const std::string_view near = nearest_name(name, members); !near.empty()) {
    return near;
  }
  const std::string wanted = in_capitals(name);
  const auto holds = [&](const std::string& one) {
    const std::string member = in_capitals(one);
    return member.starts_with(wanted) || member.ends_with(wanted);
  };
  const auto first = std::ranges::find_if(members, holds);
  return first != members.end() && std::ranges::count_if(members, holds) == 1 ? std::string_view(*first)
                                                                              : std::string_view();
}

}  // namespace hysteron
