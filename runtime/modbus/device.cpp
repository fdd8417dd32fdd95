#include "runtime/modbus/device.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

#include "runtime/modbus/point_format.hpp"
#include "runtime/task/exchange.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Clock = std::chrono::steady_clock;

/// Values that lie side by side and go in one request.
struct Block {
  Area area = Area::holding_register;
  bool written = false;
  std::uint32_t address = 0;
  std::uint32_t count = 0;
  std::vector<std::size_t> values{};
};

std::uint32_t most_of(const Block& block) {
  return holds_bits(block.area) ? (block.written ? 1968U : 2000U) : (block.written ? 123U : 125U);
}

void check(const RemoteValue& value) {
  if (value.at.is_boolean() != (value.format.type == PointType::boolean) ||
      (holds_bits(value.at.area) && value.at.is_bit())) {
    throw std::invalid_argument("booleans lie among bits, other values among registers");
  }
  if (value.written && value.at.area != Area::coil && value.at.area != Area::holding_register) {
    throw std::invalid_argument("inputs of a device are not written");
  }
  if (value.at.address + registers_of(value.format.type) > 0x10000) {
    throw std::invalid_argument("a value lies behind the last address");
  }
}

std::vector<Block> blocks_of(const std::vector<RemoteValue>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(
      order, {}, [&](std::size_t i) { return std::tuple(values[i].written, values[i].at.area, values[i].at.address); });
  std::vector<Block> blocks;
  for (const std::size_t i : order) {
    const RemoteValue& value = values[i];
    check(value);
    const auto width = static_cast<std::uint32_t>(registers_of(value.format.type));
    const std::uint32_t end = value.at.address + width;
    const bool joins = !blocks.empty() && blocks.back().area == value.at.area &&
                       blocks.back().written == value.written &&
                       blocks.back().address + blocks.back().count >= value.at.address &&
                       end - blocks.back().address <= most_of(blocks.back());
    // What is read may share registers: bits of one, or one value in two formats. Of what is written, bits alone.
    const bool shares = joins && blocks.back().address + blocks.back().count > value.at.address;
    const bool fits = joins && (!shares || !value.written || value.at.is_bit());
    if (!fits) {
      blocks.push_back({.area = value.at.area, .written = value.written, .address = value.at.address});
    }
    blocks.back().count = std::max(blocks.back().count, end - blocks.back().address);
    blocks.back().values.push_back(i);
  }
  return blocks;
}

void put_word(std::vector<std::uint8_t>& bytes, std::uint32_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFFU));
}

}  // namespace

class Device::Worker {
 public:
  Worker(const DeviceOptions& options, DeviceWork work)
      : options_(options),
        work_(std::move(work)),
        blocks_(blocks_of(options.values)),
        order_(blocks_.size()),
        failed_(blocks_.size()),
        cells_(options.values.size()),
        link_(work_.link ? work_.link : std::make_shared<ClientLink>(options.link, options.response)) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    if (work_.own_thread) {
      thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    }
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  Worker(Worker&&) = delete;
  Worker& operator=(Worker&&) = delete;
  ~Worker() {
    thread_.request_stop();
    if (std::ranges::none_of(blocks_, &Block::written) && work_.link == nullptr) {
      link_->interrupt();
    }
  }

  [[nodiscard]] RemoteReading read(std::size_t value) const {
    std::uint64_t number = 0;
    std::array<double, 3> told{};
    if (!cells_[value].told.read(number, told)) {
      return {.age = Clock::now() - begin_};
    }
    RemoteReading reading{.value = told[0], .quality = static_cast<Quality>(told[1])};
    reading.age = Clock::now() - begin_ - std::chrono::nanoseconds(static_cast<std::int64_t>(told[2]));
    if (reading.quality == Quality::good && reading.age > longest_age(value)) {
      reading.quality = Quality::old;
    }
    return reading;
  }

  void write(std::size_t value, double number) {
    Cell& cell = cells_[value];
    cell.to_write.store(number, std::memory_order_relaxed);
    cell.is_given.store(true, std::memory_order_release);
  }

  [[nodiscard]] std::chrono::nanoseconds longest_age(std::size_t value) const {
    const auto longest = options_.values[value].longest_age;
    return longest.count() > 0 ? longest : std::max<std::chrono::nanoseconds>(10 * options_.period, options_.response);
  }

  [[nodiscard]] DeviceStatus status() const noexcept {
    const auto count_of = [&](Exchange outcome) {
      return counts_[static_cast<std::size_t>(outcome)].load(std::memory_order_relaxed);
    };
    return {.state = state_.load(std::memory_order_relaxed),
            .connections = connections_.load(std::memory_order_relaxed),
            .answers = count_of(Exchange::answered),
            .exceptions = count_of(Exchange::exception),
            .no_link = count_of(Exchange::no_link),
            .timeouts = count_of(Exchange::timeout),
            .closed = count_of(Exchange::closed),
            .wrong_answers = count_of(Exchange::wrong_answer),
            .bad_checksums = count_of(Exchange::bad_checksum)};
  }

  [[nodiscard]] std::uint64_t not_taken() const noexcept { return not_taken_.load(std::memory_order_relaxed); }

  [[nodiscard]] bool has_taken(std::size_t value, double number) const {
    const RemoteReading now = read(value);
    const bool was_answered = now.quality != Quality::never && now.quality != Quality::refused;
    return was_answered && now.value == number && now.age <= longest_age(value);
  }

  bool round() {
    if ((!link_->is_open() && !connect()) || !serve_all({})) {
      lose();
      return false;
    }
    return true;
  }

 private:
  /// Of the worker, but for what is atomic and the ring, by which the others are told: value, quality, time.
  struct Cell {
    double value = 0.0;
    Quality quality = Quality::never;
    std::chrono::nanoseconds good_at{0};  ///< since the start
    double sent = 0.0;
    std::atomic<double> to_write{0.0};
    std::atomic<bool> is_given{false};
    SnapshotRing told{3};
  };

  enum class Attempt : std::uint8_t { failed_last, failed_writes_first, failed_reads_first };

  static void tell(Cell& cell) {
    const std::array<double, 3> row{cell.value, static_cast<double>(cell.quality),
                                    static_cast<double>(cell.good_at.count())};
    cell.told.publish(0, row);
  }

  static bool is_sound(Exchange outcome) { return outcome == Exchange::answered || outcome == Exchange::exception; }

  void run(const std::stop_token& stop) {
    auto wait = options_.first_wait;
    while (!stop.stop_requested()) {
      const auto begin = Clock::now();
      if (!link_->is_open() && !connect()) {
        wait = pause(stop, wait);
        continue;
      }
      const auto before = answers_;
      const bool is_sound = serve_all(stop);
      wait = answers_ == before ? wait : options_.first_wait;
      if (is_sound) {
        sleep_until(stop, begin + options_.period);
      } else {
        wait = pause(stop, wait);
      }
    }
    // What the task wrote last, its safe values, still has to arrive.
    attempt_ = Attempt::failed_last;
    put_in_order();
    for (const std::size_t i : order_) {
      if (blocks_[i].written && link_->is_open()) {
        (void)serve(blocks_[i]);
      }
    }
  }

  /// Every block once, up to one that fails, which ends the link; false then.
  bool serve_all(const std::stop_token& stop) {
    put_in_order();
    for (const std::size_t i : order_) {
      if (!is_sound(serve(blocks_[i]))) {
        failed_[i] = ++failures_;
        recovers_ = true;
        attempt_ = static_cast<Attempt>((static_cast<int>(attempt_) + 1) % 3);
        return false;
      }
      failed_[i] = 0;
      if (stop.stop_requested()) {
        return true;
      }
    }
    recovers_ = false;
    return true;
  }

  /// What is read first, while all is well: the diagram is to have what is new. On a new link what is written first,
  /// for then it may be a safe value that waits. Blocks that failed when they were last tried come after all others,
  /// since each takes the link with it, but for two attempts of three: what fails may fail by what went before it on
  /// the link, so that one begins with the writes that failed and one with the reads, the longest ago first. So
  /// whatever fails for ever keeps no other block from its turn.
  void put_in_order() {
    std::ranges::sort(order_, {}, [&](std::size_t i) {
      const bool is_suspect = failed_[i] != 0;
      const bool goes_first =
          is_suspect && attempt_ == (blocks_[i].written ? Attempt::failed_writes_first : Attempt::failed_reads_first);
      return std::tuple(goes_first ? 0 : is_suspect ? 2 : 1, blocks_[i].written != recovers_, failed_[i], i);
    });
  }

  bool connect() {
    state_.store(LinkState::connecting, std::memory_order_relaxed);
    if (!link_->open()) {
      count(Exchange::no_link);
      return false;
    }
    state_.store(LinkState::running, std::memory_order_relaxed);
    connections_.fetch_add(1, std::memory_order_relaxed);
    recovers_ = true;
    return true;
  }

  void lose() {
    state_.store(LinkState::waiting, std::memory_order_relaxed);
    for (Cell& cell : cells_) {
      cell.quality = cell.quality == Quality::never ? Quality::never : Quality::lost;
      tell(cell);
    }
  }

  /// Marks all values lost and waits; the next wait.
  std::chrono::milliseconds pause(const std::stop_token& stop, std::chrono::milliseconds wait) {
    lose();
    sleep_until(stop, Clock::now() + wait);
    return std::min(2 * wait, options_.longest_wait);
  }

  void sleep_until(const std::stop_token& stop, Clock::time_point until) {
    std::unique_lock lock(mutex_);
    woken_.wait_until(lock, stop, until, [] { return false; });
  }

  void count(Exchange outcome) {
    counts_.at(static_cast<std::size_t>(outcome)).fetch_add(1, std::memory_order_relaxed);
  }

  Exchange serve(const Block& block) {
    const auto request = block.written ? write_request(block) : read_request(block);
    if (request.empty() || (block.written && work_.may_write && !work_.may_write())) {
      return Exchange::answered;  // not all of its values have been given yet, or another writes now
    }
    std::vector<std::uint8_t> answer;
    const Exchange outcome = link_->exchange(options_.unit, request, answer);
    count(outcome);
    answers_ += is_sound(outcome) ? 1 : 0;
    for (const std::size_t i : block.values) {
      Cell& cell = cells_[i];
      if (outcome == Exchange::exception) {
        cell.quality = cell.quality == Quality::never ? Quality::never : Quality::refused;
      } else if (outcome == Exchange::answered) {
        const auto value = block.written ? std::optional(cell.sent) : taken_from(answer, block, options_.values[i]);
        cell.quality = value ? Quality::good : Quality::refused;
        not_taken_.fetch_add(value ? 0 : 1, std::memory_order_relaxed);
        cell.value = value.value_or(cell.value);
        cell.good_at = value ? Clock::now() - begin_ : cell.good_at;
      }
      tell(cell);
    }
    return outcome;
  }

  static std::vector<std::uint8_t> read_request(const Block& block) {
    constexpr std::array<std::uint8_t, 4> functions{1, 2, 3, 4};
    std::vector<std::uint8_t> request{functions.at(static_cast<std::size_t>(block.area))};
    put_word(request, block.address);
    put_word(request, block.count);
    return request;
  }

  std::vector<std::uint8_t> write_request(const Block& block) {
    const bool bits = holds_bits(block.area);
    std::vector<std::uint8_t> request{static_cast<std::uint8_t>(bits ? 15 : 16)};
    put_word(request, block.address);
    put_word(request, block.count);
    const std::uint32_t bytes = bits ? (block.count + 7) / 8 : 2 * block.count;
    request.push_back(static_cast<std::uint8_t>(bytes));
    request.resize(6 + bytes);
    for (const std::size_t i : block.values) {
      const RemoteValue& value = options_.values[i];
      if (!cells_[i].is_given.load(std::memory_order_acquire)) {
        return {};
      }
      cells_[i].sent = cells_[i].to_write.load(std::memory_order_relaxed);
      const auto code = encoded(cells_[i].sent, value.format);
      if (!code) {
        return {};  // what is not a number has no bits there: the device keeps what it was given last
      }
      const std::uint64_t pattern = code->bits << value.at.shift();
      const std::uint32_t offset = value.at.address - block.address;
      if (bits) {
        request[6 + offset / 8] |= static_cast<std::uint8_t>(pattern << offset % 8);
        continue;
      }
      std::array<std::uint16_t, 4> words{};
      const auto used = std::span(words).first(registers_of(value.format.type));
      to_registers(pattern, value.format.order, used);
      for (std::size_t word = 0; word < used.size(); ++word) {
        request[6 + 2 * (offset + word)] |= static_cast<std::uint8_t>(used[word] >> 8U);
        request[7 + 2 * (offset + word)] |= static_cast<std::uint8_t>(used[word] & 0xFFU);
      }
    }
    return request;
  }

  /// Nothing where it is none that may be taken.
  [[nodiscard]] static std::optional<double> taken_from(const std::vector<std::uint8_t>& answer, const Block& block,
                                                        const RemoteValue& value) {
    const std::uint32_t offset = value.at.address - block.address;
    std::uint64_t bits = 0;
    if (holds_bits(block.area)) {
      bits = answer[2 + offset / 8] >> offset % 8 & 1U;
    } else {
      std::array<std::uint16_t, 4> words{};
      const auto used = std::span(words).first(registers_of(value.format.type));
      for (std::size_t word = 0; word < used.size(); ++word) {
        const std::size_t at = 2 + 2 * (offset + word);
        used[word] = static_cast<std::uint16_t>(answer[at] << 8U | answer[at + 1]);
      }
      bits = from_registers(used, value.format.order);
      bits = value.at.is_bit() ? bits >> value.at.shift() & 1U : bits;
    }
    const auto number = taken(bits, value.format, value.low, value.high);
    return number && holds(RegisterType(value.of), *number) ? number : std::nullopt;
  }

  const DeviceOptions options_;
  const DeviceWork work_;
  const Clock::time_point begin_ = Clock::now();
  const std::vector<Block> blocks_;
  std::vector<std::size_t> order_;     ///< in which the blocks are served
  std::vector<std::uint64_t> failed_;  ///< by block: the number of the failure that it ended with; 0: it was well
  std::uint64_t failures_ = 0;         ///< of all blocks
  std::uint64_t answers_ = 0;          ///< exceptions among them
  bool recovers_ = true;               ///< no round of this link went well yet
  Attempt attempt_ = Attempt::failed_last;
  std::mutex mutex_;  ///< of the sleep between two rounds
  std::condition_variable_any woken_;
  std::vector<Cell> cells_;
  std::atomic<LinkState> state_{LinkState::connecting};
  std::atomic<std::uint64_t> connections_{0};
  std::array<std::atomic<std::uint64_t>, exchange_outcomes> counts_{};
  std::atomic<std::uint64_t> not_taken_{0};
  const std::shared_ptr<ClientLink> link_;
  std::jthread thread_;
};

std::vector<std::shared_ptr<ClientLink>> shared_links(std::span<const DeviceOptions> devices) {
  std::vector<std::shared_ptr<ClientLink>> links(devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (!devices[i].shares_connection || links[i] != nullptr) {
      continue;
    }
    const auto shares = [&](const DeviceOptions& other) {
      return other.shares_connection && other.link == devices[i].link;
    };
    auto response = devices[i].response;
    for (const DeviceOptions& other : devices) {
      response = shares(other) ? std::max(response, other.response) : response;
    }
    const auto link = std::make_shared<ClientLink>(devices[i].link, response);
    for (std::size_t k = i; k < devices.size(); ++k) {
      links[k] = shares(devices[k]) ? link : links[k];
    }
  }
  return links;
}

Device::Device(const DeviceOptions& options, DeviceWork work)
    : worker_(std::make_unique<Worker>(options, std::move(work))) {}
Device::~Device() = default;

RemoteReading Device::read(std::size_t value) const {
  return worker_->read(value);
}
void Device::write(std::size_t value, double number) {
  worker_->write(value, number);
}
std::chrono::nanoseconds Device::longest_age(std::size_t value) const {
  return worker_->longest_age(value);
}
std::uint64_t Device::not_taken() const noexcept {
  return worker_->not_taken();
}
bool Device::has_taken(std::size_t value, double number) const {
  return worker_->has_taken(value, number);
}
bool Device::round() {
  return worker_->round();
}
DeviceStatus Device::status() const noexcept {
  return worker_->status();
}

}  // namespace hysteron::runtime::modbus
