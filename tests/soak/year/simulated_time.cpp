#include "tests/soak/year/simulated_time.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <ctime>
#include <limits>
#include <list>
#include <utility>

namespace hysteron::soak {
namespace {

constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

std::int64_t in_nanoseconds(const timespec& time) noexcept {
  return static_cast<std::int64_t>(time.tv_sec) * second + time.tv_nsec;
}

timespec as_timespec(std::int64_t time) noexcept {
  return {.tv_sec = static_cast<time_t>(time / second), .tv_nsec = static_cast<long>(time % second)};
}

std::int64_t real_time(clockid_t clock) noexcept {
  timespec time{};
  (void)::syscall(SYS_clock_gettime, clock, &time);
  return in_nanoseconds(time);
}

/// A thread that waits for a time; with a condition, for that as well.
struct Sleeper {
  std::int64_t until = 0;
  pthread_cond_t* condition = nullptr;
  pthread_mutex_t* its_mutex = nullptr;
  bool is_due = false;
};

/// One for the process, as the functions that it replaces.
struct World {
  std::atomic<bool> is_on{false};
  std::atomic<std::int64_t> now{0};
  std::atomic<std::int64_t> utc_ahead{0};
  std::atomic<std::int64_t> computed{0};
  std::atomic<std::int64_t> quantum{0};
  std::atomic<std::int64_t> earliest{never};
  std::atomic<bool> passes{false};  ///< the cyclic thread drives it
  std::atomic<bool> is_over{false};
  SimulatedTime::AtWake at_wake{};
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t woken = PTHREAD_COND_INITIALIZER;     ///< to sleepers without a condition
  pthread_cond_t all_wait = PTHREAD_COND_INITIALIZER;  ///< to the cyclic thread
  std::list<Sleeper> sleepers{};
  std::size_t expected = 0;  ///< sleepers before the first cycle
  int awake = 0;             ///< threads beside that slept before and do not now
};

World& world() noexcept {
  static World one;
  return one;
}

/// What a thread is here. Its end counts as going to sleep.
struct Participant {
  bool is_counted = false;
  Participant() = default;
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;
  ~Participant();
};
thread_local Participant participant;

void wake_all_due(World& one, std::int64_t now) {
  for (Sleeper& sleeper : one.sleepers) {
    if (!sleeper.is_due && sleeper.until <= now) {
      sleeper.is_due = true;
      ++one.awake;
      if (sleeper.condition != nullptr) {
        // Once its mutex can be had, it waits for the condition.
        pthread_mutex_t* const its_mutex = sleeper.its_mutex;
        pthread_cond_t* const condition = sleeper.condition;
        pthread_mutex_lock(its_mutex);
        pthread_cond_broadcast(condition);
        pthread_mutex_unlock(its_mutex);
      }
    }
  }
  one.earliest.store(never);
  for (const Sleeper& sleeper : one.sleepers) {
    if (!sleeper.is_due) {
      one.earliest.store(std::min(one.earliest.load(), sleeper.until));
    }
  }
  pthread_cond_broadcast(&one.woken);
}

Participant::~Participant() {
  World& one = world();
  pthread_mutex_lock(&one.mutex);
  if (is_counted) {
    --one.awake;
    pthread_cond_signal(&one.all_wait);
  }
  pthread_mutex_unlock(&one.mutex);
}

/// In real time: for a thread that computes beside. One that waits for the cyclic thread sleeps or yields.
constexpr std::int64_t patience = 5 * second;

void advance(std::int64_t to) {
  World& one = world();
  one.now.store(to, std::memory_order_relaxed);
  if (to < one.earliest.load(std::memory_order_relaxed)) {
    return;
  }
  pthread_mutex_lock(&one.mutex);
  wake_all_due(one, to);
  const timespec until = as_timespec(real_time(CLOCK_REALTIME) + patience);
  while (one.awake > 0 && pthread_cond_timedwait(&one.all_wait, &one.mutex, &until) != ETIMEDOUT) {
  }
  pthread_mutex_unlock(&one.mutex);
}

std::list<Sleeper>::iterator lie_down(World& one, Sleeper sleeper) {
  const std::int64_t quantum = one.quantum.load();
  if (quantum > 0) {
    sleeper.until = (sleeper.until / quantum + 1) * quantum;
  }
  if (std::exchange(participant.is_counted, false)) {
    --one.awake;
  }
  one.sleepers.push_back(sleeper);
  pthread_cond_signal(&one.all_wait);
  one.earliest.store(std::min(one.earliest.load(), sleeper.until));
  return std::prev(one.sleepers.end());
}

void get_up(World& one, std::list<Sleeper>::iterator sleeper) {
  participant.is_counted = sleeper->is_due;  // who was woken by another thread is not waited for
  one.sleepers.erase(sleeper);
}

void sleep_beside(std::int64_t duration) {
  World& one = world();
  if (!one.passes.load()) {
    const timespec shortly = as_timespec(std::min<std::int64_t>(duration, 1'000'000));
    (void)::syscall(SYS_nanosleep, &shortly, nullptr);
    // Nobody else makes time pass, and who waits for a time must not wait for ever.
    one.now.fetch_add(one.sleepers.empty() ? duration : 0);
    return;
  }
  pthread_mutex_lock(&one.mutex);
  const auto own = lie_down(one, {.until = one.now.load() + duration});
  while (!own->is_due && one.passes.load()) {
    pthread_cond_wait(&one.woken, &one.mutex);
  }
  get_up(one, own);
  pthread_mutex_unlock(&one.mutex);
}

/// As pthread_cond_clockwait on the monotonic clock.
int wait_beside(pthread_cond_t* condition, pthread_mutex_t* mutex, std::int64_t until) {
  World& one = world();
  if (one.now.load() >= until) {
    return ETIMEDOUT;
  }
  if (!one.passes.load()) {
    const timespec shortly = as_timespec(real_time(CLOCK_REALTIME) + 1'000'000);
    one.now.fetch_add(pthread_cond_timedwait(condition, mutex, &shortly) == ETIMEDOUT ? 1'000'000 : 0);
    return one.now.load() >= until ? ETIMEDOUT : 0;
  }
  pthread_mutex_lock(&one.mutex);
  const auto own = lie_down(one, {.until = until, .condition = condition, .its_mutex = mutex});
  pthread_mutex_unlock(&one.mutex);
  pthread_cond_wait(condition, mutex);
  // Given up for a moment: who wakes sleepers holds the world and then asks for this mutex.
  pthread_mutex_unlock(mutex);
  pthread_mutex_lock(&one.mutex);
  get_up(one, own);
  pthread_mutex_unlock(&one.mutex);
  pthread_mutex_lock(mutex);
  return one.now.load() >= until ? ETIMEDOUT : 0;
}

/// Who yields waits for another thread, be it the cyclic one: until it sleeps again it is not waited for.
void yield_beside() {
  World& one = world();
  if (std::exchange(participant.is_counted, false)) {
    pthread_mutex_lock(&one.mutex);
    --one.awake;
    pthread_cond_signal(&one.all_wait);
    pthread_mutex_unlock(&one.mutex);
  }
}

/// The first cycle waits until all threads are there.
void begin_to_pass(World& one) {
  pthread_mutex_lock(&one.mutex);
  one.passes = true;
  const timespec until = as_timespec(real_time(CLOCK_REALTIME) + patience);
  while (one.sleepers.size() < one.expected && pthread_cond_timedwait(&one.all_wait, &one.mutex, &until) != ETIMEDOUT) {
  }
  pthread_mutex_unlock(&one.mutex);
}

void sleep_cyclic(std::int64_t until) {
  World& one = world();
  if (!one.passes.load(std::memory_order_relaxed) && !one.is_over.load(std::memory_order_relaxed)) {
    begin_to_pass(one);
  }
  const std::int64_t wake = one.at_wake ? one.at_wake(until) : until;
  if (wake > one.now.load(std::memory_order_relaxed)) {
    advance(wake);
  }
}

}  // namespace

void SimulatedTime::begin(std::int64_t now, std::int64_t utc_ahead) {
  World& one = world();
  one.now = now;
  one.utc_ahead = utc_ahead;
  one.is_on = true;
}

std::int64_t SimulatedTime::now() noexcept {
  return world().now.load(std::memory_order_relaxed);
}

void SimulatedTime::set_utc_ahead(std::int64_t nanoseconds) noexcept {
  world().utc_ahead = nanoseconds;
}

std::int64_t SimulatedTime::utc() noexcept {
  return now() + world().utc_ahead.load(std::memory_order_relaxed);
}

void SimulatedTime::compute(std::int64_t nanoseconds) noexcept {
  world().now.fetch_add(nanoseconds, std::memory_order_relaxed);
  world().computed.fetch_add(nanoseconds, std::memory_order_relaxed);
}

void SimulatedTime::at_wake(AtWake action) {
  world().at_wake = std::move(action);
}

void SimulatedTime::set_quantum(std::int64_t nanoseconds) noexcept {
  world().quantum = nanoseconds;
}

void SimulatedTime::expect(int threads) noexcept {
  world().expected = static_cast<std::size_t>(threads);
}

void SimulatedTime::let_go() noexcept {
  World& one = world();
  pthread_mutex_lock(&one.mutex);
  one.is_over = true;
  one.passes = false;
  wake_all_due(one, never);
  pthread_mutex_unlock(&one.mutex);
}

}  // namespace hysteron::soak

// What is replaced. Names and parameters are those of the C library.
extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using namespace hysteron::soak;
  World& one = world();
  if (!one.is_on.load(std::memory_order_relaxed)) {
    return static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  }
  switch (clock) {
    case CLOCK_REALTIME:
    case CLOCK_REALTIME_COARSE:
      *time = as_timespec(SimulatedTime::utc());
      return 0;
    case CLOCK_THREAD_CPUTIME_ID:
      *time = as_timespec(one.computed.load(std::memory_order_relaxed));
      return 0;
    case CLOCK_MONOTONIC:
    case CLOCK_MONOTONIC_COARSE:
    case CLOCK_MONOTONIC_RAW:
    case CLOCK_BOOTTIME:
      *time = as_timespec(SimulatedTime::now());
      return 0;
    default:
      return static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  }
}

time_t time(time_t* into) noexcept {
  timespec now{};
  (void)clock_gettime(CLOCK_REALTIME, &now);
  if (into != nullptr) {
    *into = now.tv_sec;
  }
  return now.tv_sec;
}

int gettimeofday(timeval* into, void* /*zone*/) noexcept {
  timespec now{};
  (void)clock_gettime(CLOCK_REALTIME, &now);
  *into = {.tv_sec = now.tv_sec, .tv_usec = now.tv_nsec / 1000};
  return 0;
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* request, timespec* rest) {
  using namespace hysteron::soak;
  if (!world().is_on.load(std::memory_order_relaxed) || (flags & TIMER_ABSTIME) == 0) {
    return ::syscall(SYS_clock_nanosleep, clock, flags, request, rest) == 0 ? 0 : errno;
  }
  sleep_cyclic(in_nanoseconds(*request));
  return 0;
}

int nanosleep(const timespec* request, timespec* rest) {
  using namespace hysteron::soak;
  if (!world().is_on.load(std::memory_order_relaxed)) {
    return static_cast<int>(::syscall(SYS_nanosleep, request, rest));
  }
  sleep_beside(in_nanoseconds(*request));
  return 0;
}

/// What is done beside the cycle takes no time here, and so must not wait for other programs of this machine.
int setpriority(__priority_which_t /*which*/, id_t /*who*/, int /*priority*/) noexcept {
  return 0;
}

int sched_yield() noexcept {
  hysteron::soak::yield_beside();
  return static_cast<int>(::syscall(SYS_sched_yield));
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* until) {
  using namespace hysteron::soak;
  if (!world().is_on.load(std::memory_order_relaxed) || clock != CLOCK_MONOTONIC) {
    using Function = int (*)(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);
    static const auto original = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "pthread_cond_clockwait"));
    return original(condition, mutex, clock, until);
  }
  return wait_beside(condition, mutex, in_nanoseconds(*until));
}
}
