#include "diagnosis/evidence/set_search.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "diagnosis/model/parallel.hpp"

namespace hysteron::diagnosis {
namespace {

/// Costs alone: kinds that are kept of each size, of these polished, and the sets that a further law is added to.
constexpr std::size_t kept_of_size = 60;
constexpr std::size_t polished = 12;
constexpr std::size_t singles_extended = 8;
constexpr std::size_t pairs_extended = 6;
/// So that the sets that are extended are not all of one family.
constexpr int extended_of_family = 2;

}  // namespace

SetSearch::SetSearch(const std::vector<Law>& laws, const BlockRegression& regression, unsigned threads)
    : laws_(laws), regression_(regression), threads_(threads) {}

std::vector<LawSet> SetSearch::run() const {
  std::vector<LawSet> all{bare()};
  std::vector<LawSet> front = all;
  for (int size = 1; size <= 3; ++size) {
    std::vector<LawSet> found;
    for (const LawSet& from : front) {
      std::ranges::move(extended(from), std::back_inserter(found));
    }
    std::ranges::stable_sort(found, {}, &LawSet::log_square);
    std::vector<LawSet> kept;
    std::set<std::vector<std::string>> kinds;
    for (LawSet& one : found) {
      if (kept.size() < kept_of_size && kinds.insert(kind_of(one)).second) {
        kept.push_back(std::move(one));
      }
    }
    for (std::size_t i = 0; i < std::min(polished, kept.size()); ++i) {
      polish(kept[i]);
    }
    std::ranges::stable_sort(kept, {}, &LawSet::log_square);
    front.clear();
    std::map<std::vector<std::string>, int> families;
    for (const LawSet& one : kept) {
      if (front.size() < (size == 1 ? singles_extended : pairs_extended) &&
          ++families[families_of(one)] <= extended_of_family) {
        front.push_back(one);
      }
    }
    std::ranges::move(kept, std::back_inserter(all));
  }
  return all;
}

std::vector<LawSet> SetSearch::extended(const LawSet& from) const {
  std::vector<LawSet> more(laws_.size());
  in_parallel(laws_.size(), threads_, [&](std::size_t i) {
    const bool twice = std::ranges::any_of(from.laws, [&](std::size_t j) { return laws_[j].is_like(laws_[i]); });
    if (!twice) {
      std::vector<std::size_t> list = from.laws;
      list.push_back(i);
      more[i] = fitted(std::move(list));
    }
  });
  std::erase_if(more, [](const LawSet& one) { return !one.score.allowed; });
  return more;
}

std::vector<std::string> SetSearch::families_of(const LawSet& one) const {
  std::set<std::string> names;
  for (const std::size_t i : one.laws) {
    names.insert(laws_[i].family);
  }
  return {names.begin(), names.end()};
}

LawSet SetSearch::fitted(std::vector<std::size_t> list, bool bounded) const {
  std::vector<const Law*> laws;
  laws.reserve(list.size());
  for (const std::size_t i : list) {
    laws.push_back(&laws_[i]);
  }
  LawSet result{.laws = std::move(list), .score = regression_.with(laws, bounded)};
  result.log_square =
      result.score.allowed ? regression_.log_square(result.score.held_out) : std::numeric_limits<double>::infinity();
  return result;
}

LawSet SetSearch::bare() const {
  LawSet result{.score = regression_.bare()};
  result.log_square = regression_.log_square(result.score.held_out);
  return result;
}

std::vector<std::string> SetSearch::kind_of(const LawSet& one) const {
  std::vector<std::string> names;
  for (const std::size_t i : one.laws) {
    std::string name = laws_[i].effect + "@" + laws_[i].edge;
    for (const std::string& driver : laws_[i].drivers) {
      name += "|" + driver;
    }
    names.push_back(std::move(name));
  }
  std::ranges::sort(names);
  return names;
}

void SetSearch::polish(LawSet& one) const {
  for (bool better = one.laws.size() > 1; better;) {
    better = false;
    for (std::size_t member = 0; member < one.laws.size(); ++member) {
      const Law& law = laws_[one.laws[member]];
      for (std::size_t i = 0; i < laws_.size(); ++i) {
        if (i == one.laws[member] || !laws_[i].is_like(law)) {
          continue;
        }
        std::vector<std::size_t> list = one.laws;
        list[member] = i;
        LawSet other = fitted(std::move(list));
        if (other.score.allowed && other.log_square < one.log_square) {
          one = std::move(other);
          better = true;
        }
      }
    }
  }
}

}  // namespace hysteron::diagnosis
