// Every number by which the evidence and the verdict decide: its value, where it comes from, what it decides.
//
// Such a threshold stands here and nowhere else. `origin` is mathematics, a convention, a false-alarm rate, or what it
// was calibrated on. A rule has a value at which it changes nothing, so that it can be left out: `--without`.
#pragma once

#include <array>
#include <limits>
#include <string_view>

namespace hysteron::diagnosis {

struct Threshold {
  std::string_view name;
  double value;
  std::string_view unit;
  std::string_view origin;
  std::string_view decides;
  double neutral = std::numeric_limits<double>::quiet_NaN();  ///< not a number: a setting, which is always needed

  [[nodiscard]] constexpr bool is_rule() const { return neutral == neutral; }
};

namespace policy {

/// Where a rule that asks for more than its threshold changes nothing, and one that asks for less.
inline constexpr double anything = -std::numeric_limits<double>::infinity();
inline constexpr double nothing = std::numeric_limits<double>::infinity();

inline constexpr Threshold work{"work", 8e9, "block steps", "cost: some 40 s on two cores of 2020",
                                "after how much of it a search adds no further effect, times --effort"};

inline constexpr Threshold unexplained{"unexplained",
                                       0.001,
                                       "1",
                                       "a formula errs by 3 % in size, as in the weights of a judgement",
                                       "what share of the gap's energy has to be left for the evidence to be asked",
                                       anything};
inline constexpr Threshold blocks{"blocks", 15.0, "1", "convention: 10 to 20 folds; 6 to 50 gave the same families",
                                  "into how many stretches the records are cut, one of them held out at a time"};
inline constexpr Threshold rows{"rows", 4000.0, "samples", "cost: the regression is linear in them",
                                "how many means of consecutive samples of an output are compared at most"};
inline constexpr Threshold price{"price",
                                 0.10,
                                 "ln",
                                 "convention: a tenth of what is left",
                                 "what each further effect has to take off the held-out energy",
                                 0.0};
inline constexpr Threshold model_error{
    "model error",
    0.15,
    "ln",
    "calibrated on the development machines",
    "by how much the energies that two sets leave may differ for their formulas' sake, "
    "in all blocks alike",
    0.0};
inline constexpr Threshold own_choice{
    "own choice",
    1.39,
    "ln",
    "convention: twice as good, in size",
    "how much less a set has to leave that the search chose by this very run, among all that it tried, than one that "
    "was found by predicting stretches",
    0.0};
inline constexpr Threshold displaced{"displaced",
                                     1.39,
                                     "ln",
                                     "convention: twice as good, in size",
                                     "how much less a set has to leave for each converter that it puts between two "
                                     "parts of a machine",
                                     0.0};
inline constexpr Threshold reach{"reach", 10.0, "1", "convention: a decade",
                                 "how many times its value a known parameter may move beside a set: what moves it "
                                 "further cancels it, and is no cause"};
inline constexpr Threshold another_place{
    "another place",
    0.7,
    "ln",
    "convention: twice as good",
    "what a set has to gain that needs an effect behind the place where the missing "
    "signal can be seen",
    0.0};
inline constexpr Threshold draws{"draws", 2000.0, "1", "mathematics: 0.01 of standard error",
                                 "the draws of the bootstrap over blocks"};
inline constexpr Threshold unsure_speed{"unsure speed", 2.0, "deviations", "mathematics: 95 % of a normal error",
                                        "within which the sign of a speed, and with it a dry friction, is open"};
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
inline constexpr Threshold kept_promise{"kept promise",
                                        0.5,
                                        "1",
                                        "convention: half of it",
                                        "what part of the promised closure a fit over whole records has to keep",
                                        anything};
inline constexpr Threshold runs{"runs", 6.0, "1", "cost: a fit over whole records each",
                                "how many sets of a view are run: the most probable, until one keeps its promise; "
                                "then one for each other effect that leads a set"};
inline constexpr Threshold relevant{
    "relevant", 0.05, "1", "convention: the twentieth part", "what share of the gap an effect has to close to be named",
    anything};

inline constexpr Threshold fed_back{"fed back",
                                    0.3,
                                    "1",
                                    "calibrated: loops of industry have 0.35 or more where their set point rests, "
                                    "machines with a drive of their own 0.11 or less",
                                    "from which share of an input that follows from the output on a controller sets it",
                                    nothing};

inline constexpr Threshold far_above{"far above the noise",
                                     3.0,
                                     "1",
                                     "convention: three times what may be noise",
                                     "from which size on what is left is a gap, whether or not anything predicts it",
                                     nothing};
inline constexpr Threshold mostly_open{"mostly open",
                                       0.5,
                                       "1",
                                       "convention: more than half",
                                       "from which open share of the gap on a verdict is partial, where what is left "
                                       "can be predicted",
                                       nothing};
inline constexpr Threshold notably_open{"notably open",
                                        0.1,
                                        "1",
                                        "convention: the tenth part",
                                        "from which open share of the gap on a verdict is partial, where twice the "
                                        "noise is left",
                                        nothing};
inline constexpr Threshold twice_noise{"twice the noise",
                                       2.0,
                                       "1",
                                       "convention: twice what may be noise",
                                       "from which size on an open share makes a verdict partial",
                                       anything};
inline constexpr Threshold suspicious{"suspicious", 1.2, "1", "calibrated: slow noise is off by a tenth",
                                      "from which size on what is left is no noise, where the floor is of repeats"};
inline constexpr Threshold hidden_noise{"hidden noise", 1.5, "floors",
                                        "calibrated: what other floors do not see of coloured noise",
                                        "from which size on what is left is no noise, of any other floor"};
inline constexpr Threshold smoothest_noise{"smoothest noise", 10.0, "1", "calibrated: noise of a pole of 0.9",
                                           "how far dwells may lie above differences and be noise"};
inline constexpr Threshold sure_of_one_motion{"sure of one motion",
                                              0.8,
                                              "1",
                                              "convention",
                                              "how sure a verdict on a record of a single motion is at most",
                                              nothing};
inline constexpr Threshold sure_of_missed_start{"sure of a missed start",
                                                0.5,
                                                "1",
                                                "convention: what is named may stand for another state at the start",
                                                "how sure a verdict is at most that misses the begin of a record",
                                                nothing};
inline constexpr Threshold sure_of_far_parameters{"sure of far parameters",
                                                  0.6,
                                                  "1",
                                                  "convention: parameters bend to what the named effect is not",
                                                  "how sure a verdict is at most whose known parameters ran far off",
                                                  nothing};
inline constexpr Threshold sure_of_unknown{"sure of unknown",
                                           0.85,
                                           "1",
                                           "convention: that no name fits now does not say that none will",
                                           "how sure it is at most that no effect of the library is the cause",
                                           nothing};

inline constexpr std::array all{work,
                                unexplained,
                                blocks,
                                rows,
                                price,
                                model_error,
                                own_choice,
                                displaced,
                                reach,
                                another_place,
                                draws,
                                unsure_speed,
                                quiet_slope,
                                follower,
                                same_signal,
                                at_once,
                                line_of_driver,
                                quick,
                                linear,
                                named,
                                rival,
                                kept_promise,
                                relevant,
                                fed_back,
                                far_above,
                                mostly_open,
                                notably_open,
                                twice_noise,
                                suspicious,
                                hidden_noise,
                                smoothest_noise,
                                sure_of_one_motion,
                                sure_of_missed_start,
                                sure_of_far_parameters,
                                sure_of_unknown};

}  // namespace policy
}  // namespace hysteron::diagnosis
