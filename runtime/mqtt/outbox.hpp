// Rows that wait for the broker: in order, each until the broker has confirmed it, as far as age and memory allow. The
// oldest go first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "runtime/mqtt/row.hpp"

namespace hysteron::runtime {

class Outbox {
 public:
  /// `bytes` of memory at the most, and no row older than `keep`, in ns. `first`: the number of the row that is added
  /// first.
  Outbox(std::uint64_t bytes, std::int64_t keep, std::uint64_t first = 0) : bytes_(bytes), keep_(keep), first_(first) {}

  /// Behind all others; `now`, in ns, on a clock that is never set. Gives how many old rows had to go for it.
  std::size_t add(MqttRow row, std::int64_t now);
  /// Takes out those that are too old, and says how many.
  std::size_t expire(std::int64_t now);

  /// The oldest row that is not on its way; null where there is none.
  [[nodiscard]] const MqttRow* next() const;
  /// The number of that row; where there is none, of the row that is added next. Numbers grow by one.
  [[nodiscard]] std::uint64_t next_number() const { return first_ + on_the_way_; }
  /// The next row is on its way from now on.
  void send();
  /// The broker has a row. What is gone already is ignored. Gives how many rows are done by it: a row counts when all
  /// before it are confirmed.
  std::size_t confirm(std::uint64_t number);
  /// The same of every row up to a number.
  std::size_t confirm_through(std::uint64_t number);
  /// The connection broke: what is not confirmed is to be sent again.
  void call_back();

  /// The number of the oldest.
  [[nodiscard]] std::uint64_t first() const { return first_; }
  /// Rows from a number on that were added before a time, oldest first.
  [[nodiscard]] std::vector<const MqttRow*> rows_from(std::uint64_t number, std::int64_t before) const;
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::size_t on_the_way() const { return on_the_way_; }
  /// Of memory, in bytes.
  [[nodiscard]] std::uint64_t used() const { return used_; }

 private:
  struct Waiting {
    MqttRow row{};
    std::int64_t since = 0;
    bool is_confirmed = false;
  };

  void drop_oldest();
  std::size_t clear_confirmed();

  std::uint64_t bytes_;
  std::int64_t keep_;
  std::deque<Waiting> rows_{};
  std::uint64_t first_;         ///< the number of the oldest
  std::size_t on_the_way_ = 0;  ///< of the oldest
  std::uint64_t used_ = 0;
};

}  // namespace hysteron::runtime
