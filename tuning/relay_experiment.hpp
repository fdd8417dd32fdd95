// What a relay experiment tells of a process (K. J. Åström, T. Hägglund, Automatica 20 (1984) 645).
//
// A relay in place of the controller makes the loop oscillate by itself, near the frequency at which a proportional
// controller would make it unstable. Over whole cycles of the oscillation
//
//   G(jω) = Y₁/U₁, ω = 2π/P            by the first Fourier coefficients of both signals
//   Ku = 1/|G|, Tu = P                 where the phase is −180°: a relay without hysteresis
//   G(0) = mean(y − y₀)/mean(u − u₀)   where the record begins at rest and the relay is asymmetric about it
//
// No describing function is needed. With G(0) = K follows the first-order model with a dead time, K·e^(−Ls)/(1 + T·s),
// that passes through both:
//
//   T = √((K/|G|)² − 1)/ω,   L = (−arg G − atan(ωT))/ω
#pragma once

#include <optional>
#include <span>
#include <string>

#include "records/record.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

struct FirstOrderModel {
  double gain = 0.0;       ///< K, of y over u
  double time = 0.0;       ///< T, s
  double dead_time = 0.0;  ///< L, s
};

/// KP·(e + ∫e dt/TR − TD·dy/dt), as HY_PID has it.
struct ControllerStart {
  double gain = 0.0;        ///< KP
  double reset_time = 0.0;  ///< TR, s
  double rate_time = 0.0;   ///< TD, s
};

struct RelayExperiment {
  std::string u_unit{};  ///< as the record states them; empty where it does not
  std::string y_unit{};
  double low = 0.0;  ///< the two levels of u
  double high = 0.0;
  int cycles = 0;           ///< that were used, whole ones
  double period = 0.0;      ///< s, their mean
  double spread = 0.0;      ///< of the periods, their standard deviation over the mean
  double amplitude = 0.0;   ///< of y, half of its swing
  double hysteresis = 0.0;  ///< of the relay: half the distance of the values of y at which it switched
  double duty = 0.0;        ///< share of the time at the high level
  double gain = 0.0;        ///< |G(jω)|
  double phase = 0.0;       ///< arg G(jω), degrees, −360 to 0; with the sign of the process taken out
  double direction = 1.0;   ///< −1 where y falls with u
  double ultimate_gain = 0.0;
  double ultimate_period = 0.0;            ///< s
  std::optional<FirstOrderModel> model{};  ///< none where the record does not tell G(0), or no such model passes there
  std::string why_no_model{};

  /// Of the ultimate gain, and of KP: u over y; of the process the other way round. Empty where one is not known.
  [[nodiscard]] std::string controller_unit() const;
  [[nodiscard]] std::string process_unit() const;

  /// By the rules of B. D. Tyreus, W. L. Luyben (Ind. Eng. Chem. Res. 31 (1992) 2625), which damp well.
  [[nodiscard]] ControllerStart pi() const;
  [[nodiscard]] ControllerStart pid() const;
};

/// Takes the record apart. `file` stands in the places of errors.
/// @throws InputError HY535 where u does not jump between two levels, where there are fewer than three whole cycles, or
/// where they differ by more than a tenth.
[[nodiscard]] RelayExperiment relay_experiment(std::span<const double> u, std::span<const double> y, double sample_time,
                                               const std::string& file);

/// The same of two columns of a record, by their names. Throws besides HY502 where it has none of that name, and HY730
/// where both are one.
[[nodiscard]] RelayExperiment relay_experiment(const records::Record& record, const std::string& u,
                                               const std::string& y);

}  // namespace hysteron
