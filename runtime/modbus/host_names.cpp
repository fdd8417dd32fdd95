#include "runtime/modbus/host_names.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "support/descriptor.hpp"

namespace hysteron::runtime::modbus {
namespace {

using Clock = std::chrono::steady_clock;

std::optional<std::vector<std::string>> found_by(const std::string& host, int flags) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) {
    return std::nullopt;
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> release(found, &::freeaddrinfo);
  std::vector<std::string> addresses;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    std::array<char, NI_MAXHOST> text{};
    if ((one->ai_family == AF_INET || one->ai_family == AF_INET6) &&
        ::getnameinfo(one->ai_addr, one->ai_addrlen, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) == 0) {
      addresses.emplace_back(text.data());
    }
  }
  return addresses;
}

/// Without a name server; nothing where the host is a name.
std::optional<std::vector<std::string>> numeric(const std::string& host) {
  return found_by(host, AI_NUMERICHOST);
}

/// A process that asks for one host, and the pipe on which it answers.
struct Asking {
  std::size_t host = 0;
  pid_t process = -1;
  Descriptor answer{};
  std::string text{};
};

std::optional<Asking> ask(std::size_t index, const std::string& host) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return std::nullopt;
  }
  Asking asking{.host = index, .answer = Descriptor(ends[0])};
  const Descriptor write_end(ends[1]);
  asking.process = ::fork();
  if (asking.process == 0) {
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
      (void)std::signal(signal, SIG_DFL);
    }
    std::string text;
    for (const std::string& address : addresses_of(host)) {
      text += address + "\n";
    }
    [[maybe_unused]] const ssize_t written = ::write(write_end.number(), text.data(), text.size());
    ::_exit(0);
  }
  return asking.process < 0 ? std::nullopt : std::optional(std::move(asking));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    lines.push_back(text.substr(begin, end - begin));
  }
  return lines;
}

/// What comes until the pipe ends; false where the time is over before.
bool read_answer(Asking& asking, Clock::time_point until) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd one{asking.answer.number(), POLLIN, 0};
    const int ready = ::poll(&one, 1, static_cast<int>(std::max<std::int64_t>(left, 0)));  // what is there counts
    if (ready < 0 && errno == EINTR) {
      continue;
    }
    std::array<char, 1024> part{};
    const ssize_t got = ready <= 0 ? -1 : ::read(asking.answer.number(), part.data(), part.size());
    if (got <= 0) {
      return got == 0;
    }
    asking.text.append(part.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

std::vector<std::string> addresses_of(const std::string& host) {
  if (auto found = found_by(host, 0)) {
    return std::move(*found);
  }
  return ::strcasecmp(host.c_str(), "localhost") == 0 ? numeric("127.0.0.1").value_or(std::vector<std::string>())
                                                      : std::vector<std::string>();
}

std::vector<std::vector<std::string>> addresses_within(std::span<const std::string> hosts,
                                                       std::chrono::milliseconds patience) {
  const auto until = Clock::now() + patience;
  std::vector<std::vector<std::string>> found(hosts.size());
  std::vector<Asking> asked;
  for (std::size_t i = 0; i < hosts.size(); ++i) {
    if (auto addresses = numeric(hosts[i])) {
      found[i] = std::move(*addresses);
    } else if (auto asking = ask(i, hosts[i])) {
      asked.push_back(std::move(*asking));
    }
  }
  for (Asking& one : asked) {
    const bool is_whole = read_answer(one, until);
    (void)::kill(one.process, SIGKILL);
    (void)::waitpid(one.process, nullptr, 0);
    found[one.host] = is_whole ? lines_of(one.text) : std::vector<std::string>();
  }
  return found;
}

/// Shared with the thread that asks, which may outlive who asked.
struct HostName::LookUp {
  std::mutex lock{};
  std::condition_variable done{};
  std::optional<std::vector<std::string>> found{};
};

HostName::HostName(std::string host, std::vector<std::string> known)
    : host_(std::move(host)), known_(std::move(known)) {
  if (auto addresses = numeric(host_)) {
    known_ = std::move(*addresses);
    is_numeric_ = true;
  }
}

std::string HostName::next_address(std::chrono::milliseconds patience) {
  if (next_ == known_.size()) {
    next_ = 0;
    if (!is_numeric_) {
      look_up(patience);
    }
  }
  return known_.empty() ? "" : known_[next_++];
}

void HostName::look_up(std::chrono::milliseconds patience) {
  if (asked_ == nullptr) {
    const auto asked = std::make_shared<LookUp>();
    try {
      std::thread([asked, host = host_] {
        auto found = addresses_of(host);
        const std::scoped_lock lock(asked->lock);
        asked->found = std::move(found);
        asked->done.notify_all();
      }).detach();
    } catch (const std::system_error&) {
      return;  // no thread is left; the next time one may be
    }
    asked_ = asked;
  }
  std::unique_lock lock(asked_->lock);
  if (!asked_->done.wait_for(lock, patience, [&] { return asked_->found.has_value(); })) {
    return;
  }
  if (!asked_->found->empty()) {
    known_ = std::move(*asked_->found);
  }
  lock.unlock();
  asked_.reset();
}

void HostName::was_reached() {
  next_ = next_ == 0 ? 0 : next_ - 1;
}

}  // namespace hysteron::runtime::modbus
