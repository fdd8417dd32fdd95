#include "tool/realtime_host.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <system_error>

#include "support/whole_number.hpp"
#include "tool/processor_list.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

/// Out of a state of deeper sleep a processor needs longer than this, in microseconds, which a task of 1 ms feels.
constexpr std::uint64_t longest_wake = 10;
constexpr unsigned lock_memory_right = 14;  ///< CAP_IPC_LOCK, of capabilities(7)
constexpr unsigned nice_right = 23;         ///< CAP_SYS_NICE

/// The first line of a file without its end; nothing where it cannot be read.
std::optional<std::string> line_of(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  return std::getline(file, line) ? std::optional(line) : std::nullopt;
}

/// What stands behind a key at the begin of its line; empty where no line begins so, or none can be read.
std::string behind_key(const fs::path& path, std::string_view key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(key)) {
      return line.substr(key.size());
    }
  }
  return "";
}

/// Of a file that holds a list of processors; empty where it does not.
std::vector<unsigned> processors_in(const fs::path& path) {
  return parse_processors(line_of(path).value_or("")).value_or(std::vector<unsigned>());
}

/// The numbers of entries as cpu0, cpu1 or 24, 25 in a folder, sorted; empty where there is none.
std::vector<unsigned> numbered(const fs::path& folder, std::string_view prefix) {
  std::vector<unsigned> numbers;
  std::error_code none;
  for (fs::directory_iterator next(folder, none), end; !none && next != end; next.increment(none)) {
    const std::string name = next->path().filename().string();
    const auto number = name.starts_with(prefix)
                            ? whole_number<std::uint64_t>(std::string_view(name).substr(prefix.size()))
                            : std::nullopt;
    if (number) {
      numbers.push_back(static_cast<unsigned>(*number));
    }
  }
  std::ranges::sort(numbers);
  return numbers;
}

std::vector<unsigned> joined(const std::vector<unsigned>& some, const std::vector<unsigned>& others) {
  std::set<unsigned> all(some.begin(), some.end());
  all.insert(others.begin(), others.end());
  return {all.begin(), all.end()};
}

class Host {
 public:
  explicit Host(const HostQuestion& question)
      : root_(question.root),
        priority_(question.priority),
        cpu_(root_ / "sys/devices/system/cpu"),
        isolated_(processors_in(cpu_ / "isolated")),
        processor_(question.processor  ? question.processor
                   : isolated_.empty() ? std::nullopt
                                       : std::optional(isolated_.front())),
        all_(processors_of(root_)) {}

  [[nodiscard]] std::vector<HostFinding> findings() const {
    return {kernel(),      preemption(), throttling(), clock_source(), governor(),
            idle_states(), isolation(),  interrupts(), memory_lock(),  priority()};
  }

 private:
  [[nodiscard]] HostFinding kernel() const {
    const auto release = line_of(root_ / "proc/sys/kernel/osrelease");
    return release ? HostFinding{.name = "kernel", .found = *release}
                   : not_told("kernel", "/proc/sys/kernel/osrelease cannot be read.");
  }

  /// PREEMPT_RT says so in a file of its own and in the version; PREEMPT_DYNAMIC has its model in debugfs, for root.
  [[nodiscard]] HostFinding preemption() const {
    HostFinding finding{.name = "preemption"};
    const std::string version = line_of(root_ / "proc/version").value_or("");
    const bool is_realtime =
        line_of(root_ / "sys/kernel/realtime").value_or("") == "1" || version.find("PREEMPT_RT") != std::string::npos;
    if (is_realtime) {
      finding.found = "real-time (PREEMPT_RT)";
      return finding;
    }
    finding.rating = Rating::improvable;
    finding.why =
        "A kernel without PREEMPT_RT holds a task up where it does work of its own, for milliseconds at worst.";
    finding.command = "apt-get install linux-image-rt-amd64   # or the PREEMPT_RT kernel of your distribution";
    // "none voluntary (full)": the one in parentheses counts.
    const std::string models = line_of(root_ / "sys/kernel/debug/sched/preempt").value_or("");
    const auto begin = models.find('(');
    if (begin != std::string::npos) {
      finding.found = models.substr(begin + 1, models.find(')', begin) - begin - 1) + ", chosen at run time";
      if (finding.found.starts_with("none") || finding.found.starts_with("voluntary")) {
        finding.rating = Rating::bad;
        finding.command +=
            "\necho full > /sys/kernel/debug/sched/preempt   # until the next start; preempt=full for ever";
      }
    } else if (version.find("PREEMPT_DYNAMIC") != std::string::npos) {
      finding.found = "chosen at run time; which, root alone can read";
      finding.command += "\ncat /sys/kernel/debug/sched/preempt   # full is best";
    } else if (version.find("PREEMPT") != std::string::npos) {
      finding.found = "full";
    } else if (!version.empty()) {
      finding.found = "none or voluntary";
      finding.rating = Rating::bad;
    } else {
      return not_told("preemption", "/proc/version cannot be read.");
    }
    return finding;
  }

  [[nodiscard]] HostFinding throttling() const {
    const auto runtime = line_of(root_ / "proc/sys/kernel/sched_rt_runtime_us");
    if (!runtime) {
      return not_told("throttling", "/proc/sys/kernel/sched_rt_runtime_us cannot be read.");
    }
    if (*runtime == "-1") {
      return {.name = "throttling", .found = "off"};
    }
    const std::string period = line_of(root_ / "proc/sys/kernel/sched_rt_period_us").value_or("1000000");
    return {.name = "throttling",
            .found = fmt::format("real-time threads run {} us of {} us", *runtime, period),
            .rating = Rating::improvable,
            .why =
                "A task that computes for longer in a row is stopped for the rest. One that sleeps in each period "
                "never is.",
            .command = "sysctl -w kernel.sched_rt_runtime_us=-1   # only where no other real-time program may hang"};
  }

  [[nodiscard]] HostFinding clock_source() const {
    const fs::path folder = root_ / "sys/devices/system/clocksource/clocksource0";
    const auto source = line_of(folder / "current_clocksource");
    if (!source) {
      return not_told("clock source", "/sys/devices/system/clocksource cannot be read.");
    }
    // Those that a program reads without a call to the kernel.
    static const std::set<std::string, std::less<>> quick{"tsc", "kvm-clock", "hyperv_clocksource_tsc_page",
                                                          "arch_sys_counter", "riscv_clocksource"};
    if (quick.contains(*source)) {
      return {.name = "clock source", .found = *source};
    }
    const std::string available = line_of(folder / "available_clocksource").value_or("");
    std::istringstream words(available);
    const auto better = std::find_if(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>(),
                                     [](const std::string& word) { return quick.contains(word); });
    const bool has_better = better != std::istream_iterator<std::string>();
    return {.name = "clock source",
            .found = *source,
            .rating = has_better ? Rating::bad : Rating::improvable,
            .why = "Each look at the time is a call to the kernel, of a microsecond and more.",
            .command =
                has_better
                    ? fmt::format("echo {} > /sys/devices/system/clocksource/clocksource0/current_clocksource", *better)
                    : ""};
  }

  /// Of a thing that /sys tells by processors, where it names none.
  static HostFinding without_processors(const std::string& name) {
    return not_told(name, "/sys/devices/system/cpu cannot be read.");
  }

  [[nodiscard]] HostFinding governor() const {
    if (all_.empty()) {
      return without_processors("governor");
    }
    std::map<std::string, std::vector<unsigned>> of;
    for (const unsigned cpu : looked_at()) {
      if (const auto one = line_of(cpu_ / fmt::format("cpu{}/cpufreq/scaling_governor", cpu))) {
        of[*one].push_back(cpu);
      }
    }
    if (of.empty()) {
      return {.name = "governor",
              .found = "none",
              .rating = Rating::unknown,
              .why =
                  "The kernel does not steer the clock of the processor: firmware or a hypervisor may. See there "
                  "that power saving is off."};
    }
    std::vector<unsigned> slow;
    for (const auto& [name, processors] : of) {
      if (name != "performance") {
        slow.insert(slow.end(), processors.begin(), processors.end());
      }
    }
    std::ranges::sort(slow);
    return {.name = "governor",
            .found = by_processors(of),
            .rating = slow.empty() ? Rating::good : Rating::bad,
            .why = slow.empty()
                       ? ""
                       : "After a sleep the processor is slow at first, and a step takes several times as long.",
            .command = slow.empty() ? "" : each(slow, "performance", "cpufreq/scaling_governor")};
  }

  /// The deepest state that is on counts.
  [[nodiscard]] HostFinding idle_states() const {
    if (all_.empty()) {
      return without_processors("idle states");
    }
    std::map<std::string, std::vector<unsigned>> of;
    std::set<unsigned> states;
    std::vector<unsigned> deep;
    bool is_any = false;
    for (const unsigned cpu : looked_at()) {
      const fs::path folder = cpu_ / fmt::format("cpu{}/cpuidle", cpu);
      std::uint64_t deepest = 0;
      std::string name;
      for (const unsigned state : numbered(folder, "state")) {
        const fs::path one = folder / fmt::format("state{}", state);
        const auto latency = whole_number<std::uint64_t>(line_of(one / "latency").value_or(""));
        is_any = is_any || latency.has_value();
        if (!latency || line_of(one / "disable").value_or("0") != "0") {
          continue;
        }
        if (*latency > longest_wake) {
          states.insert(state);
        }
        if (*latency >= deepest) {
          deepest = *latency;
          name = fmt::format("{}, {} us to wake", line_of(one / "name").value_or("?"), *latency);
        }
      }
      if (deepest > longest_wake) {
        deep.push_back(cpu);
      }
      if (!name.empty()) {
        of[name].push_back(cpu);
      }
    }
    if (!is_any) {
      return {.name = "idle states",
              .found = "none",
              .rating = Rating::unknown,
              .why = "The kernel puts the processor into no states of sleep: firmware or a hypervisor may."};
    }
    HostFinding finding{.name = "idle states", .found = by_processors(of)};
    if (!deep.empty()) {
      finding.rating = Rating::bad;
      finding.why = "A processor that sleeps deeper wakes later, and the task with it.";
      for (const unsigned state : states) {
        finding.command +=
            (finding.command.empty() ? "" : "\n") + each(deep, "1", fmt::format("cpuidle/state{}/disable", state));
      }
    }
    return finding;
  }

  [[nodiscard]] HostFinding isolation() const {
    if (all_.empty()) {
      return without_processors("isolated processors");
    }
    const unsigned wanted = processor_.value_or(all_.back());
    const auto quiet = processors_in(cpu_ / "nohz_full");
    // Those that are isolated stay so. Of two lists on the kernel's line one counts: what stands there is taken out.
    const std::vector<unsigned> kept = joined(isolated_, {wanted});
    const std::vector<unsigned> ticking = joined(kept, quiet);
    const bool is_one_left = ticking.size() < all_.size();
    const std::string line =
        is_one_left ? fmt::format(
                          "sed -i -E '/^GRUB_CMDLINE_LINUX/s/(isolcpus|nohz_full|rcu_nocbs)=[^ \"\\x27]* ?//g; "
                          "s/^GRUB_CMDLINE_LINUX=\"/&isolcpus=managed_irq,domain,{0} nohz_full={1} rcu_nocbs={1} /' "
                          "/etc/default/grub && update-grub && reboot   # and processor = {2} under [task]",
                          processors_text(kept), processors_text(ticking), wanted)
                    : "";
    if (isolated_.empty() || (processor_ && std::ranges::find(isolated_, *processor_) == isolated_.end())) {
      const bool is_single = all_.size() < 2;
      return {
          .name = "isolated processors",
          .found = isolated_.empty() ? "none" : fmt::format("{}, and not {}", processors_text(isolated_), *processor_),
          .rating = Rating::improvable,
          .why = is_single ? "The machine has one processor, which the task shares with everything else."
                 : is_one_left
                     ? "Other programs and the kernel's own work run on the task's processor."
                     : "No other processor is left for other programs and the kernel's own work: let the task keep to "
                       "one that is isolated.",
          .command = line};
    }
    const bool is_quiet = std::ranges::find(quiet, wanted) != quiet.end();
    return {
        .name = "isolated processors",
        .found = processors_text(isolated_) + (is_quiet ? ", without a tick" : ", with a tick"),
        .rating = is_quiet ? Rating::good : Rating::improvable,
        .why = is_quiet ? "" : "The kernel's tick interrupts the task 100 to 1000 times a second, for microseconds.",
        .command = is_quiet ? "" : line};
  }

  /// Interrupts that the task's processor may get, and that another could.
  [[nodiscard]] HostFinding interrupts() const {
    const fs::path folder = root_ / "proc/irq";
    std::vector<unsigned> there;
    bool is_read = false;
    for (const unsigned number : numbered(folder, "")) {
      const auto on =
          parse_processors(line_of(folder / std::to_string(number) / "effective_affinity_list")
                               .value_or(line_of(folder / std::to_string(number) / "smp_affinity_list").value_or("?")));
      is_read = is_read || on.has_value();
      if (on && (!processor_ ? on->size() > 1 : std::ranges::find(*on, *processor_) != on->end())) {
        there.push_back(number);
      }
    }
    if (!is_read) {
      return not_told("interrupts", "No affinity in /proc/irq can be read.");
    }
    if (!processor_) {
      return {.name = "interrupts",
              .found = there.empty() ? "each on one processor" : fmt::format("{} on any processor", there.size()),
              .rating = Rating::improvable,
              .why = "The task keeps to no processor that interrupts could be kept from: isolate one first."};
    }
    std::vector<unsigned> others;
    std::ranges::copy_if(all_, std::back_inserter(others), [&](unsigned one) {
      return one != *processor_ && std::ranges::find(isolated_, one) == isolated_.end();
    });
    HostFinding finding{.name = "interrupts",
                        .found = there.empty()
                                     ? fmt::format("none on {}", *processor_)
                                     : fmt::format("{} on {}: {}", there.size(), *processor_, processors_text(there))};
    if (!there.empty()) {
      finding.rating = others.empty() ? Rating::improvable : Rating::bad;
      finding.why = "Each of them holds the task up for tens of microseconds.";
      if (!others.empty()) {
        finding.command = fmt::format(
            "systemctl disable --now irqbalance; for i in {}; do echo {} > /proc/irq/$i/smp_affinity_list; done",
            fmt::join(there, " "), processors_text(others));
      }
    }
    return finding;
  }

  [[nodiscard]] HostFinding memory_lock() const {
    const auto limit = limit_of("Max locked memory");
    if (!limit) {
      return unknown_limit("locked memory");
    }
    const bool is_free = *limit == "unlimited" || has_right(lock_memory_right);
    return {.name = "locked memory",
            .found = *limit == "unlimited" ? "no limit"
                     : is_free             ? "the right is there"
                                           : *limit + " bytes",
            .rating = is_free ? Rating::good : Rating::bad,
            .why = is_free ? "" : "A page that was put out to the disk holds a step up for milliseconds.",
            .command = is_free ? ""
                               : "echo 'USER - memlock unlimited' >> /etc/security/limits.conf   # in a unit: "
                                 "LimitMEMLOCK=infinity"};
  }

  [[nodiscard]] HostFinding priority() const {
    const auto limit = limit_of("Max realtime priority");
    if (!limit) {
      return unknown_limit("real-time priority");
    }
    const bool is_allowed =
        has_right(nice_right) || whole_number<std::uint64_t>(*limit).value_or(*limit == "unlimited" ? 99 : 0) >=
                                     static_cast<std::uint64_t>(priority_);
    return {.name = "real-time priority",
            .found = has_right(nice_right) ? "the right is there" : "up to " + *limit,
            .rating = is_allowed ? Rating::good : Rating::bad,
            .why = is_allowed ? ""
                              : fmt::format("SCHED_FIFO with priority {} is refused, and any program may come before "
                                            "the task.",
                                            priority_),
            .command = is_allowed ? ""
                                  : fmt::format("echo 'USER - rtprio {0}' >> /etc/security/limits.conf   # in a unit: "
                                                "LimitRTPRIO={0}",
                                                priority_)};
  }

  static HostFinding unknown_limit(const std::string& name) {
    return not_told(name, "/proc/self/limits cannot be read.");
  }

  static HostFinding not_told(const std::string& name, const std::string& why) {
    return {.name = name, .found = "not told", .rating = Rating::unknown, .why = why};
  }

  /// The soft limit, as /proc/self/limits names it.
  [[nodiscard]] std::optional<std::string> limit_of(std::string_view name) const {
    std::istringstream rest(behind_key(root_ / "proc/self/limits", name));
    std::string soft;
    return rest >> soft ? std::optional(soft) : std::nullopt;
  }

  [[nodiscard]] bool has_right(unsigned right) const {
    std::uint64_t bits = 0;
    std::istringstream(behind_key(root_ / "proc/self/status", "CapEff:")) >> std::hex >> bits;
    return (bits >> right & 1U) != 0;
  }

  /// The task's processor; all where it has none.
  [[nodiscard]] std::vector<unsigned> looked_at() const { return processor_ ? std::vector{*processor_} : all_; }

  static std::string by_processors(const std::map<std::string, std::vector<unsigned>>& of) {
    std::string text;
    for (const auto& [name, processors] : of) {
      text += fmt::format("{}{} on {}", text.empty() ? "" : "; ", name, processors_text(processors));
    }
    return text;
  }

  static std::string each(const std::vector<unsigned>& processors, std::string_view value, const std::string& file) {
    return fmt::format("for i in {}; do echo {} > /sys/devices/system/cpu/cpu$i/{}; done", fmt::join(processors, " "),
                       value, file);
  }

  fs::path root_;
  int priority_;
  fs::path cpu_;
  std::vector<unsigned> isolated_;
  std::optional<unsigned> processor_;
  std::vector<unsigned> all_;
};

}  // namespace

std::string_view name_of(Rating rating) {
  switch (rating) {
    case Rating::good:
      return "good";
    case Rating::unknown:
      return "unknown";
    case Rating::improvable:
      return "improvable";
    case Rating::bad:
      break;
  }
  return "bad";
}

std::vector<HostFinding> look_at_host(const HostQuestion& question) {
  return Host(question).findings();
}

std::vector<unsigned> processors_of(const fs::path& root) {
  const fs::path folder = root / "sys/devices/system/cpu";
  const auto online = processors_in(folder / "online");
  return online.empty() ? numbered(folder, "cpu") : online;
}

}  // namespace hysteron::tool
