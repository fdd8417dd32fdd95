// Every number by which the evidence decides: its value, where it comes from, what it decides.
//
// A threshold of the evidence stands here and nowhere else. `origin` is mathematics, a convention, a false-alarm rate,
// or what it was calibrated on.
#pragma once

#include <array>
#include <string_view>

namespace hysteron::diagnosis {

struct Threshold {
  std::string_view name;
  double value;
  std::string_view unit;
  std::string_view origin;
  std::string_view decides;
};

namespace policy {

inline constexpr Threshold above_noise{"above the noise", 10.0, "1", "mathematics: three times the noise in size",
                                       "what energy of noise has to be left for the evidence to be asked"};
inline constexpr Threshold unexplained{"unexplained", 0.001, "1",
                                       "a formula errs by 3 % in size, as in the weights of a judgement",
                                       "what share of the gap's energy has to be left for the evidence to be asked"};
inline constexpr Threshold blocks{"blocks", 15.0, "1", "convention: 10 to 20 folds; 6 to 50 gave the same families",
                                  "into how many stretches the records are cut, one of them held out at a time"};
inline constexpr Threshold rows{"rows", 4000.0, "samples", "cost: the regression is linear in them",
                                "how many means of consecutive samples of an output are compared at most"};
inline constexpr Threshold price{"price", 0.10, "ln", "convention: a tenth of what is left",
                                 "what each further effect has to take off the held-out energy"};
inline constexpr Threshold model_error{
    "model error", 0.15, "ln", "calibrated on the development machines",
    "by how much the energies that two sets leave may differ for their formulas' sake, "
    "in all blocks alike"};
inline constexpr Threshold another_place{
    "another place", 0.7, "ln", "convention: twice as good",
    "what a set has to gain that needs an effect behind the place where the missing "
    "signal can be seen"};
inline constexpr Threshold draws{"draws", 2000.0, "1", "mathematics: 0.01 of standard error",
                                 "the draws of the bootstrap over blocks"};
inline constexpr Threshold quiet_slope{"quiet slope", 0.1, "1", "convention: noise a tenth of the slope",
                                       "how many samples a slope is taken over"};
inline constexpr Threshold follower{"follower", 0.9, "1", "convention: nine tenths of its energy",
                                    "which columns move with the diagram's signals and are no causes"};
inline constexpr Threshold same_signal{"same signal", 0.98, "1", "mathematics: the rest is a slope of it",
                                       "which signals are one"};
inline constexpr Threshold at_once{"at once", 0.3, "1", "convention",
                                   "on which edges a missing signal acts through states"};
inline constexpr Threshold line_of_driver{"line of a driver", 0.02, "1", "false alarms under periodic excitation",
                                          "which frequencies cannot be a disturbance in time"};
inline constexpr Threshold quick{"quick", 0.05, "1", "convention: it settles within a twentieth of a block",
                                 "which slow memory is a lag by another name"};
inline constexpr Threshold linear{"linear", 0.02, "1", "mathematics: rounding and bends",
                                  "which strengths are a factor"};
inline constexpr Threshold named{"named", 0.5, "1", "convention: more probable than not",
                                 "from which probability a family is named"};
inline constexpr Threshold rival{"rival", 0.02, "1", "convention: one draw in fifty",
                                 "from which probability a set is told as a rival"};
inline constexpr Threshold kept_promise{"kept promise", 0.5, "1", "convention: half of it",
                                        "what part of the promised closure a fit over whole records has to keep"};
inline constexpr Threshold relevant{"relevant", 0.05, "1", "convention: the twentieth part",
                                    "what share of the gap an effect has to close to be named"};

inline constexpr std::array all{above_noise, unexplained,   blocks,         rows,        price,
                                model_error, another_place, draws,          quiet_slope, follower,
                                same_signal, at_once,       line_of_driver, quick,       linear,
                                named,       rival,         kept_promise,   relevant};

}  // namespace policy
}  // namespace hysteron::diagnosis
