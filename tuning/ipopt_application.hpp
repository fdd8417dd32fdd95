// Ipopt as every search here runs it: quiet, without an option file, with its return codes in the house's words.
// Internal to the sources that run it.
#pragma once

#include <IpIpoptApplication.hpp>

#include "tuning/ipopt_round.hpp"

namespace hysteron::detail {

struct IpoptSettings {
  double tolerance = 1e-9;
  int max_iterations = 300;  ///< below 0 counts as 0
};

[[nodiscard]] Ipopt::SmartPtr<Ipopt::IpoptApplication> quiet_application(const IpoptSettings& settings);

/// After all options are set. No option file is read: the default would read ipopt.opt from the directory of the user.
[[nodiscard]] Ipopt::ApplicationReturnStatus initialize(Ipopt::IpoptApplication& application);

/// Every return code of Ipopt 3.11 and 3.14. Without constraints, what Ipopt says of feasibility and restoration means
/// that the line search found no descent.
[[nodiscard]] Outcome translate(Ipopt::ApplicationReturnStatus code);

}  // namespace hysteron::detail
