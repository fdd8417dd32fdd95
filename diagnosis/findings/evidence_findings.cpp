#include "diagnosis/findings/evidence_findings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "codegen/graph/unit.hpp"
#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of a normal distribution, to both sides.
constexpr double in_95_percent = 1.96;

/// The set that holds the first family.
const SetFinding& first_set(const Evidence& evidence) {
  const std::string& family = evidence.families.front().family;
  const auto found = std::ranges::find_if(evidence.sets, [&](const SetFinding& set) {
    return std::ranges::find(set.laws, family, &LawFinding::family) != set.laws.end();
  });
  return found == evidence.sets.end() ? evidence.sets.front() : *found;
}

EffectFinding finding_of(const LawFinding& law) {
  EffectFinding result{
      .id = law.effect, .edge = law.edge, .drivers = law.drivers, .share = std::clamp(law.closed, 0.0, 1.0)};
  for (const LawValue& value : law.values) {
    if (value.error > 0.0) {
      result.parameters.push_back({.name = value.name,
                                   .value = value.value,
                                   .low = value.value - in_95_percent * value.error,
                                   .high = value.value + in_95_percent * value.error,
                                   .unit = value.unit});
    } else if (std::isfinite(value.value)) {
      result.settings.push_back({.name = value.name, .value = value.value});
    }
  }
  return result;
}

/// A unit in terms of the signal that an effect acts on ('x) and of the one that drives it ('v), in their units;
/// nothing where these are not known.
std::string unit_in(std::string text, const MissingPicture& picture) {
  const auto put = [&](std::string_view variable, const std::string& unit) {
    for (std::size_t at = 0; (at = text.find(variable, at)) != std::string::npos;) {
      text.replace(at, variable.size(), fmt::format("({})", unit.empty() ? "'" : unit));
    }
  };
  put("'x", picture.unit);
  put("'v", picture.over_unit);
  std::string reason;
  const std::optional<units::Unit> unit = units::parse_unit(text, reason);
  return unit ? units::unit_text(*unit) : std::string();
}

/// The sizes of an effect in the unit of what is missing, as "UP 0.19, DOWN 0.26 m/s^2".
std::string sizes_of(const EffectFinding& effect, const MissingPicture& picture) {
  std::vector<std::string> sizes;
  for (const ParameterFinding& parameter : effect.parameters) {
    const bool determined = std::isfinite(parameter.low) && std::isfinite(parameter.high);
    if (determined && !picture.unit.empty() && effect.edge == picture.edge && parameter.unit == picture.unit) {
      sizes.push_back(fmt::format("{} {:.3g}", parameter.name, parameter.value));
    }
  }
  return sizes.empty() || sizes.size() > 2 ? std::string() : fmt::format("{} {}", fmt::join(sizes, ", "), picture.unit);
}

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100.0 * std::clamp(share, 0.0, 1.0));
}

std::string capitalised(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

}  // namespace

std::string words_of_family(const std::string& family) {
  std::string words = family;
  std::ranges::replace(words, '_', ' ');
  return words;
}

void tell(const Evidence& evidence, const Rules& rules, Diagnosis& result) {
  const SetFinding& first = first_set(evidence);
  std::vector<EffectFinding> effects;
  for (const LawFinding& law : first.laws) {
    if (law.closed < rules[policy::relevant] && first.laws.size() > 1) {
      continue;  // significant, and not relevant
    }
    EffectFinding finding = finding_of(law);
    const auto fitted = std::ranges::find_if(
        result.effects, [&](const EffectFinding& one) { return one.id == finding.id && one.edge == finding.edge; });
    if (fitted != result.effects.end()) {
      fitted->share = finding.share;
      finding = *fitted;
    }
    for (ParameterFinding& parameter : finding.parameters) {
      parameter.unit =
          unit_in(parameter.unit, finding.edge == evidence.picture.edge ? evidence.picture : MissingPicture{});
    }
    effects.push_back(std::move(finding));
  }
  const std::string& family = evidence.families.front().family;
  const auto in_front = [&](const EffectFinding& one) {
    const auto law = std::ranges::find(first.laws, one.id, &LawFinding::effect);
    return law != first.laws.end() && law->family == family;
  };
  std::ranges::stable_sort(effects, [](const EffectFinding& a, const EffectFinding& b) { return a.share > b.share; });
  (void)std::stable_partition(effects.begin(), effects.end(), in_front);
  for (EffectFinding& fitted : result.effects) {
    fitted.around_plant = std::ranges::none_of(
        first.laws, [&](const LawFinding& law) { return law.effect == fitted.id && law.edge == fitted.edge; });
    if (fitted.around_plant) {
      effects.push_back(std::move(fitted));
    }
  }
  result.effects = std::move(effects);
  result.rivals.clear();
  for (const SetFinding& set : evidence.sets) {
    Rival rival{.improved_rms = &set == &first ? result.gap.improved : std::numeric_limits<double>::quiet_NaN(),
                .support = std::log(std::max(set.probability, 1e-12) / std::max(first.probability, 1e-12)),
                .probability = set.probability};
    for (const LawFinding& law : set.laws) {
      rival.effects.push_back(law.effect);
      rival.edges.push_back(law.edge);
      rival.parameters += law.values.size();
    }
    if (set.probability >= rules[policy::rival] || &set == &first) {
      result.rivals.push_back(std::move(rival));
    }
  }
  result.confidence = confidence_of(evidence, first);
}

double confidence_of(const Evidence& evidence, const SetFinding& set) {
  // √closed is the correlation of what the set predicts with what is missing: of a gap that is mostly open, a cause
  // that no effect of the library is may be all there is.
  const double correlation = std::sqrt(std::clamp(set.closed, 0.0, 1.0));
  return std::min(evidence.families.front().probability * correlation, 0.99);
}

namespace {

/// What closes most of the gap by itself beside what is named. It may be more, and not come again in other stretches.
std::string next_words(const FamilyFinding& next, const FamilyFinding& named) {
  const std::string words = words_of_family(next.family);
  return next.alone > named.alone ? fmt::format("; {} closes more by itself, {}, and is less probable, {:.2f}", words,
                                                percent(next.alone), next.probability)
                                  : fmt::format("; next best {}, {}", words, percent(next.alone));
}

}  // namespace

std::string sentence_of(const Diagnosis& found, const Rules& rules) {
  const Evidence& evidence = found.evidence;
  const SetFinding& first = first_set(evidence);
  const FamilyFinding& family = evidence.families.front();
  const std::string sizes = found.effects.empty() ? std::string() : sizes_of(found.effects.front(), evidence.picture);
  std::string text = fmt::format("{} at {}{} closes {} of the gap by itself, on stretches not fitted",
                                 capitalised(words_of_family(family.family)), family.edge,
                                 sizes.empty() ? sizes : fmt::format(", {},", sizes), percent(family.alone));
  std::vector<std::string> beside;
  const FamilyFinding* next = nullptr;
  for (const FamilyFinding& one : evidence.families) {
    if (&one == &family) {
      continue;
    }
    if (one.probability > rules[policy::named] && one.closed > rules[policy::relevant]) {
      beside.push_back(
          fmt::format("{} at {} (probability {:.2f})", words_of_family(one.family), one.edge, one.probability));
    } else if (one.alone > rules[policy::relevant] && (next == nullptr || one.alone > next->alone)) {
      next = &one;
    }
  }
  const std::string by_record = found.siblings == 0
                                    ? std::string()
                                    : fmt::format(" with {} sibling{}, {:.2f} by this record alone", found.siblings,
                                                  found.siblings == 1 ? "" : "s", family.by_record);
  text += fmt::format(" (probability {:.2f}{}{})", family.probability, by_record,
                      next == nullptr ? std::string() : next_words(*next, family));
  if (!beside.empty()) {
    text += fmt::format(". With {} it closes {}", fmt::join(beside, " and "), percent(first.closed));
  }
  std::vector<std::string> around;
  for (const EffectFinding& one : found.effects) {
    if (one.around_plant) {
      around.push_back(fmt::format("{} at {}", words_of_family(one.id), one.edge));
    }
  }
  return fmt::format(
      "{}. The rest, {}, no effect of the library explains.{}", text,
      percent(1.0 - (beside.empty() ? family.alone : first.closed)),
      around.empty() ? std::string() : fmt::format(" Around the plant, its loop has {}.", fmt::join(around, " and ")));
}

}  // namespace hysteron::diagnosis
