// A block by itself, run on the signals that drive it: what it adds to the edge on which it acts.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "codegen/interpreter/machine.hpp"
#include "diagnosis/effects/effects.hpp"
#include "diagnosis/effects/signals.hpp"

namespace hysteron::diagnosis {

/// share_a·a + share_b·b.
[[nodiscard]] RecordSignals combined(const RecordSignals& a, double share_a, const RecordSignals& b, double share_b);

class LoneBlock {
 public:
  /// `unsure` are standard deviations of the first driver, or null. All signals have to outlive it.
  LoneBlock(const EffectKind& kind, const RecordSignals& input, std::vector<const RecordSignals*> drivers,
            const RecordSignals* unsure, double sample_time);

  void set(std::string_view parameter, double value);

  /// What it adds to its input, between what it adds where the first driver is lower and where it is higher, and half
  /// of what these differ by, with its sign.
  struct Added {
    RecordSignals middle{};  ///< empty where it is not finite
    RecordSignals slack{};   ///< empty where the driver is sure
  };
  [[nodiscard]] Added added();

 private:
  /// With the first driver so many deviations up; empty where that is not finite.
  [[nodiscard]] RecordSignals added_at(double deviations);

  const RecordSignals& input_;
  std::vector<const RecordSignals*> drivers_;
  const RecordSignals* unsure_;
  Program program_{};
  std::unique_ptr<Machine<double>> machine_{};
};

}  // namespace hysteron::diagnosis
