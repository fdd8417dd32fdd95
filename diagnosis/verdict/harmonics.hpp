// Harmonics of a periodic disturbance or of a cogging: mains hum, spindles and motors have them, at multiples that the
// line in front tells.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/search/sets.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

/// A set whose periodic disturbance has lines at 2 to 5 times its frequency beside it, or whose cogging at as many
/// parts of its period over the same position, on the same edge, each as an effect of the same name. A line is added
/// while it gains three nats beyond its penalty on `samples` samples; nothing where none does. The search itself takes
/// no effect twice, as with two lines at any frequencies it would fit what is no disturbance.
[[nodiscard]] std::optional<Explanation> with_harmonics(const Task& task, const std::string& top,
                                                        const Explanation& one, double samples);

/// The chosen set with its harmonics, and then with simpler formulas where these explain it as well; nothing where it
/// has no harmonics.
[[nodiscard]] std::optional<Explanation> with_all_lines(const Task& task, const std::string& top,
                                                        const CandidateOptions& options, const Searched& searched);

}  // namespace hysteron::diagnosis
