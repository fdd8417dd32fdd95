// What an engineer would say of a fleet, in sentences.
#pragma once

#include <string>
#include <vector>

#include "fleet/report/analysis.hpp"

namespace hysteron::fleet {

/// `19 N`; the number alone where there is no unit, or none but 1.
[[nodiscard]] std::string quantity(const std::string& number, const std::string& unit);

/// `3 of 100 machines stand out.` and what else the whole has to say, a sentence each.
[[nodiscard]] std::vector<std::string> headline(const Analysis& all, const std::vector<Row>& rows);

/// Of one machine, which is not named in it: `FRICTION.FC grows since 2026-05-02, from 12 to 19 N.`
[[nodiscard]] std::string sentence(const Analysis& all, const Finding& finding);

/// How the findings were chosen, with each threshold and where it comes from.
[[nodiscard]] std::vector<std::string> method(const Analysis& all);

}  // namespace hysteron::fleet
