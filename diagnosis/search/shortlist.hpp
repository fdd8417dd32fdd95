// Which of the candidates that were screened are followed: a choice by what they gain, that gives each effect its turn.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/search/screening.hpp"

namespace hysteron::diagnosis {

/// The best of a list by their gains, so many, and of each effect its two best edges; places in the list.
[[nodiscard]] std::vector<std::size_t> front_of(const std::vector<Screened>& list,
                                                const std::vector<Candidate>& candidates, std::size_t count);

/// Of a list sorted by gain the best ones, so many, but of no effect more than `most_edges`, so that others get their
/// turn; each effect gets its best edges, `of_each` of them: what a grid promises of a level says little of what a fit
/// finds.
void keep_best(std::vector<Screened>& list, std::size_t count, int of_each, int most_edges = 5);

/// Of a list sorted by gain the best edges of these effects on which they have not been fitted, of each so many at
/// most.
[[nodiscard]] std::vector<Screened> on_untried_edges(const std::vector<Screened>& list,
                                                     const std::set<std::string>& effects,
                                                     const std::vector<Applied>& fitted, int most_edges);

}  // namespace hysteron::diagnosis
