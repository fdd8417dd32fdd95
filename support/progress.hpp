// A progress line for long work: on a terminal only, redrawn at most ten times a second, gone when the work is done.
//
//   Fitting  [##########··········]  50 %  12 s left  iteration 31, RMSE 0.83 um
#pragma once

#include <cstddef>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace hysteron {

/// The line itself: at most `width` characters. `seconds_left` is left out where it is not known.
[[nodiscard]] std::string progress_line(std::string_view title, double fraction, std::optional<double> seconds_left,
                                        std::string_view text, std::size_t width);

class Progress {
 public:
  /// A stream that is no terminal gets nothing. `clock` gives seconds; the default is the steady clock.
  explicit Progress(std::string title, std::FILE* stream = stderr, std::function<double()> clock = {});
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  /// No line of the program is drawn from now on: for who asked for silence.
  static void silence();

  /// Says how far the work is, 0 to 1, and what it is at. Cheap enough for an inner loop.
  void update(double fraction, std::string_view text = {});

  /// Clears the line, so that what is printed next starts on a clean one.
  void finish();

 private:
  std::string title_;
  std::FILE* stream_;  ///< null where nothing is to be drawn
  std::function<double()> clock_;
  double begun_ = 0.0;
  double next_drawing_ = 0.0;
  bool drawn_ = false;
};

}  // namespace hysteron
