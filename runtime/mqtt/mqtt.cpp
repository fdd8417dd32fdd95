#include "runtime/mqtt/mqtt.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <random>
#include <system_error>
#include <utility>

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t a_second = 1'000'000'000;
constexpr std::int64_t longest_retry = 60 * a_second;
/// A connection that breaks sooner counts as a try: so two clients of one name do not push each other out every second.
constexpr std::int64_t steadiness = 60 * a_second;
constexpr std::size_t rows_at_once = 100;      ///< rows that are on their way at once
constexpr std::int64_t birth_pace = a_second;  ///< however often a birth is asked for
constexpr int sender_niceness = 10;            ///< whatever runs the machine goes before
constexpr milliseconds longest_wait{100};
constexpr milliseconds longest_end{2000};
constexpr milliseconds farewell_time{500};
constexpr std::int64_t keep_pace = a_second;        ///< a row that waits for longer is on the disk
constexpr std::int64_t file_retry = 10 * a_second;  ///< for a file that could not be written

/// So that machines that lost one broker do not all come back at once.
std::int64_t spread(std::int64_t pause) {
  static thread_local std::minstd_rand random(std::random_device{}());
  return static_cast<std::int64_t>(static_cast<double>(pause) *
                                   std::uniform_real_distribution<double>(0.75, 1.0)(random));
}

}  // namespace

MqttSender::MqttSender(MqttSettings settings, std::unique_ptr<MqttDialect> dialect, SampleTap& tap,
                       KeptCounter& counter, BesideClocks clocks)
    : settings_(std::move(settings)),
      dialect_(std::move(dialect)),
      tap_(&tap),
      counter_(&counter),
      time_(std::move(clocks), settings_.period, false),
      maker_(settings_.rows),
      outbox_(settings_.bytes, settings_.keep) {}

/// What an earlier run left waits before all that comes.
void MqttSender::open_file() {
  std::vector<std::string> names;
  for (const MqttPoint& point : settings_.rows.points) {
    names.push_back(point.name);
  }
  try {
    auto file = std::make_unique<OutboxFile>(settings_.file, names, settings_.owner);
    if (!file->aside().empty()) {
      remarks_.say(fmt::format("{} was damaged: what it held is in {}, and is not sent.", settings_.file.string(),
                               file->aside()));
    }
    // Those that came meanwhile follow those of the file.
    Outbox all(settings_.bytes, settings_.keep, file->first());
    const std::int64_t now = time_.steady();
    std::uint64_t lost = 0;
    for (const MqttRow& row : file->rows()) {
      const std::int64_t age = std::max<std::int64_t>(0, time_.now_ms() - row.utc_ms);
      lost += all.add(row, now - std::min(age, settings_.keep / 1'000'000 + 1) * 1'000'000);
    }
    if (!file->rows().empty()) {
      remarks_.say(fmt::format("{} rows of before wait for {}.", file->rows().size(), broker()));
    }
    file->forget_rows();
    outbox_.call_back();
    for (const MqttRow* const row : outbox_.rows_from(outbox_.first(), now)) {
      lost += all.add(*row, now);
    }
    outbox_ = std::move(all);
    rows_on_the_way_.clear();
    fences_.clear();
    first_live_ = outbox_.first() + outbox_.size();
    file_ = std::move(file);
    keep_at_ = now + keep_pace;
    lose(lost);
  } catch (const OutboxOfAnother& problem) {
    file_failed(problem.what(), "Each task needs a file of its own: write another one under [mqtt]");
  } catch (const database::DatabaseError& problem) {
    file_failed(problem);
  }
}

/// Deleted or moved by somebody: all that waits is in memory still, and goes to another one.
void MqttSender::leave_file_that_is_gone() {
  if (file_ != nullptr && !file_->is_there()) {
    remarks_.say(fmt::format("{} is gone; another one is begun. Had the task died meanwhile, {} rows would be lost.",
                             settings_.file.string(), outbox_.size()));
    file_.reset();
    keep_at_ = time_.steady();
  }
}

void MqttSender::keep(std::int64_t before) {
  leave_file_that_is_gone();
  if (file_ == nullptr) {
    return;
  }
  try {
    file_->follow(outbox_.first(), outbox_.rows_from(std::max(file_->end(), outbox_.first()), before));
    keep_at_ = time_.steady() + keep_pace;
    if (std::exchange(is_file_told_, false)) {
      remarks_.say("rows that wait are on the disk again.");
    }
  } catch (const database::DatabaseError& problem) {
    file_failed(problem);
    if (!problem.is_passing()) {
      file_.reset();  // it is opened anew, and put aside
    }
  }
}

void MqttSender::file_failed(const database::DatabaseError& problem) {
  file_failed(problem.what(), database::way_out(problem));
}

void MqttSender::file_failed(const std::string& problem, const std::string& mend) {
  keep_at_ = time_.steady() + file_retry;
  if (!std::exchange(is_file_told_, true)) {
    remarks_.say(
        fmt::format("rows that wait are in memory alone: {}. {}; it is tried again every 10 s.", problem, mend));
  }
}

/// A fault of the file is told where the connection has none.
void MqttSender::set_fault(MqttFault fault) {
  link_fault_ = fault;
  counter_->set_fault(static_cast<std::uint16_t>(fault == MqttFault::None && is_file_told_ ? MqttFault::File : fault));
}

std::string MqttSender::broker() const {
  return fmt::format("{}:{}", settings_.link.broker, settings_.link.port);
}

void MqttSender::turn(milliseconds wait, int wake) {
  take();
  // Its rows come first: so it is opened where none is on the way.
  if (!settings_.file.empty() && file_ == nullptr && time_.steady() >= keep_at_ &&
      (client_ == nullptr || outbox_.size() == 0)) {
    open_file();
  }
  try {
    serve(wait, wake);
  } catch (const MqttError& problem) {
    failed(problem);
  }
  if (file_ != nullptr && time_.steady() >= keep_at_) {
    keep(time_.steady() - keep_pace);
  }
  set_fault(link_fault_);
  counter_->set_waiting(outbox_.size());
}

void MqttSender::take() {
  if (const double step = time_.look(); step != 0.0) {
    remarks_.say(fmt::format("the machine's clock was set {} by {:.1f} s. Rows keep their order.",
                             step > 0.0 ? "forward" : "back", std::abs(step)));
  }
  const std::int64_t now = time_.steady();
  taken_.clear();
  tap_->take(taken_);
  std::uint64_t lost = 0;
  for (Sample& sample : taken_) {
    if (auto row = maker_.row(sample, time_.utc_ms(sample.elapsed))) {
      lost += outbox_.add(std::move(*row), now);
    }
  }
  if (!taken_.empty()) {
    newest_ = std::move(taken_.back());
  }
  lose(lost + outbox_.expire(now));
}

void MqttSender::lose(std::uint64_t rows) {
  if (rows == 0) {
    return;
  }
  counter_->add_lost(rows);
  if (!std::exchange(is_losing_, true)) {
    remarks_.say(
        fmt::format("the oldest of the rows that wait for {} are lost from now on: they are too many, or too "
                    "old. task.mqtt_lost counts them; megabytes and keep in [mqtt] are the bounds.",
                    broker()));
  }
}

void MqttSender::serve(milliseconds wait, int wake) {
  if (client_ == nullptr) {
    if (time_.steady() < retry_at_) {
      pollfd end{wake, POLLIN, 0};
      (void)::poll(&end, 1, static_cast<int>(wait.count()));
      return;
    }
    client_ = std::make_unique<MqttClient>(settings_.link, dialect_->will());
  }
  if (client_->is_connected()) {
    greet();
    answer();
    send();
  }
  client_->turn(wait, wake);
  confirm();
  if (client_->is_late()) {
    // The system still tries to connect; that is not given up, only said.
    set_fault(MqttFault::Unreachable);
    remarks_.failed("it does not answer",
                    fmt::format("{} does not answer. Rows wait meanwhile. The task goes on.", broker()));
  }
}

/// Rows follow the birth, and a birth has values: it waits for the first row of the task.
void MqttSender::greet() {
  if (is_greeted_ || !newest_) {
    return;
  }
  if (const std::string topic = dialect_->commands(); !topic.empty()) {
    client_->subscribe(topic);
  }
  publish_birth();
  is_greeted_ = true;
  greeted_at_ = birth_at_;
  progress_ = birth_at_;
  first_live_ = outbox_.next_number() + outbox_.size();
  maker_.forget();
  counter_->set_connected(true);
  set_fault(MqttFault::None);
  remarks_.is_well(fmt::format("connected to {}; {} rows wait, {} are lost since the start.", broker(), outbox_.size(),
                               counter_->read().lost));
}

void MqttSender::answer() {
  for (const std::string& payload : client_->received()) {
    is_birth_asked_ = is_birth_asked_ || dialect_->asks_for_birth(payload);
  }
  if (is_greeted_ && is_birth_asked_ && time_.steady() - birth_at_ >= birth_pace) {
    is_birth_asked_ = false;
    publish_birth();
  }
}

void MqttSender::publish_birth() {
  birth_at_ = time_.steady();
  client_->publish(dialect_->birth(maker_.whole(*newest_, time_.utc_ms(newest_->elapsed)), time_.now_ms()));
}

void MqttSender::send() {
  if (!is_greeted_) {
    return;
  }
  std::optional<std::uint64_t> unfenced;
  while (outbox_.next() != nullptr && outbox_.on_the_way() < rows_at_once) {
    if (outbox_.on_the_way() == 0) {
      progress_ = time_.steady();
    }
    const std::uint64_t number = outbox_.next_number();
    const MqttMessage message = dialect_->data(*outbox_.next(), number < first_live_, time_.now_ms());
    const int sent = client_->publish(message);
    outbox_.send();
    if (message.qos > 0) {
      rows_on_the_way_.emplace(sent, number);
    } else {
      unfenced = number;
    }
  }
  if (unfenced) {
    fences_.emplace(client_->fence(), *unfenced);
  }
}

void MqttSender::confirm() {
  const std::int64_t now = time_.steady();
  for (const int number : client_->confirmed()) {
    std::size_t done = 0;
    if (const auto row = rows_on_the_way_.extract(number)) {
      done = outbox_.confirm(row.mapped());
    } else if (const auto fence = fences_.extract(number)) {
      done = outbox_.confirm_through(fence.mapped());
    } else {
      continue;
    }
    counter_->add_done(done);
    progress_ = now;
  }
  if (is_losing_ && outbox_.size() == 0) {
    is_losing_ = false;
    maker_.forget();  // what is lost may have been a change
  }
  const std::int64_t patience = std::chrono::nanoseconds(settings_.link.patience).count();
  if (outbox_.on_the_way() > 0 && now - progress_ > patience) {
    throw MqttError(MqttFault::Lost, "it confirms nothing any more");
  }
}

void MqttSender::failed(const MqttError& problem) {
  const std::int64_t now = time_.steady();
  if (is_greeted_ && now - greeted_at_ >= steadiness) {
    pause_ = 0;
  }
  client_.reset();
  is_greeted_ = false;
  is_birth_asked_ = false;
  rows_on_the_way_.clear();
  fences_.clear();
  outbox_.call_back();
  pause_ = std::clamp(2 * pause_, a_second, longest_retry);
  retry_at_ = now + spread(pause_);
  counter_->set_connected(false);
  set_fault(problem.fault());
  remarks_.failed(problem.what(), fmt::format("nothing reaches {}: {}. Rows wait meanwhile; it is tried again, at last "
                                              "once a minute. The task goes on.",
                                              broker(), problem.what()));
}

void MqttSender::finish(milliseconds longest) {
  using Clock = std::chrono::steady_clock;
  constexpr milliseconds step{20};
  take();
  const auto end = Clock::now() + longest;
  try {
    while (client_ != nullptr && is_greeted_ && outbox_.size() > 0 && Clock::now() < end) {
      send();
      client_->turn(step, -1);
      confirm();
    }
    if (client_ != nullptr && is_greeted_) {
      client_->publish(dialect_->farewell(time_.now_ms()));
      client_->disconnect();
      while (!client_->is_empty() && Clock::now() < end + farewell_time) {
        client_->turn(step, -1);
      }
    }
  } catch (const MqttError& problem) {
    if (outbox_.size() > 0) {
      failed(problem);
    }
  }
  client_.reset();
  counter_->set_connected(false);
  leave_file_that_is_gone();
  if (file_ == nullptr && !settings_.file.empty()) {
    open_file();
  }
  if (file_ != nullptr) {
    outbox_.call_back();
    keep(time_.steady());
  }
  // Where the disk was full at the end, the file holds the older ones.
  const std::uint64_t behind = file_ == nullptr ? 0 : file_->end();
  const std::uint64_t kept =
      std::min<std::uint64_t>(outbox_.size(), behind > outbox_.first() ? behind - outbox_.first() : 0);
  if (kept > 0) {
    remarks_.say(fmt::format("{} rows wait in {} for the next start.", kept, settings_.file.string()));
  }
  counter_->add_lost(outbox_.size() - kept);
  counter_->set_waiting(kept);
  const std::uint64_t lost = counter_->read().lost;
  if (lost == 0) {
    remarks_.is_well("no row is lost at the end.");
    return;
  }
  const std::string known = remarks_.problem();
  remarks_.failed(fmt::format("{} since the start{}{}", lost, known.empty() ? "" : "; ", known),
                  fmt::format("{} rows for {} are lost since the start.", lost, broker()));
}

Mqtt::Mqtt(MqttSettings settings, std::unique_ptr<MqttDialect> dialect, SampleTap& tap, KeptCounter& counter,
           BesideClocks clocks)
    : interval_(std::clamp(milliseconds(settings.period * static_cast<std::int64_t>(tap.step()) / 1'000'000),
                           milliseconds(5), longest_wait)),
      sender_(std::move(settings), std::move(dialect), tap, counter, std::move(clocks)),
      over_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!over_.is_open()) {
    throw std::system_error(errno, std::generic_category(), "MQTT");
  }
  thread_ = std::thread([this] { run(); });
}

Mqtt::~Mqtt() {
  finish();
}

void Mqtt::run() {
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), sender_niceness);
  ignore_broken_pipes();
  eventfd_t asked = 0;
  while (::eventfd_read(over_.number(), &asked) != 0) {
    sender_.turn(interval_, over_.number());
  }
  sender_.finish(longest_end);
}

void Mqtt::finish() {
  if (thread_.joinable()) {
    (void)::eventfd_write(over_.number(), 1);
    thread_.join();
  }
}

}  // namespace hysteron::runtime
