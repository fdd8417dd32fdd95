#include "runtime/mqtt/outbox.hpp"

#include <algorithm>
#include <utility>

namespace hysteron::runtime {
namespace {

/// With what the allocator adds.
std::uint64_t memory_of(const MqttRow& row) {
  return 128 + row.values.capacity() * sizeof(MqttValue);
}

}  // namespace

void Outbox::drop_oldest() {
  used_ -= memory_of(rows_.front().row);
  rows_.pop_front();
  ++first_;
  on_the_way_ -= on_the_way_ > 0 ? 1 : 0;
}

std::size_t Outbox::add(MqttRow row, std::int64_t now) {
  const std::uint64_t size = memory_of(row);
  std::size_t dropped = 0;
  while (!rows_.empty() && used_ + size > bytes_) {
    drop_oldest();
    ++dropped;
  }
  used_ += size;
  rows_.push_back({.row = std::move(row), .since = now});
  return dropped;
}

std::size_t Outbox::expire(std::int64_t now) {
  std::size_t dropped = 0;
  while (!rows_.empty() && now - rows_.front().since > keep_) {
    drop_oldest();
    ++dropped;
  }
  return dropped;
}

const MqttRow* Outbox::next() const {
  return on_the_way_ < rows_.size() ? &rows_[on_the_way_].row : nullptr;
}

std::vector<const MqttRow*> Outbox::rows_from(std::uint64_t number, std::int64_t before) const {
  std::vector<const MqttRow*> rows;
  for (std::size_t i = number > first_ ? number - first_ : 0; i < rows_.size() && rows_[i].since <= before; ++i) {
    rows.push_back(&rows_[i].row);
  }
  return rows;
}

void Outbox::send() {
  ++on_the_way_;
}

std::size_t Outbox::clear_confirmed() {
  std::size_t done = 0;
  while (on_the_way_ > 0 && rows_.front().is_confirmed) {
    drop_oldest();
    ++done;
  }
  return done;
}

std::size_t Outbox::confirm(std::uint64_t number) {
  if (number >= first_ && number < first_ + on_the_way_) {
    rows_[number - first_].is_confirmed = true;
  }
  return clear_confirmed();
}

std::size_t Outbox::confirm_through(std::uint64_t number) {
  for (std::uint64_t i = first_; i <= number && i < first_ + on_the_way_; ++i) {
    rows_[i - first_].is_confirmed = true;
  }
  return clear_confirmed();
}

void Outbox::call_back() {
  on_the_way_ = 0;
  for (Waiting& one : rows_) {
    one.is_confirmed = false;
  }
}

}  // namespace hysteron::runtime
