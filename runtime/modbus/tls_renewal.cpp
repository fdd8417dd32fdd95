#include "runtime/modbus/tls_renewal.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <utility>

#include "support/errors.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::time_t seconds_a_day = 86'400;

std::string days_text(std::time_t days) {
  return days == 1 ? "1 day" : fmt::format("{} days", days);
}

}  // namespace

TlsRenewal::TlsRenewal(TlsOptions options, std::shared_ptr<const TlsContext> serving, Clock::time_point now)
    : options_(std::move(options)), read_(stamps()), seen_(read_), serving_(std::move(serving)), next_(now) {}

std::vector<TlsRenewal::Stamp> TlsRenewal::stamps() const {
  std::vector<Stamp> list;
  for (const std::string& file : files_of(options_)) {
    struct stat status {};
    list.push_back(::stat(file.c_str(), &status) != 0 ? Stamp{}
                                                      : Stamp{.device = status.st_dev,
                                                              .node = status.st_ino,
                                                              .bytes = status.st_size,
                                                              .seconds = status.st_mtim.tv_sec,
                                                              .nanoseconds = status.st_mtim.tv_nsec});
  }
  return list;
}

TlsRenewal::Found TlsRenewal::look(Clock::time_point now, std::time_t today) {
  Found found;
  if (now < next_) {
    return found;
  }
  next_ = now + interval;
  auto newest = stamps();
  const bool rests = newest == seen_;
  seen_ = std::move(newest);
  if (rests && seen_ != read_) {
    read_again(found);
  }
  // Once a day of the clock: one that jumps tells once more at the most.
  const std::time_t day = today / seconds_a_day;
  found.fault = serving_->fault_at(today);
  found.days =
      static_cast<std::uint16_t>(std::clamp<std::time_t>((serving_->ends() - today) / seconds_a_day, 0, most_days));
  if (std::string line = told_ == day ? "" : line_on_dates(today, *found.fault); !line.empty()) {
    told_ = day;
    found.lines.push_back(std::move(line));
  }
  return found;
}

std::string TlsRenewal::line_on_dates(std::time_t today, TlsFault fault) const {
  const auto files = files_of(options_);
  const std::time_t left = serving_->ends() - today;
  switch (fault) {
    case TlsFault::ended:
      return fmt::format(
          "the server's certificate ended on {}: clients refuse it, the control goes on; write a new "
          "one over {}, it is read while the task runs",
          serving_->valid_until(), files.front());
    case TlsFault::not_begun:
      return fmt::format(
          "the server's certificate {} does not count yet by the clock of this machine: no client comes "
          "in, the control goes on; see whether the date is right",
          files.front());
    case TlsFault::signers:
      return fmt::format(
          "none of the certificates in {} that sign those of clients counts today: no client comes in, "
          "the control goes on; write new ones over it, they are read while the task runs",
          files.back());
    case TlsFault::none:
      break;
  }
  return left >= days_before * seconds_a_day
             ? ""
             : fmt::format(
                   "the server's certificate ends in {}, on {}; have a new one signed and write it over {}, "
                   "it is read while the task runs",
                   days_text(left / seconds_a_day), serving_->valid_until(), files.front());
}

void TlsRenewal::read_again(Found& found) {
  std::string why;
  try {
    serving_ = std::make_shared<const TlsContext>(options_);
    read_ = seen_;
    found.renewed = serving_;
    told_.reset();
    found.lines.push_back(
        fmt::format("new certificate, until {}, for connections from now on", serving_->valid_until()));
  } catch (const InputError& refused) {
    const Diagnostic& first = refused.diagnostics().all().front();
    why = fmt::format("HY{}: {} Mend: {}", first.number, first.cause, first.mend);
  } catch (const std::exception& failed) {
    why = failed.what();
  }
  if (!why.empty() && (why != refused_ || tried_ != seen_)) {
    found.lines.push_back(
        fmt::format("the new files are not taken, the certificate until {} goes on: {}", serving_->valid_until(), why));
  }
  refused_ = std::move(why);
  tried_ = seen_;
}

}  // namespace hysteron::runtime::modbus
