// Chosen points of a task, published to an MQTT broker by a thread of its own. The cyclic thread lays rows into a tap
// and goes on, whatever becomes of the broker, and nothing that a broker says reaches the task.
//
// A row waits until the broker has confirmed it, in order, within bounds of age and memory; what goes beyond them is
// counted as lost. Where a file is named, what waits for longer than a second is on the disk, and outlives the process.
// After a break, all that was not confirmed is sent again: a row arrives once at the least. A broker that cannot be
// reached is tried again after 1 s at first, and after a minute at last.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/mqtt/client.hpp"
#include "runtime/mqtt/dialect.hpp"
#include "runtime/mqtt/outbox.hpp"
#include "runtime/mqtt/outbox_file.hpp"
#include "runtime/mqtt/row_maker.hpp"
#include "runtime/task/remarks.hpp"
#include "runtime/task/sample_tap.hpp"
#include "runtime/task/task_time.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime {

struct MqttSettings {
  MqttLink link{};
  RowPlan rows{};
  std::int64_t period = 0;       ///< of a cycle, in ns
  std::uint64_t bytes = 0;       ///< of memory for rows that wait
  std::int64_t keep = 0;         ///< ns
  std::filesystem::path file{};  ///< of the rows that wait; empty: they are in memory alone
  std::string owner{};           ///< of that file: the task, and where its rows go
};

/// What the thread does, a turn after the other; it may be called from one thread at a time.
class MqttSender {
 public:
  MqttSender(MqttSettings settings, std::unique_ptr<MqttDialect> dialect, SampleTap& tap, KeptCounter& counter,
             BesideClocks clocks);

  /// Takes rows from the tap and sends them. Waits for the network up to `wait`, and no longer than until `wake` can be
  /// read.
  void turn(std::chrono::milliseconds wait, int wake = -1);
  /// After the task has ended: sends the rest for as long as `longest`, says farewell, and counts what is left as lost.
  void finish(std::chrono::milliseconds longest);
  [[nodiscard]] Remarks& remarks() { return remarks_; }

 private:
  void take();
  void open_file();
  void leave_file_that_is_gone();
  /// `before`: rows that were added until then.
  void keep(std::int64_t before);
  void file_failed(const std::string& problem, const std::string& mend);
  void file_failed(const database::DatabaseError& problem);
  void set_fault(MqttFault fault);
  void lose(std::uint64_t rows);
  void serve(std::chrono::milliseconds wait, int wake);
  void greet();
  void answer();
  void publish_birth();
  void send();
  void confirm();
  void failed(const MqttError& problem);
  [[nodiscard]] std::string broker() const;

  MqttSettings settings_;
  std::unique_ptr<MqttDialect> dialect_;
  SampleTap* tap_;
  KeptCounter* counter_;
  TaskTime time_;
  RowMaker maker_;
  Outbox outbox_;
  std::unique_ptr<OutboxFile> file_{};
  std::int64_t keep_at_ = 0;   ///< when the file is followed, or opened, again
  bool is_file_told_ = false;  ///< that rows are in memory alone
  MqttFault link_fault_ = MqttFault::None;
  std::vector<Sample> taken_{};
  std::optional<Sample> newest_{};

  std::unique_ptr<MqttClient> client_{};
  bool is_greeted_ = false;
  std::int64_t greeted_at_ = 0;
  std::uint64_t first_live_ = 0;                    ///< rows before this number are from before the connection
  std::map<int, std::uint64_t> rows_on_the_way_{};  ///< the row, by the number of its message
  std::map<int, std::uint64_t> fences_{};           ///< the last row before it
  std::int64_t progress_ = 0;                       ///< when the broker confirmed something, or nothing was to be
  bool is_birth_asked_ = false;
  std::int64_t birth_at_ = 0;

  std::int64_t retry_at_ = 0;
  std::int64_t pause_ = 0;
  bool is_losing_ = false;
  Remarks remarks_{};
};

class Mqtt {
 public:
  Mqtt(MqttSettings settings, std::unique_ptr<MqttDialect> dialect, SampleTap& tap, KeptCounter& counter,
       BesideClocks clocks);
  Mqtt(const Mqtt&) = delete;
  Mqtt& operator=(const Mqtt&) = delete;
  Mqtt(Mqtt&&) = delete;
  Mqtt& operator=(Mqtt&&) = delete;
  ~Mqtt();

  /// After the task has ended: sends the rest, for 2 s at the most, and ends the thread.
  void finish();
  [[nodiscard]] MqttSender& sender() { return sender_; }

 private:
  void run();

  std::chrono::milliseconds interval_;
  MqttSender sender_;
  Descriptor over_;
  std::thread thread_;
};

}  // namespace hysteron::runtime
