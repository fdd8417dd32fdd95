// One effect more: every candidate beside what a set holds already is screened, the best are fitted.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/effects/grid_points.hpp"
#include "diagnosis/model/background.hpp"
#include "diagnosis/search/fitting.hpp"
#include "diagnosis/search/search_options.hpp"

namespace hysteron::diagnosis {

/// What every expansion stands on: the diagram without effects.
struct Footing {
  Explanation calibrated{};   ///< known parameters fitted
  Explanation nominal{};      ///< as they were tuned
  double nominal_cost = 0.0;  ///< of the tuned ones, what a straight line leaves
  /// The first candidates are tried about the parameters as tuned, since a large effect bends a calibration far away;
  /// but where these are so far off that a straight line does not calibrate them, about the calibrated ones.
  bool about_nominal = true;
  /// Where the calibration may be nearer to the machine than the tuned parameters are, pairs are looked for about it:
  /// where a plant integrates, what is off by then hides which two would add up.
  bool is_near = false;
  [[nodiscard]] const Explanation& bare() const { return about_nominal ? nominal : calibrated; }
  [[nodiscard]] KnownStarts known_starts() const;
};

[[nodiscard]] Footing footing_of(const Task& task, Variant base);

using Wanted = std::function<bool(const Applied&)>;
[[nodiscard]] inline bool any_effect(const Applied& /*effect*/) {
  return true;
}

class Expansion {
 public:
  /// `floor_cost` is ½Σr² of noise alone.
  Expansion(const Task& task, const std::string& top, const Footing& footing, double floor_cost,
            const SearchOptions& options)
      : task_(task), top_(top), footing_(footing), floor_cost_(floor_cost), options_(options) {}

  /// To a set every effect more is added that is wanted; the best, so many.
  [[nodiscard]] std::vector<Explanation> of(const Explanation& from, const Wanted& wanted, std::size_t fitted);

  /// As above, but nothing is fitted; those of the bare diagram are the `singles` from here on.
  [[nodiscard]] std::vector<Screened> screen(const Explanation& from, const Wanted& wanted, std::size_t fitted);

  /// Candidates as they were screened, fitted; those in front to the end.
  [[nodiscard]] std::vector<Explanation> fitted_and_finished(const std::vector<Screened>& list,
                                                             const Explanation& from);

  /// To the end those fits that a few steps have brought to the front; one that closes a small part of what the best
  /// closes is ranked well enough.
  void finish_front(std::vector<Explanation>& fits, double cost_before);

  /// Where the residual is little more than noise, an effect has to gain more than chance does. Of a large gap a single
  /// one may close little, and leave residuals so slow that they count for few samples.
  [[nodiscard]] bool is_worth_following(double cost_before, const Fit& best) const;

  /// From here on what is tried may end where it is when time is up. The first round is done whole: each effect gets
  /// its chance.
  void may_stop() { can_stop_ = true; }
  [[nodiscard]] bool must_stop() const { return can_stop_ && options_.is_over(); }

  /// What is done from here on is this part of the whole.
  void progress_within(double begin, double width);

  [[nodiscard]] std::size_t tried() const { return tried_; }                       ///< candidates
  [[nodiscard]] const std::vector<Screened>& singles() const { return singles_; }  ///< by themselves, best first

 private:
  void say(double fraction, std::string_view text);
  /// The whole grid near the starts of those candidates that the thin one has brought to the front.
  void refine(std::vector<Screened>& list, const std::vector<Candidate>& candidates, const std::vector<Grids>& grids,
              const Explanation& from, const Background& background, std::size_t count);
  /// Gaps and quanta once more about the calibrated parameters: their place on the signal counts, and a gain that is
  /// off by a percent shifts a quantum at the far end by more than itself.
  void about_calibration(std::vector<Screened>& list, const std::vector<Candidate>& candidates,
                         const std::vector<Grids>& grids);

  const Task& task_;
  const std::string& top_;
  const Footing& footing_;
  double floor_cost_;
  const SearchOptions& options_;
  bool can_stop_ = false;
  std::size_t tried_ = 0;
  std::vector<Screened> singles_{};
  std::mutex mutex_{};
  double begin_ = 0.0;
  double width_ = 1.0;
};

}  // namespace hysteron::diagnosis
