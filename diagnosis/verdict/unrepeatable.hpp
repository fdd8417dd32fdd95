// What a machine does that no diagram repeats: steps of unequal widths, a delay that varies, what coarse steps hide.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/model/budget.hpp"
#include "diagnosis/noise/materiality.hpp"
#include "diagnosis/search/search.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

/// One of the first two, or what coarse steps hide where something material is left and that leaves less;
/// the chosen set is then the one that it belongs to.
[[nodiscard]] std::optional<Unrepeatable> unrepeatable(const Task& task, const std::string& top, const Search& search,
                                                       double floor_cost, const SearchOptions& options,
                                                       const Materiality& materiality, Budget& budget,
                                                       Judgement& judgement);

}  // namespace hysteron::diagnosis
