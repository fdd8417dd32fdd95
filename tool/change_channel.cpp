#include "tool/change_channel.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "runtime/host/notices.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"

namespace hysteron::tool {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

/// A request is small; an answer has the text of a diagram at the most.
constexpr std::size_t most_bytes = 64'000'000;
constexpr milliseconds time_for_a_line{5'000};
/// Who asks is told what he waits for after this, and whenever it is something else.
constexpr milliseconds first_word{1'000};
/// A large diagram is compiled within this.
constexpr milliseconds time_for_an_answer{600'000};
constexpr std::chrono::seconds between_tries{10};

std::string problem_text(int number) {
  return std::generic_category().message(number);
}

/// Nothing where the path is too long for one.
std::optional<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof(address.sun_path)) {
    return {};
  }
  std::memcpy(static_cast<char*>(address.sun_path), path.data(), path.size());
  return address;
}

Descriptor new_socket() {
  return Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
}

/// One that its owner alone may open, before it has a name: at no moment may another user. Not open where there is
/// none.
Descriptor new_private_socket() {
  Descriptor socket = new_socket();
  return socket.is_open() && ::fchmod(socket.number(), S_IRUSR | S_IWUSR) == 0 ? std::move(socket) : Descriptor{};
}

bool connect_to(const Descriptor& socket, const sockaddr_un& address) {
  return ::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

bool is_own_user(const Descriptor& peer) {
  ucred who{};
  socklen_t size = sizeof(who);
  return ::getsockopt(peer.number(), SOL_SOCKET, SO_PEERCRED, &who, &size) == 0 && who.uid == ::geteuid();
}

bool send_line(const Descriptor& to, std::string line) {
  line += '\n';
  for (std::size_t sent = 0; sent < line.size();) {
    const ssize_t more = ::send(to.number(), line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (more < 0 && errno != EINTR) {
      return false;
    }
    sent += static_cast<std::size_t>(more < 0 ? 0 : more);
  }
  return true;
}

/// Lines as they come.
class LineReader {
 public:
  enum class Outcome : std::uint8_t { line, late, ended };

  explicit LineReader(const Descriptor& from) : from_(&from) {}

  Outcome read(std::string& line, milliseconds time) {
    const auto until = SteadyClock::now() + time;
    std::array<char, 65536> part{};
    for (;;) {
      if (const auto end = text_.find('\n', searched_); end != std::string::npos) {
        line = text_.substr(0, end);
        text_.erase(0, end + 1);
        searched_ = 0;
        return Outcome::line;
      }
      searched_ = text_.size();
      const auto left = std::chrono::ceil<milliseconds>(until - SteadyClock::now()).count();
      pollfd wait{.fd = from_->number(), .events = POLLIN, .revents = 0};
      if (text_.size() > most_bytes) {
        return Outcome::ended;
      }
      if (left <= 0) {
        return Outcome::late;
      }
      if (::poll(&wait, 1, static_cast<int>(left)) < 0 && errno != EINTR) {
        return Outcome::ended;
      }
      if (wait.revents == 0) {
        continue;
      }
      const ssize_t read = ::recv(from_->number(), part.data(), part.size(), 0);
      if (read <= 0) {
        return Outcome::ended;
      }
      text_.append(part.data(), static_cast<std::size_t>(read));
    }
  }

 private:
  const Descriptor* from_;
  std::string text_{};
  std::size_t searched_ = 0;  ///< no line ends before
};

/// What is being done, of a line that is no answer yet.
std::optional<std::string> progress_of(const std::string& line) {
  const auto json = nlohmann::json::parse(line, nullptr, false);
  return json.is_object() && json.contains("progress") ? std::optional(json.at("progress").get<std::string>())
                                                       : std::nullopt;
}

[[noreturn]] void refuse_socket(const std::string& path, const Place& place, int reason) {
  const std::string of_machine = mend_of_machine(reason);
  throw InputError(
      error::unusable_change_socket, place, fmt::format("There can be no socket {}: {}.", path, problem_text(reason)),
      of_machine.empty() ? "name a file in a folder that is there and that this user may write." : of_machine + ".");
}

/// Refuses what is at the name and is not a socket that a task which is gone has left.
void require_free(const std::string& path, const Place& place, const sockaddr_un& address) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) {
    return;
  }
  if (!S_ISSOCK(found.st_mode)) {
    throw InputError(error::unusable_change_socket, place,
                     fmt::format("There can be no socket {}: a file of that name is there, which is none.", path),
                     "remove that file, or name another one.");
  }
  if (connect_to(new_socket(), address)) {
    throw InputError(error::file_of_another_task, place, fmt::format("Another task that runs listens on {}.", path),
                     "end that task first, or name another file.");
  }
}

}  // namespace

ChangeListener::ChangeListener(const std::string& path, const Place& place, Answer answer, Missing missing)
    : path_(path),
      answer_(std::move(answer)),
      missing_(std::move(missing)),
      socket_(new_private_socket()),
      end_(::eventfd(0, EFD_CLOEXEC)) {
  if (!socket_.is_open() || !end_.is_open()) {
    refuse_socket(path, place, errno);  // of what came last, before another call has its own
  }
  const auto address = address_of(path);
  if (!address) {
    throw InputError(error::unusable_change_socket, place,
                     fmt::format("There can be no socket {}: the name is too long.", path),
                     "name a file of fewer than 108 bytes.");
  }
  require_free(path, place, *address);
  const int problem = listen();
  listens_ = problem == 0;
  if (!listens_ && !is_trouble_of_disk(problem)) {
    refuse_socket(path, place, problem);
  }
  if (!listens_) {
    miss(fmt::format("there can be no socket {} yet: {}", path, problem_text(problem)));
  }
  thread_ = std::thread([this] { serve(); });
}

void ChangeListener::miss(const std::string& why) const {
  runtime::tell("Online change",
                fmt::format("{}. It is tried again every {} s; the control goes on.", why, between_tries.count()));
  if (missing_) {
    missing_(true);
  }
}

/// What a task that is gone has left is removed. 0, or errno.
int ChangeListener::listen() {
  const auto address = address_of(path_);
  struct stat found {};
  if (::lstat(path_.c_str(), &found) == 0 && S_ISSOCK(found.st_mode) && ::unlink(path_.c_str()) != 0) {
    return errno;
  }
  if (::bind(socket_.number(), reinterpret_cast<const sockaddr*>(&*address), sizeof(*address)) != 0 ||
      ::listen(socket_.number(), 4) != 0) {
    return errno;
  }
  named_ = file_named(path_);
  return 0;
}

/// False where it is to end before.
bool ChangeListener::listens_at_last() {
  for (;;) {
    pollfd wait{.fd = end_.number(), .events = POLLIN, .revents = 0};
    (void)::poll(&wait, 1, static_cast<int>(milliseconds(between_tries).count()));
    if (wait.revents != 0) {
      return false;
    }
    if (!socket_.is_open()) {
      socket_ = new_private_socket();
    }
    if (socket_.is_open() && listen() == 0) {
      runtime::tell("Online change", fmt::format("the socket {} is there now.", path_), runtime::Weight::notice);
      if (missing_) {
        missing_(false);
      }
      listens_ = true;
      return true;
    }
  }
}

ChangeListener::~ChangeListener() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(end_.number(), &one, sizeof(one));
  thread_.join();
  if (listens_ && file_named(path_) == named_) {  // the name may be another task's by now
    (void)::unlink(path_.c_str());
  }
}

void ChangeListener::serve() {
  // What is compiled here must not be felt by the task where that has no real-time scheduling.
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 10);
  for (;;) {
    if (!listens_ && !listens_at_last()) {
      return;
    }
    std::array<pollfd, 2> wait{pollfd{.fd = socket_.number(), .events = POLLIN, .revents = 0},
                               pollfd{.fd = end_.number(), .events = POLLIN, .revents = 0}};
    const int ready = ::poll(wait.data(), wait.size(), static_cast<int>(milliseconds(between_tries).count()));
    if (wait[1].revents != 0) {
      return;
    }
    if (ready == 0) {
      look_after_name();
      continue;
    }
    const Descriptor client(::accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC));
    if (client.is_open() && is_own_user(client)) {
      serve_one(client);
    } else if (!client.is_open()) {
      std::this_thread::sleep_for(milliseconds(100));  // no descriptor is left
    }
  }
}

/// A name that somebody deleted, as a clean-up of old files does, is made anew.
void ChangeListener::look_after_name() {
  if (file_named(path_)) {
    return;
  }
  socket_ = new_private_socket();  // a socket can be given a name once
  const int problem = socket_.is_open() ? listen() : errno;
  listens_ = problem == 0;
  if (listens_) {
    runtime::tell("Online change", fmt::format("the socket {} was deleted, and is there again.", path_));
  } else {
    miss(fmt::format("the socket {} was deleted, and there can be no other yet: {}", path_, problem_text(problem)));
  }
}

void ChangeListener::serve_one(const Descriptor& client) const {
  const timeval patience{.tv_sec = 5, .tv_usec = 0};
  (void)::setsockopt(client.number(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  std::string request;
  if (LineReader(client).read(request, time_for_a_line) == LineReader::Outcome::line) {
    const auto progress = [&](std::string_view what) {
      (void)send_line(client, nlohmann::json{{"progress", what}}.dump());
    };
    (void)send_line(client, answer_(request, progress));
  }
}

std::string ask_task(const std::string& path, const Place& place, const std::string& request,
                     const ChangeListener::Progress& waits) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(error::no_online_change, place,
                     fmt::format("No task takes an online change on {}: {}.", path, why),
                     "start the task with this run file, and give the command as its user and in its folder.");
  };
  const auto address = address_of(path);
  const Descriptor socket = new_socket();
  if (!address) {
    refuse("the name is too long, or empty");
  }
  if (!socket.is_open() || !connect_to(socket, *address)) {
    refuse(problem_text(errno));
  }
  if (!is_own_user(socket)) {
    refuse("it is of another user");
  }
  if (!send_line(socket, request)) {
    refuse(problem_text(errno));
  }
  const auto begin = SteadyClock::now();
  LineReader reader(socket);
  std::string line;
  std::string doing = "looks after another request";
  for (std::string told;;) {
    const auto outcome = reader.read(line, first_word);
    if (outcome == LineReader::Outcome::ended) {
      refuse("it ended before it gave an answer; its last line says whether the version had changed");
    }
    if (outcome == LineReader::Outcome::late) {
      const auto waited = SteadyClock::now() - begin;
      if (waited > time_for_an_answer) {
        refuse(fmt::format("it gave no answer within {} min", duration_cast<std::chrono::minutes>(waited).count()));
      }
      if (doing != told) {
        waits(doing);
        told = doing;
      }
      continue;
    }
    const auto progress = progress_of(line);
    if (!progress) {
      return line;
    }
    doing = *progress;
  }
}

}  // namespace hysteron::tool
