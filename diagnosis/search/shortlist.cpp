#include "diagnosis/search/shortlist.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace hysteron::diagnosis {
namespace {

/// Gains of one effect on two edges that differ by less, relatively, are of the same signal.
constexpr double same_gain = 1e-5;

}  // namespace

std::vector<std::size_t> front_of(const std::vector<Screened>& list, const std::vector<Candidate>& candidates,
                                  std::size_t count) {
  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return list[a].gain() > list[b].gain(); });
  std::map<std::string, int> taken;
  std::vector<std::size_t> front;
  for (const std::size_t at : order) {
    if (front.size() < count || ++taken[candidates[at].kind.id] <= 2) {
      front.push_back(at);
    }
  }
  return front;
}

void keep_best(std::vector<Screened>& list, std::size_t count, int of_each, int most_edges) {
  std::map<std::string, int> taken;
  std::vector<Screened> kept;
  for (Screened& one : list) {
    // Two edges with nothing but a gain between them are one: the other one gets the place.
    const auto twin = std::ranges::find_if(kept, [&](const Screened& other) {
      return other.candidate.own().effect == one.candidate.own().effect &&
             std::abs(other.gain() - one.gain()) <= same_gain * other.gain();
    });
    if (twin != kept.end()) {
      if (one.candidate.upstream < twin->candidate.upstream) {  // the first place where it can be
        one.candidate.variant.effects.back().twins = std::move(twin->candidate.variant.effects.back().twins);
        std::swap(*twin, one);
      }
      if (one.candidate.own().edge != twin->candidate.own().edge) {
        twin->candidate.variant.effects.back().twins.push_back(one.candidate.own().edge);
      }
      continue;
    }
    int& times = taken[one.candidate.own().effect];
    const bool gap = std::ranges::any_of(one.starts, &Start::about_calibration);
    if (times < most_edges && (kept.size() < count || times < of_each || (gap && times < 2))) {
      ++times;
      kept.push_back(std::move(one));
    }
  }
  list = std::move(kept);
}

std::vector<Screened> on_untried_edges(const std::vector<Screened>& list, const std::set<std::string>& effects,
                                       const std::vector<Applied>& fitted, int most_edges) {
  std::set<std::string> places;
  for (const Applied& one : fitted) {
    places.insert(one.place());
    for (const std::string& twin : one.twins) {
      places.insert(Applied{.effect = one.effect, .edge = twin}.place());
    }
  }
  std::vector<Screened> result;
  std::ranges::copy_if(list, std::back_inserter(result), [&](const Screened& one) {
    return effects.contains(one.candidate.own().effect) && !places.contains(one.candidate.own().place());
  });
  keep_best(result, result.size(), 1, most_edges);
  return result;
}

}  // namespace hysteron::diagnosis
