// A converter whose steps are of unequal widths, its differential nonlinearity: beside a quantizer with equal steps a
// record then keeps whole steps where the signal lies near a threshold, which no other effect explains.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/search/fitting.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

struct MovedSteps {
  std::vector<double> values{};  ///< the signal in steps whose thresholds stand where the record has them
  double deviation = 0.0;        ///< RMS of the thresholds about the middle between two steps, in steps
};

/// `smooth` is what a quantizer of so large steps is given, `measured` what came of it and of noise, much less than a
/// step. The threshold between two steps lies where it parts most samples. Nothing where the measured values lie on no
/// steps, or elsewhere than about the signal, or where thresholds that are crossed several times fit little better than
/// those of even steps do: then each crossing is off by something else.
[[nodiscard]] std::optional<MovedSteps> moved_steps(std::span<const double> smooth, std::span<const double> measured,
                                                    double quantum);

/// What a quantizer before an output leaves if its steps are uneven: its thresholds moved. Nothing where the
/// explanation has no quantizer, or its steps are even as far as the record tells.
[[nodiscard]] std::optional<Unrepeatable> uneven_steps(const Task& task, const Explanation& chosen);

/// Those of the chosen set. Of what they explain an effect beside the quantizer may have had its part: a smaller set
/// that with its steps leaves nearly as little is then the chosen one, and sets that hold it are no rivals.
[[nodiscard]] std::optional<Unrepeatable> with_uneven_steps(const Task& task, const Search& search, double floor_cost,
                                                            Judgement& judgement);

}  // namespace hysteron::diagnosis
