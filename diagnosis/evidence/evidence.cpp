#include "diagnosis/evidence/evidence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "diagnosis/evidence/draws.hpp"
#include "diagnosis/evidence/gap_budget.hpp"
#include "diagnosis/evidence/missing_space.hpp"
#include "diagnosis/evidence/open_loop.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/evidence/set_search.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/search/expansion.hpp"

namespace hysteron::diagnosis {
namespace {

/// A space with its laws, and the sets of them that were fitted.
struct Explored {
  std::shared_ptr<const Space> space{};
  std::shared_ptr<const Blocks> blocks{};
  std::shared_ptr<const std::vector<Law>> laws{};  ///< the search points into them
  std::shared_ptr<const BlockRegression> regression{};
  std::shared_ptr<const SetSearch> search{};
  LawSet bare{};
};

/// By the larger of where each known parameter was tuned to and where it is calibrated; one that is 0 may go anywhere.
VectorXd reach_of(const Task& task, const Explanation& calibrated) {
  VectorXd result(std::ssize(task.known));
  for (Index j = 0; j < result.size(); ++j) {
    const double size =
        std::max(std::abs(task.known[static_cast<std::size_t>(j)].start), std::abs(calibrated.fit.x[j]));
    result[j] = size > 0.0 ? policy::reach.value * size : std::numeric_limits<double>::infinity();
  }
  return result;
}

/// The same laws, held to their tests or not.
Explored weighed(Explored result, const VectorXd& reach, bool is_held_to_tests, unsigned threads) {
  BlockRegression regression(*result.blocks, result.blocks->thinned(result.space->residuals()).col(0),
                             result.blocks->thinned(result.space->known()),
                             {.reach = reach, .is_held_to_tests = is_held_to_tests});
  regression.weigh(regression.bare().held_out);
  result.regression = std::make_shared<const BlockRegression>(std::move(regression));
  result.search = std::make_shared<const SetSearch>(*result.laws, *result.regression, threads);
  result.bare = result.search->bare();
  return result;
}

Explored explored(const Task& task, const Explanation& calibrated, std::unique_ptr<Space> space,
                  const EvidenceOptions& options) {
  Explored result{.space = std::move(space)};
  result.blocks =
      std::make_shared<const Blocks>(task, result.space->outputs(), static_cast<std::size_t>(policy::blocks.value),
                                     static_cast<std::size_t>(policy::rows.value));
  result.laws = std::make_shared<const std::vector<Law>>(laws_of(
      task, *result.space, calibrated, *result.blocks, {.effects = options.effects, .threads = options.threads}));
  return weighed(std::move(result), reach_of(task, calibrated), true, options.threads);
}

bool has_place(const Space& space, const std::string& edge) {
  return std::ranges::any_of(space.places(), [&](const Space::Place& place) { return place.edge.name == edge; });
}

/// The sets of one view: what is compared in one space, and what acts behind the places of that one, from the outputs.
/// Those of the outputs that need no other place are there to be measured by.
struct View {
  std::size_t own = 0;  ///< the space
  std::vector<LawSet> told{};
  std::vector<LawSet> yardsticks{};
};

bool is_of_outputs(const LawSet& set, const std::vector<Explored>& spaces) {
  return spaces[set.space].space->name() == OutputSpace::title;
}

/// Whether a set acts behind the place where what is missing can be seen.
bool is_elsewhere(const LawSet& set, const std::vector<Explored>& spaces, std::size_t own) {
  return set.space != own && is_of_outputs(set, spaces) && std::ranges::any_of(set.laws, [&](std::size_t law) {
           return !has_place(*spaces[own].space, (*spaces[set.space].laws)[law].edge);
         });
}

/// A view for each space, that of the outputs, which are the first space, last: it has its own sets alone.
std::vector<View> views_of(std::vector<Explored>& spaces) {
  std::vector<View> result;
  for (std::size_t own = spaces.size(); own-- > 0;) {
    result.push_back({.own = own});
  }
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    for (LawSet& set : spaces[i].search->run()) {
      set.space = i;
      set.log_square -= spaces[i].bare.log_square;
      for (View& view : result) {
        if (i == view.own || is_elsewhere(set, spaces, view.own)) {
          view.told.push_back(set);
        } else if (is_of_outputs(set, spaces)) {
          view.yardsticks.push_back(set);
        }
      }
    }
  }
  return result;
}

/// Sets by how often each is the best, and how much that counts; returns the same of families, and of the effects in
/// them.
struct Votes {
  std::map<std::string, double> families{};
  std::map<std::string, double> by_record{};  ///< of families, each time alike
  std::map<std::pair<std::string, std::string>, double> members{};
};
Votes vote(const std::vector<Explored>& spaces, View& sets, std::uint64_t seed, const Prior& prior,
           const Rules& rules) {
  Draws draws(seed, spaces.front().blocks->count(), rules);
  Votes votes;
  // What no draw changes: it would be found some thousand times.
  struct Entry {
    LawSet* set = nullptr;
    std::vector<std::string> families{};
  };
  const auto entries = [&](std::vector<LawSet>& list, bool elsewhere) {
    std::vector<Entry> result;
    for (LawSet& set : list) {
      if (is_elsewhere(set, spaces, sets.own) == elsewhere) {
        result.push_back({.set = &set, .families = spaces[set.space].search->families_of(set)});
      }
    }
    return result;
  };
  const std::vector<Entry> at_hand = entries(sets.told, false);
  const std::vector<Entry> yardsticks = entries(sets.yardsticks, false);
  const std::vector<Entry> elsewhere = entries(sets.told, true);
  const auto count = static_cast<int>(policy::draws.value);
  double sum = 0.0;
  for (int draw = 0; draw < count; ++draw) {
    draws.draw();
    std::vector<double> bare;
    bare.reserve(spaces.size());
    for (const Explored& one : spaces) {
      bare.push_back(one.regression->log_square(one.bare.score.held_out, draws.weights()));
    }
    const auto left_by = [&](const Entry& entry) {
      const LawSet& set = *entry.set;
      return spaces[set.space].regression->log_square(set.score.held_out, draws.weights()) - bare[set.space] +
             draws.cost(entry.families, set.laws.size());
    };
    const Entry* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    const auto take = [&](const Entry& entry, double left) {
      if (left < least) {
        least = left;
        best = &entry;
      }
    };
    for (const Entry& entry : at_hand) {
      take(entry, left_by(entry));
    }
    // Shares of the missing signal and of the outputs are no one scale: noise has another part in each. A set of
    // another place counts by how much better it is at the outputs than the best that needs none.
    double yardstick = std::numeric_limits<double>::infinity();
    for (const Entry& entry : yardsticks) {
      yardstick = std::min(yardstick, left_by(entry));
    }
    const double least_at_hand = least;
    for (const Entry& entry : elsewhere) {
      take(entry, least_at_hand + left_by(entry) - yardstick + rules[policy::another_place]);
    }
    const double counts = prior.weight_of_set(best->families);
    sum += counts;
    best->set->probability += counts;
    for (const std::string& family : best->families) {
      votes.families[family] += counts;
      votes.by_record[family] += 1.0;
    }
    std::set<std::pair<std::string, std::string>> members;  // each once, however often the set has it
    for (const std::size_t i : best->set->laws) {
      const Law& law = (*spaces[best->set->space].laws)[i];
      members.emplace(law.family, law.effect);
    }
    for (const auto& member : members) {
      votes.members[member] += counts;
    }
  }
  for (LawSet& set : sets.told) {
    set.probability /= sum;
  }
  for (auto& [family, votes_of] : votes.families) {
    votes_of /= sum;
  }
  for (auto& [family, votes_of] : votes.by_record) {
    votes_of /= static_cast<double>(count);
  }
  for (auto& [member, votes_of] : votes.members) {
    votes_of /= sum;
  }
  return votes;
}

/// What some of a set's laws close of the held-out gap by themselves; of shares out of their bounds, too.
double closed_by(const Explored& there, std::vector<std::size_t> laws) {
  const LawSet part = there.search->fitted(std::move(laws), false);
  return 1.0 - std::exp(part.log_square - there.bare.log_square);
}

/// What the laws of one group close, in the mean over all orders in which the groups of the set may come (Shapley).
double share_of(const Explored& there, const LawSet& set, const std::vector<std::string>& group_of_law,
                const std::string& group) {
  std::vector<std::string> groups = group_of_law;
  std::ranges::sort(groups);
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  std::erase(groups, group);
  const std::size_t others = groups.size();
  double share = 0.0;
  for (std::size_t chosen = 0; chosen < (std::size_t{1} << others); ++chosen) {
    std::vector<std::size_t> without;
    std::vector<std::size_t> with;
    for (std::size_t k = 0; k < set.laws.size(); ++k) {
      const auto at = static_cast<std::size_t>(std::ranges::find(groups, group_of_law[k]) - groups.begin());
      const bool own = at == others;
      if (own || ((chosen >> at) & 1U) != 0) {
        with.push_back(set.laws[k]);
        if (!own) {
          without.push_back(set.laws[k]);
        }
      }
    }
    const auto before = static_cast<double>(std::popcount(chosen));
    const auto all = static_cast<double>(others + 1);
    // before! (all − before − 1)! / all!
    const double weight = std::exp(std::lgamma(before + 1.0) + std::lgamma(all - before) - std::lgamma(all + 1.0));
    share += weight * (closed_by(there, with) - closed_by(there, without));
  }
  return share;
}

std::vector<std::string> families_by_law(const Explored& there, const LawSet& set) {
  std::vector<std::string> result;
  for (const std::size_t i : set.laws) {
    result.push_back((*there.laws)[i].family);
  }
  return result;
}

/// `known`: the known parameters that the laws were found about.
SetFinding described(const Explored& there, const LawSet& set, const VectorXd& known) {
  SetFinding result{
      .space = there.space->name(), .probability = set.probability, .closed = 1.0 - std::exp(set.log_square)};
  for (Index j = 0; j < known.size(); ++j) {
    result.known.push_back(known[j] + (j < set.score.known.size() ? set.score.known[j] : 0.0));
  }
  std::vector<std::string> numbered;  // each law a group of its own
  for (std::size_t k = 0; k < set.laws.size(); ++k) {
    numbered.push_back(std::to_string(k));
  }
  Index at = 0;
  for (const std::size_t i : set.laws) {
    const Law& law = (*there.laws)[i];
    LawFinding finding{.effect = law.effect, .family = law.family, .edge = law.edge, .drivers = law.drivers};
    for (const auto& [name, value] : law.shape) {
      finding.values.push_back({.name = name, .value = value});
    }
    for (const Law::Term& term : law.terms) {
      if (!term.strength.empty()) {
        finding.values.push_back({.name = term.strength,
                                  .value = term.neutral + term.unit * set.score.shares[at],
                                  .error = std::abs(term.unit) * set.score.errors[at],
                                  .unit = term.measure});
      }
      ++at;
    }
    finding.closed = share_of(there, set, numbered, numbered[result.laws.size()]);
    result.laws.push_back(std::move(finding));
  }
  return result;
}

MissingPicture picture_of(const Explored& there, const LawSet& set, const std::string& family) {
  MissingPicture result;
  const auto own = std::ranges::find_if(set.laws, [&](std::size_t i) { return (*there.laws)[i].family == family; });
  if (own == set.laws.end() || there.space->outputs() != 1) {
    return result;
  }
  const Law& law = (*there.laws)[*own];
  const Space::Place& place = there.space->places()[law.place];
  const auto driver = std::ranges::find_if(there.space->drivers(), [&](const DriverSignal& one) {
    return !law.drivers.empty() && one.name == law.drivers.front();
  });
  const bool driven = driver != there.space->drivers().end();
  const RecordSignals& over = driven ? driver->values : place.carried;
  Index rows = 0;
  for (const Signal& one : over) {
    rows += std::ssize(one);
  }
  VectorXd stacked(rows);
  Index row = 0;
  for (const Signal& one : over) {
    stacked.segment(row, std::ssize(one)) = Eigen::Map<const VectorXd>(one.data(), std::ssize(one));
    row += std::ssize(one);
  }
  const VectorXd places = there.blocks->thinned(stacked).col(0);
  VectorXd missing = there.regression->residuals() + there.regression->known() * set.score.known;
  VectorXd of_law = VectorXd::Zero(missing.size());
  Index at = 0;
  for (const std::size_t i : set.laws) {
    for (Index k = 0; k < (*there.laws)[i].responses.cols(); ++k, ++at) {
      (i == *own ? of_law : missing) += (*there.laws)[i].responses.col(k) * set.score.shares[at];
    }
  }
  result = {.edge = there.space->name() == OutputSpace::title ? law.edge : there.space->name(),
            .unit = there.space->name() == OutputSpace::title ? std::string() : there.space->places().front().unit,
            .effect = law.effect,
            .over = driven ? driver->name : place.edge.name,
            .over_unit = driven ? driver->unit : place.unit};
  result.places.assign(places.begin(), places.end());
  for (Index k = 0; k < missing.size(); ++k) {
    result.missing.push_back(missing[k]);
    result.law.push_back(-of_law[k]);
  }
  return result;
}

}  // namespace

double weight_of_family(const FamilyFinding& one) {
  return one.probability * std::max(0.0, one.closed);
}

bool is_worth_telling(const Evidence& evidence, Rules& rules) {
  if (evidence.families.empty() || evidence.sets.empty()) {
    return false;
  }
  const FamilyFinding& first = evidence.families.front();
  return rules.is_above(policy::named, first.probability, first.family) &&
         rules.is_above(policy::relevant, first.closed, first.family);
}

struct Weighing::Sets {
  std::optional<OpenLoop> open{};
  Explanation plant{};  ///< of the opened loop
  const Task* task = nullptr;
  VectorXd known{};  ///< the known parameters that the laws are found about
  std::vector<Explored> spaces{};
  std::vector<View> views{};
};

Weighing::Weighing(const Task& task, const std::string& top, const Explanation& calibrated,
                   const EvidenceOptions& options)
    : seed_(options.seed), threads_(options.threads), prior_(options.prior), sets_(std::make_unique<Sets>()) {
  sets_->open = opened(task, top, calibrated.variant);  // kept, since the spaces keep references
  const std::optional<OpenLoop>& open = sets_->open;
  if (open) {
    sets_->plant = footing_of(open->task, open->variant).nominal;
  }
  const Task& asked = open ? open->task : task;
  const Explanation& fitted = open ? sets_->plant : calibrated;
  sets_->task = &asked;
  sets_->known = fitted.fit.x.head(std::ssize(asked.known));
  std::vector<Explored>& spaces = sets_->spaces;
  std::unique_ptr<MissingSpace> missing =
      MissingSpace::of_bottleneck(asked, top, fitted, options.columns, options.threads);
  if (!open || !missing) {
    spaces.push_back(explored(
        asked, fitted, std::make_unique<OutputSpace>(asked, top, fitted, options.columns, options.threads), options));
  }
  if (missing) {
    spaces.push_back(explored(asked, fitted, std::move(missing), options));
    const bool has_open_rows =
        std::ranges::any_of(*spaces.back().laws, [](const Law& law) { return law.slacks.cols() > 0; });
    // What a friction may hold at rest is worth a proposal; whether it does, a run of the diagram says.
    if (has_open_rows && !open) {
      spaces.push_back(weighed(spaces.back(), reach_of(asked, fitted), false, options.threads));
    }
  }
  sets_->views = views_of(spaces);
}

Weighing::~Weighing() = default;

std::size_t Weighing::views() const {
  return sets_->views.size();
}

std::optional<GapBudget> Weighing::budget(std::size_t view, const std::string& output) const {
  return gap_budget(*sets_->task, *sets_->spaces[sets_->views[view].own].space, output, threads_);
}

void Weighing::strike_out_first(std::size_t view) {
  std::vector<LawSet>& told = sets_->views[view].told;
  if (!told.empty()) {
    told.erase(told.begin());
  }
}

Evidence Weighing::told(const Rules& rules, std::size_t view) {
  const std::vector<Explored>& spaces = sets_->spaces;
  std::vector<LawSet>& sets = sets_->views[view].told;
  for (LawSet& set : sets) {
    set.probability = 0.0;
  }
  if (sets.empty()) {
    return {};
  }
  const Votes votes = vote(spaces, sets_->views[view], seed_, prior_, rules);
  std::ranges::stable_sort(sets, [](const LawSet& a, const LawSet& b) { return a.probability > b.probability; });

  Evidence result;
  result.is_open_loop = sets_->open.has_value();
  std::set<const std::vector<Law>*> laws;
  for (const Explored& one : spaces) {
    if (laws.insert(one.laws.get()).second) {
      result.tried += one.laws->size();
    }
  }
  for (const auto& [family, probability] : votes.families) {
    FamilyFinding finding{.family = family, .probability = probability, .by_record = votes.by_record.at(family)};
    for (const auto& [member, share] : votes.members) {
      if (member.first == family && share > finding.member * probability) {
        finding.effect = member.second;
        finding.member = share / probability;
      }
    }
    const auto holds = [&, &family = family](const LawSet& set) {
      const std::vector<std::string> names = spaces[set.space].search->families_of(set);
      return std::ranges::find(names, family) != names.end();
    };
    if (const auto set = std::ranges::find_if(sets, holds); set != sets.end()) {
      const Explored& there = spaces[set->space];
      finding.closed = share_of(there, *set, families_by_law(there, *set), family);
      std::vector<std::size_t> own = set->laws;
      std::erase_if(own, [&, &family = family](std::size_t i) { return (*there.laws)[i].family != family; });
      finding.alone = closed_by(there, std::move(own));
      const auto law = std::ranges::find_if(
          set->laws, [&, &family = family](std::size_t i) { return (*there.laws)[i].family == family; });
      finding.edge = (*there.laws)[*law].edge;
    }
    result.families.push_back(std::move(finding));
  }
  std::ranges::stable_sort(result.families, std::ranges::greater(), weight_of_family);
  constexpr std::size_t most_told = 40;
  for (const LawSet& set : sets) {
    if (set.probability > 0.0 && result.sets.size() < most_told) {
      result.sets.push_back(described(spaces[set.space], set, sets_->known));
    }
  }
  if (!result.families.empty() && !sets.front().laws.empty()) {
    const auto shown = std::ranges::find_if(sets, [&](const LawSet& set) {
      const std::vector<std::string> names = spaces[set.space].search->families_of(set);
      return std::ranges::find(names, result.families.front().family) != names.end();
    });
    if (shown != sets.end()) {
      result.picture = picture_of(spaces[shown->space], *shown, result.families.front().family);
    }
  }
  return result;
}

}  // namespace hysteron::diagnosis
