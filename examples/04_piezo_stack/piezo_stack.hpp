// Example 4: a real piezo stack, identified from a measured sine, and its feedforward held against a published one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "records/record.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::examples {

/// A file of the measured records, see README.md; nothing where they are not at hand.
[[nodiscard]] std::optional<records::Record> stack_record(std::string_view file);

/// A diagram of this folder after its fit.
struct TunedDiagram {
  Program program{};  ///< with the fitted parameters set
  OutputErrorProblem problem{};
  OutputErrorFit fit{};

  /// RMSE of the only output as a share of its range over the samples of the part.
  [[nodiscard]] double train_share() const;
  [[nodiscard]] double test_share() const;
  [[nodiscard]] double parameter(std::string_view path) const;
};

/// Fits NAME.st by SETTINGS.toml to a record.
[[nodiscard]] TunedDiagram tune(std::string_view name, std::string_view settings, const records::Record& record);

/// A feedforward diagram of this folder, with the parameters of the same paths taken from a tuned plant. REF = 0 stands
/// for the middle of the plant's loop.
[[nodiscard]] Program feedforward_of(std::string_view name, const TunedDiagram& plant);

/// Root of the mean square of y(k + 1) - mean - ref(k) over 1000 samples, as the stack's authors judge their inverse.
/// The row counts from 1.
[[nodiscard]] double tracking_error(const std::vector<double>& ref, const std::vector<double>& y, std::size_t row);
[[nodiscard]] std::vector<double> tracking_errors(const std::vector<double>& ref, const std::vector<double>& y,
                                                  std::size_t row);

inline constexpr std::size_t row_without_inverse = 5052;
inline constexpr std::size_t row_with_inverse = 11152;
inline constexpr std::size_t window = 1000;
/// The first row, from 1, in which the authors' inverse gives the voltage.
inline constexpr std::size_t first_row_of_inverse = 7433;

/// Generates C++ into a folder, compiles it there and runs it over a record: its output. Throws std::runtime_error
/// where there is no compiler or it fails.
[[nodiscard]] std::vector<double> run_generated(const Program& program, const records::Record& record,
                                                const std::filesystem::path& folder);

/// A second model, fitted to the record's own voltage, says what the stack would do under another voltage.
struct Prediction {
  std::vector<double> u{};
  std::vector<double> y{};
  double without_inverse = 0.0;  ///< tracking error in the window of the published figure, um
  double with_inverse = 0.0;
};

[[nodiscard]] Prediction predict(const Program& judge, const std::vector<double>& u, const records::Record& record);

/// Root of the mean square of the difference of two signals from a row, from 1, to the end, each less its mean there.
[[nodiscard]] double difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t row);

}  // namespace hysteron::examples
