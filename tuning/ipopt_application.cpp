#include "tuning/ipopt_application.hpp"

#include <algorithm>

namespace hysteron::detail {
namespace {

/// Maximum_WallTime_Exceeded of Ipopt 3.14. In 3.11 the enumeration lacks it, so that the switch below is over numbers.
constexpr int wall_time_exceeded = -5;

}  // namespace

Ipopt::SmartPtr<Ipopt::IpoptApplication> quiet_application(const IpoptSettings& settings) {
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  const auto options = application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetNumericValue("tol", settings.tolerance);
  options->SetNumericValue("acceptable_tol", 1e3 * settings.tolerance);
  options->SetIntegerValue("acceptable_iter", 10);
  options->SetIntegerValue("max_iter", std::max(settings.max_iterations, 0));
  options->SetStringValue("nlp_scaling_method", "none");
  options->SetStringValue("linear_solver", "mumps");
  options->SetNumericValue("bound_relax_factor", 0.0);
  return application;
}

Ipopt::ApplicationReturnStatus initialize(Ipopt::IpoptApplication& application) {
  return application.Initialize("");  // an empty name: no option file
}

Outcome translate(Ipopt::ApplicationReturnStatus code) {
  switch (static_cast<int>(code)) {
    case Ipopt::Solve_Succeeded:
      return {FitStatus::Converged, "Solve_Succeeded"};
    case Ipopt::Solved_To_Acceptable_Level:
      return {FitStatus::NearlyConverged, "Solved_To_Acceptable_Level"};
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return {FitStatus::Stalled, "Search_Direction_Becomes_Too_Small"};
    case Ipopt::Restoration_Failed:
      return {FitStatus::Stalled, "Restoration_Failed"};
    case Ipopt::Infeasible_Problem_Detected:
      return {FitStatus::Stalled, "Infeasible_Problem_Detected"};
    case Ipopt::Feasible_Point_Found:
      return {FitStatus::Stalled, "Feasible_Point_Found"};
    case Ipopt::Error_In_Step_Computation:
      return {FitStatus::Stalled, "Error_In_Step_Computation"};
    case Ipopt::Diverging_Iterates:
      return {FitStatus::Diverging, "Diverging_Iterates"};
    case Ipopt::User_Requested_Stop:
      return {FitStatus::Cancelled, "User_Requested_Stop"};
    case Ipopt::Maximum_Iterations_Exceeded:
      return {FitStatus::IterationLimit, "Maximum_Iterations_Exceeded"};
    case Ipopt::Maximum_CpuTime_Exceeded:
      return {FitStatus::IterationLimit, "Maximum_CpuTime_Exceeded"};
    case wall_time_exceeded:
      return {FitStatus::IterationLimit, "Maximum_WallTime_Exceeded"};
    case Ipopt::Invalid_Number_Detected:
      return {FitStatus::ModelFailed, "Invalid_Number_Detected"};
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return {FitStatus::SolverFailed, "Not_Enough_Degrees_Of_Freedom"};
    case Ipopt::Invalid_Problem_Definition:
      return {FitStatus::SolverFailed, "Invalid_Problem_Definition"};
    case Ipopt::Invalid_Option:
      return {FitStatus::SolverFailed, "Invalid_Option"};
    case Ipopt::Unrecoverable_Exception:
      return {FitStatus::SolverFailed, "Unrecoverable_Exception"};
    case Ipopt::NonIpopt_Exception_Thrown:
      return {FitStatus::SolverFailed, "NonIpopt_Exception_Thrown"};
    case Ipopt::Insufficient_Memory:
      return {FitStatus::SolverFailed, "Insufficient_Memory"};
    case Ipopt::Internal_Error:
      return {FitStatus::SolverFailed, "Internal_Error"};
    default:
      return {FitStatus::SolverFailed, "a return code that this version does not know"};
  }
}

}  // namespace hysteron::detail
