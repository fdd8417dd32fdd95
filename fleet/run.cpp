#include "fleet/run.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <system_error>
#include <utility>

#include "fleet/child.hpp"
#include "fleet/claim.hpp"
#include "fleet/run_record.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;

constexpr int exit_found = 0;
constexpr int exit_refused = 1;
constexpr double look_again = 0.2;  ///< s, at units that others work on

struct Running {
  std::size_t unit;
  Claim claim;
  fs::path folder;  ///< that becomes the unit's
  Child child;
  bool ended = false;
  bool out_of_time = false;
};

/// The first line of what a process said.
std::string first_line(const fs::path& messages) {
  try {
    const std::string text = read_text_file(messages.string());
    return text.substr(0, text.find('\n'));
  } catch (const InputError&) {
    return "";
  }
}

Result result_of(const Running& one, Command command, int code, const RunOptions& options) {
  Result result{.exit_code = code, .seconds = one.child.seconds()};
  std::error_code unknown;
  const auto bytes = fs::file_size(one.folder / product_of(command), unknown);
  const bool found = !unknown && bytes > 0;
  if (one.out_of_time) {
    result.status = Status::Failed;
    result.reason = fmt::format("it took longer than {:g} s (--time-limit).", options.time_limit);
  } else if (found && (code == exit_found || code == exit_refused)) {
    result.status = code == exit_found ? Status::Done : Status::Refused;
    result.reason = code == exit_found ? "" : refusal_of(command);
  } else {
    result.status = Status::Failed;
    result.reason = first_line(one.folder / "messages.txt");
    if (code > Child::killed) {
      result.reason = fmt::format("it was ended by signal {}. {}", code - Child::killed, result.reason);
    } else if (result.reason.empty()) {
      result.reason = fmt::format("it ended with {} and said nothing.", code);
    }
  }
  return result;
}

class Pool {
 public:
  Pool(const std::vector<Unit>& units, const std::vector<std::string>& keys, const RunOptions& options)
      : units_(units), keys_(keys), options_(options) {}

  void work(Worked& worked) {
    std::deque<std::size_t> waiting;
    for (std::size_t i = options_.share - 1; i < units_.size(); i += options_.shares) {
      waiting.push_back(i);
    }
    const std::size_t all = waiting.size();
    while (!waiting.empty() || !running_.empty()) {
      for (std::size_t left = waiting.size(); left > 0 && running_.size() < options_.workers; --left) {
        const std::size_t unit = waiting.front();
        waiting.pop_front();
        if (is_done(unit)) {
          ++worked.found;
        } else if (!start(unit)) {
          waiting.push_back(unit);
        }
      }
      wait(!waiting.empty() && running_.size() < options_.workers);
      worked.ran += finish_ended();
      if (options_.progress && worked.ran + worked.found > 0) {
        options_.progress(worked.ran + worked.found, all, units_[last_]);
      }
    }
  }

 private:
  /// With `retry`, what had failed before this command began is not done.
  [[nodiscard]] bool is_done(std::size_t unit) const {
    const Result there = read_result(folder_of(options_.output, keys_[unit]));
    return there.status == Status::Failed ? !options_.retry : there.status != Status::Open;
  }

  /// Whether it was started, or turned out to be done; not where another works on it.
  bool start(std::size_t unit) {
    auto claim = Claim::on(options_.output / "claims" / keys_[unit]);
    if (!claim) {
      return false;
    }
    remove_leftovers(unit);
    if (is_done(unit)) {  // between the look and the claim
      return false;       // the next look finds it
    }
    const fs::path folder = work() / fmt::format("{}.{}", keys_[unit], getpid());
    fs::create_directories(folder);
    const Unit& one = units_[unit];
    std::vector<std::string> command = arguments_of(one, folder, options_.options);
    command.insert(command.begin(), options_.program);
    // A check prints what it finds; the others write it.
    const fs::path printed = one.command == Command::Check ? folder / product_of(one.command) : "/dev/null";
    Child child(command, printed, folder / "messages.txt", options_.megabytes);
    running_.push_back({.unit = unit, .claim = std::move(*claim), .folder = folder, .child = std::move(child)});
    return true;
  }

  [[nodiscard]] fs::path work() const { return options_.output / "work"; }

  /// Of someone who was killed: the claim is ours, so nobody works there.
  void remove_leftovers(std::size_t unit) const {
    for (const auto& entry : fs::directory_iterator(work())) {
      if (entry.path().stem() == keys_[unit]) {
        fs::remove_all(entry.path());
      }
    }
  }

  /// Until a process ends, is out of time, or it is time to look at the units of others.
  void wait(bool others) {
    double seconds = others ? look_again : options_.time_limit;
    std::vector<pollfd> ends;
    for (const Running& one : running_) {
      seconds = std::min(seconds, options_.time_limit - one.child.seconds());
      ends.push_back({.fd = one.child.descriptor(), .events = POLLIN, .revents = 0});
    }
    if (others || !ends.empty()) {
      const double milliseconds = std::clamp(std::ceil(1000.0 * seconds), 0.0, 60000.0);
      (void)poll(ends.data(), ends.size(), static_cast<int>(milliseconds));
    }
    for (std::size_t i = 0; i < running_.size(); ++i) {
      Running& one = running_[i];
      one.ended = ends[i].revents != 0;
      if (one.child.seconds() >= options_.time_limit) {
        one.out_of_time = true;
        one.child.kill();
      }
    }
  }

  std::size_t finish_ended() {
    std::size_t finished = 0;
    for (std::size_t i = 0; i < running_.size();) {
      if (running_[i].out_of_time || running_[i].ended) {
        finish(running_[i]);
        running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
        ++finished;
      } else {
        ++i;
      }
    }
    return finished;
  }

  void finish(Running& one) {
    one.child.kill();  // what it has started goes with it
    const int code = one.child.wait();
    write_result(one.folder, units_[one.unit], options_.version,
                 result_of(one, units_[one.unit].command, code, options_));
    const fs::path place = folder_of(options_.output, keys_[one.unit]);
    const fs::path before = work() / fmt::format("{}.before", keys_[one.unit]);
    if (fs::exists(place)) {
      fs::rename(place, before);  // a failure that was tried again
    }
    fs::rename(one.folder, place);
    fs::remove_all(before);
    last_ = one.unit;
  }

  const std::vector<Unit>& units_;
  const std::vector<std::string>& keys_;
  const RunOptions& options_;
  std::vector<Running> running_;
  std::size_t last_ = 0;
};

std::vector<std::string> keys_of(const std::vector<Unit>& units, const std::string& manifest,
                                 const RunOptions& options) {
  std::vector<std::string> keys;
  std::map<std::string, std::uint32_t> lines;
  Diagnostics found;
  Keys known(options.version, options.options, options.named_files);
  for (const Unit& unit : units) {
    keys.push_back(known.of(unit));
    const auto [first, is_new] = lines.emplace(keys.back(), unit.line);
    if (!is_new) {
      found.error(error::bad_usage, {.file = manifest, .line = unit.line},
                  fmt::format("the line says the same as line {}: command, machine, when, diagram, params and log.",
                              first->second),
                  "remove one of them, or correct what is different.");
    }
  }
  if (found.has_errors()) {
    throw InputError(found);
  }
  return keys;
}

}  // namespace

Worked work_off(const std::vector<Unit>& units, const std::string& manifest, const RunOptions& options) {
  Worked worked{.keys = keys_of(units, manifest, options)};
  try {
    for (const char* const folder : {"units", "claims", "work", "runs"}) {
      fs::create_directories(options.output / folder);
    }
    write_run(options.output, {.manifest = manifest,
                               .version = options.version,
                               .options = options.options,
                               .units = units,
                               .keys = worked.keys});
    Pool(units, worked.keys, options).work(worked);
  } catch (const std::system_error& problem) {  // those of the file system, too
    throw InputError(error::unwritable_file, {.file = options.output.string()},
                     fmt::format("the work cannot go on: {}.", problem.what()),
                     "make room or permit writing, and run the same command again; what is done stays.");
  }
  return worked;
}

}  // namespace hysteron::fleet
