// What a run publishes, from the refusals before it to the farewell.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/mqtt/mqtt.hpp"
#include "runtime/task/sample_tap.hpp"
#include "runtime/task/task.hpp"

namespace hysteron::runtime {

class RunningMqtt {
 public:
  /// Reaches no broker. Throws InputError where a file that [mqtt] names cannot be used: HY831 to HY834 of certificates
  /// and keys; of the password, HY100 where it cannot be read, HY804 where it is no line, HY833 where others may read
  /// it. A broker that cannot be reached refuses no start: control goes on without it.
  RunningMqtt(const RunConfig& config, const ProgramShape& shape, Task& task);

  [[nodiscard]] SampleTap& tap() { return *tap_; }
  [[nodiscard]] const KeptCounter& counter() const { return counter_; }

  /// Begins to connect and to publish.
  void start();
  [[nodiscard]] Remarks& remarks() { return mqtt_->sender().remarks(); }
  /// After the task has ended; takes 2.5 s at the most, whatever the broker does.
  void finish() { mqtt_->finish(); }

 private:
  MqttSettings settings_{};
  std::unique_ptr<MqttDialect> dialect_;
  PointDoor* door_;
  KeptCounter counter_{};
  std::optional<SampleTap> tap_{};
  std::unique_ptr<Mqtt> mqtt_;
};

}  // namespace hysteron::runtime
