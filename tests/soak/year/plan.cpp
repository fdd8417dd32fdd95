#include "tests/soak/year/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hysteron::soak {
namespace {

constexpr double second = 1e9;
constexpr double hour = 3600.0 * second;
constexpr double day = 24.0 * hour;

struct Rate {
  Happening what;
  std::string_view name;
  double a_year;   ///< at density 1
  double longest;  ///< how long it lasts at the most
};

/// More than a bad site has, so that a year is enough for rare meetings of two of them.
constexpr std::array<Rate, happening_count> rates{{
    {Happening::PowerCut, "power cut", 365, 0},
    {Happening::CutWithCommit, "power cut while a client commits", 365, 0},
    {Happening::Kill, "process killed", 104, 0},
    {Happening::Restart, "restart with an edited diagram", 104, 0},
    {Happening::OnlineChange, "online change", 208, 0},
    {Happening::RefusedChange, "online change with a jump", 104, 0},
    {Happening::Commit, "commit", 2000, 0},
    {Happening::DeviceLost, "device lost", 730, 0.5 * hour},
    {Happening::SensorBroken, "sensor broken", 365, 0.5 * hour},
    {Happening::LateWake, "late wake", 1000, 0},
    {Happening::Overload, "overload", 1000, 0},
    {Happening::DiskFull, "disk full", 52, 4.0 * hour},
    {Happening::ClockStep, "clock step", 104, 6.0 * hour},
    {Happening::NewCertificate, "new certificate", 0, 0},
}};

double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

}  // namespace

std::string_view name_of(Happening what) {
  return rates[static_cast<std::size_t>(what)].name;
}

Plan make_plan(const PlanSettings& settings) {
  Plan plan{.settings = settings};
  std::mt19937_64 random(settings.seed);
  const auto span = static_cast<double>(settings.span);
  const double shrink = std::min(1.0, 1.0 / settings.density);
  for (const Rate& rate : rates) {
    const double gap = 365.0 * day / (rate.a_year * settings.density);
    for (double at = 0.0; rate.a_year > 0.0;) {
      at += -gap * std::log(1.0 - uniform(random));
      if (at >= span) {
        break;
      }
      plan.events.push_back(
          {.at = static_cast<std::int64_t>(at),
           .what = rate.what,
           .lasts = static_cast<std::int64_t>(uniform(random) * std::max(60.0 * second, rate.longest * shrink)),
           .number = random()});
    }
  }
  // Certificates count for 90 days, or for a fifth of a short span; a new one is written up to 30 days before that, or
  // up to two too late.
  const double term = std::min(90.0 * day, span / 5.0);
  for (double from = 0.0; from < span;) {
    const double written = from + (from > 0.0 ? term * (-0.33 + 0.36 * uniform(random)) : 0.0);
    plan.certificates.push_back({.from = static_cast<std::int64_t>(std::min(from, written)),
                                 .until = static_cast<std::int64_t>(from + term),
                                 .written = static_cast<std::int64_t>(written)});
    if (from > 0.0) {
      plan.events.push_back({.at = static_cast<std::int64_t>(written),
                             .what = Happening::NewCertificate,
                             .number = plan.certificates.size() - 1});
    }
    from += term;
  }
  std::ranges::stable_sort(plan.events, {}, &Event::at);
  return plan;
}

}  // namespace hysteron::soak
