// Rows of a tap become rows that are published: the quality of each value, and where only changes are wanted, those
// alone.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/mqtt/row.hpp"
#include "runtime/task/sample_tap.hpp"

namespace hysteron::runtime {

struct RowPlan {
  std::vector<MqttPoint> points{};             ///< the first columns of a sample, in this order
  std::size_t fault_column = 0;                ///< the column of task.fault
  std::optional<std::size_t> forced_column{};  ///< the column of task.forced; nothing where no input can be
  bool on_change = false;
  std::uint64_t refresh = 1;  ///< on change: periods after which a point is published without one
};

class RowMaker {
 public:
  explicit RowMaker(RowPlan plan);

  /// Every point.
  [[nodiscard]] MqttRow whole(const Sample& sample, std::int64_t utc_ms) const;
  /// Every point, or those that changed; nothing where none did. A point has changed where it left its dead band round
  /// the value that was last in a row, became a number or ceased to be one, or is of another quality.
  [[nodiscard]] std::optional<MqttRow> row(const Sample& sample, std::int64_t utc_ms);
  /// The next row is whole: what was in the last ones may have reached nobody.
  void forget();

 private:
  struct Last {
    bool is_known = false;
    double value = 0.0;
    ValueQuality quality = ValueQuality::Good;
    std::uint64_t elapsed = 0;
  };

  [[nodiscard]] ValueQuality quality_of(const MqttPoint& point, const Sample& sample, double value) const;
  [[nodiscard]] bool is_due(const MqttPoint& point, const Last& last, const MqttValue& now,
                            std::uint64_t elapsed) const;

  RowPlan plan_;
  std::vector<Last> last_;
};

}  // namespace hysteron::runtime
