// hysteron doctor --rt: each thing that makes a task late is found where it is, and is gone where it was mended.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.hpp"
#include "tests/tool/workbench.hpp"
#include "tool/jitter.hpp"
#include "tool/processor_list.hpp"
#include "tool/realtime_host.hpp"

namespace hysteron::tool {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Tree = std::map<std::string, std::string>;  ///< texts by path

/// A machine of four processors on which nothing is left to mend: 3 is the task's.
Tree good_machine() {
  Tree tree{
      {"proc/sys/kernel/osrelease", "6.1.0-18-rt-amd64"},
      {"proc/version", "Linux version 6.1.0-18-rt-amd64 (gcc) #1 SMP PREEMPT_RT Debian 6.1.76-1"},
      {"sys/kernel/realtime", "1"},
      {"proc/sys/kernel/sched_rt_runtime_us", "-1"},
      {"proc/sys/kernel/sched_rt_period_us", "1000000"},
      {"sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc"},
      {"sys/devices/system/clocksource/clocksource0/available_clocksource", "tsc hpet acpi_pm"},
      {"sys/devices/system/cpu/isolated", "3"},
      {"sys/devices/system/cpu/nohz_full", "3"},
      {"proc/irq/24/smp_affinity_list", "0-2"},
      {"proc/irq/25/smp_affinity_list", "0-3"},
      {"proc/irq/25/effective_affinity_list", "1"},
      {"proc/self/limits",
       "Limit                     Soft Limit           Hard Limit           Units\n"
       "Max locked memory         unlimited            unlimited            bytes\n"
       "Max realtime priority     99                   99\n"},
      {"proc/self/status", "Name:\tcat\nCapEff:\t0000000000000000\n"},
  };
  for (int cpu = 0; cpu < 4; ++cpu) {
    const std::string folder = fmt::format("sys/devices/system/cpu/cpu{}/", cpu);
    tree[folder + "cpufreq/scaling_governor"] = cpu == 3 ? "performance" : "powersave";
    tree[folder + "cpuidle/state0/name"] = "POLL";
    tree[folder + "cpuidle/state0/latency"] = "0";
    tree[folder + "cpuidle/state1/name"] = "C6";
    tree[folder + "cpuidle/state1/latency"] = "133";
    tree[folder + "cpuidle/state1/disable"] = cpu == 3 ? "1" : "0";
  }
  return tree;
}

std::vector<HostFinding> findings_of(const Tree& tree, HostQuestion question = {}) {
  const hysteron::test::ScratchFolder folder;
  for (const auto& [path, text] : tree) {
    std::filesystem::create_directories((folder.path() / path).parent_path());
    (void)folder.write(path, text + "\n");
  }
  question.root = folder.path();
  return look_at_host(question);
}

std::set<std::string> not_good(const std::vector<HostFinding>& findings) {
  std::set<std::string> names;
  for (const HostFinding& one : findings) {
    if (one.rating != Rating::good) {
      names.insert(one.name);
      EXPECT_NE(one.why, "") << one.name;
    } else {
      EXPECT_EQ(one.why + one.command, "") << one.name;
    }
  }
  return names;
}

HostFinding finding(const Tree& tree, const std::string& name, const HostQuestion& question = {}) {
  for (const HostFinding& one : findings_of(tree, question)) {
    if (one.name == name) {
      return one;
    }
  }
  ADD_FAILURE() << name;
  return {};
}

/// One file of the good machine is another: one finding, with what it is and what to type.
struct Mutation {
  std::string path;
  std::string text;
  std::string finding;
  Rating rating;
  std::string found;
  std::string command;
};

TEST(RealtimeHost, EachFindingComesWithItsCauseAndGoesWithIt) {
  const std::string cpu = "sys/devices/system/cpu/";
  const std::vector<Mutation> mutations{
      {cpu + "cpu3/cpufreq/scaling_governor", "ondemand", "governor", Rating::bad, "ondemand on 3",
       "for i in 3; do echo performance > /sys/devices/system/cpu/cpu$i/cpufreq/scaling_governor; done"},
      {cpu + "cpu3/cpuidle/state1/disable", "0", "idle states", Rating::bad, "C6, 133 us to wake on 3",
       "for i in 3; do echo 1 > /sys/devices/system/cpu/cpu$i/cpuidle/state1/disable; done"},
      {"proc/irq/24/smp_affinity_list", "0-3", "interrupts", Rating::bad, "1 on 3: 24",
       "for i in 24; do echo 0-2 > /proc/irq/$i/smp_affinity_list; done"},
      {"proc/irq/25/effective_affinity_list", "3", "interrupts", Rating::bad, "1 on 3: 25",
       "systemctl disable --now irqbalance"},
      {cpu + "nohz_full", "", "isolated processors", Rating::improvable, "3, with a tick", "nohz_full=3"},
      {"proc/sys/kernel/sched_rt_runtime_us", "950000", "throttling", Rating::improvable, "950000 us of 1000000 us",
       "sysctl -w kernel.sched_rt_runtime_us=-1"},
      {"sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet", "clock source", Rating::bad, "hpet",
       "echo tsc > /sys/devices/system/clocksource/clocksource0/current_clocksource"},
      {"proc/self/limits", "Max locked memory   65536   65536   bytes\nMax realtime priority   99   99",
       "locked memory", Rating::bad, "65536 bytes", "LimitMEMLOCK=infinity"},
      {"proc/self/limits", "Max locked memory   unlimited   65536   bytes\nMax realtime priority   0   0",
       "real-time priority", Rating::bad, "up to 0", "LimitRTPRIO=80"},
  };
  EXPECT_EQ(not_good(findings_of(good_machine())), std::set<std::string>());
  for (const Mutation& one : mutations) {
    Tree tree = good_machine();
    tree[one.path] = one.text;
    EXPECT_EQ(not_good(findings_of(tree)), std::set{one.finding}) << one.path;
    const HostFinding found = finding(tree, one.finding);
    EXPECT_EQ(found.rating, one.rating) << one.path;
    EXPECT_THAT(found.found, HasSubstr(one.found)) << one.path;
    EXPECT_THAT(found.command, HasSubstr(one.command)) << one.path;
    tree[one.path] = good_machine()[one.path];
    EXPECT_EQ(not_good(findings_of(tree)), std::set<std::string>()) << one.path;
  }
}

TEST(RealtimeHost, ThePreemptionModelIsReadWhereverItStands) {
  Tree tree = good_machine();
  tree.erase("sys/kernel/realtime");
  EXPECT_EQ(finding(tree, "preemption").rating, Rating::good) << "the version says it, too";
  const std::map<std::string, std::pair<Rating, std::string>> versions{
      {"SMP PREEMPT_DYNAMIC Debian", {Rating::improvable, "chosen at run time; which, root alone can read"}},
      {"SMP PREEMPT Debian", {Rating::improvable, "full"}},
      {"SMP Debian", {Rating::bad, "none or voluntary"}}};
  for (const auto& [version, expected] : versions) {
    tree["proc/version"] = "Linux version 6.1 #1 " + version;
    EXPECT_EQ(finding(tree, "preemption").rating, expected.first) << version;
    EXPECT_EQ(finding(tree, "preemption").found, expected.second) << version;
  }
  tree["sys/kernel/debug/sched/preempt"] = "none (voluntary) full";
  EXPECT_EQ(finding(tree, "preemption").rating, Rating::bad);
  EXPECT_THAT(finding(tree, "preemption").command, HasSubstr("echo full > /sys/kernel/debug/sched/preempt"));
  tree["sys/kernel/debug/sched/preempt"] = "none voluntary (full)";
  EXPECT_EQ(finding(tree, "preemption").rating, Rating::improvable);
  EXPECT_EQ(finding(tree, "preemption").found, "full, chosen at run time");
}

/// A right stands in for a limit, bit by bit.
TEST(RealtimeHost, CapabilitiesCountForLimits) {
  Tree tree = good_machine();
  tree["proc/self/limits"] = "Max locked memory   65536   65536   bytes\nMax realtime priority   0   0";
  EXPECT_EQ(not_good(findings_of(tree)), (std::set<std::string>{"locked memory", "real-time priority"}));
  tree["proc/self/status"] = "CapEff:\t0000000000004000";
  EXPECT_EQ(not_good(findings_of(tree)), (std::set<std::string>{"real-time priority"}));
  tree["proc/self/status"] = "CapEff:\t0000000000800000";
  EXPECT_EQ(not_good(findings_of(tree)), (std::set<std::string>{"locked memory"}));
  tree["proc/self/status"] = "CapEff:\t000001ffffffffff";
  EXPECT_EQ(not_good(findings_of(tree)), std::set<std::string>());
}

TEST(RealtimeHost, AnotherProcessorIsNotIsolated) {
  EXPECT_EQ(not_good(findings_of(good_machine(), {.processor = 1})),
            (std::set<std::string>{"governor", "idle states", "isolated processors", "interrupts"}));
  Tree tree = good_machine();
  tree["sys/devices/system/cpu/isolated"] = "";
  const auto all = finding(tree, "governor");
  EXPECT_EQ(all.found, "performance on 3; powersave on 0-2") << "a task may run on any";
  EXPECT_THAT(all.command, HasSubstr("for i in 0 1 2; do"));
}

/// What is isolated stays isolated: in both lists, and kept from interrupts.
TEST(RealtimeHost, AMendKeepsWhatIsIsolated) {
  Tree tree = good_machine();
  tree["sys/devices/system/cpu/isolated"] = "2-3";
  tree["sys/devices/system/cpu/nohz_full"] = "(null)";
  tree["proc/irq/24/smp_affinity_list"] = "0-3";
  const HostFinding ticking = finding(tree, "isolated processors");
  EXPECT_EQ(ticking.found, "2-3, with a tick");
  EXPECT_THAT(ticking.command, HasSubstr("isolcpus=managed_irq,domain,2-3 nohz_full=2-3 rcu_nocbs=2-3 "));
  EXPECT_THAT(ticking.command, HasSubstr("processor = 2 under [task]"));
  EXPECT_THAT(finding(tree, "interrupts").command, HasSubstr("echo 0-1 > /proc/irq/$i/smp_affinity_list"));
  EXPECT_THAT(finding(tree, "isolated processors", {.processor = 1}).command, HasSubstr("domain,1-3 nohz_full=1-3"));
  // One processor is left to everything else.
  tree["sys/devices/system/cpu/isolated"] = "1-3";
  const HostFinding last = finding(tree, "isolated processors", {.processor = 0});
  EXPECT_EQ(last.command, "");
  EXPECT_THAT(last.why, HasSubstr("No other processor is left"));
}

/// The command for GRUB is typed: on a line without lists, and on one that has lists already.
TEST(RealtimeHost, TheKernelsLineHasEachListOnce) {
  Tree tree = good_machine();
  tree["sys/devices/system/cpu/isolated"] = "2-3";
  tree["sys/devices/system/cpu/nohz_full"] = "";
  const std::string command = finding(tree, "isolated processors").command;
  const std::string sed = command.substr(0, command.find(" /etc/default/grub"));
  const test::Workbench bench;
  bench.write("grub",
              "GRUB_CMDLINE_LINUX_DEFAULT=\"quiet nohz_full=2-3\"\n"
              "GRUB_CMDLINE_LINUX=\"isolcpus=2-3 rcu_nocbs=2 net.ifnames=0\"\n");
  for (int time = 0; time < 2; ++time) {
    const auto typed = bench.shell(sed + " grub && cat grub");
    EXPECT_EQ(typed.code, 0) << typed.err;
    EXPECT_EQ(typed.out,
              "GRUB_CMDLINE_LINUX_DEFAULT=\"quiet \"\n"
              "GRUB_CMDLINE_LINUX=\"isolcpus=managed_irq,domain,2-3 nohz_full=2-3 rcu_nocbs=2-3 net.ifnames=0\"\n");
  }
}

TEST(RealtimeHost, AProcessorThatIsOffIsNone) {
  Tree tree = good_machine();
  tree["sys/devices/system/cpu/online"] = "0-1,3";
  tree["proc/irq/24/smp_affinity_list"] = "0-3";
  EXPECT_THAT(finding(tree, "interrupts").command, HasSubstr("echo 0-1 > "));
}

/// Nothing that cannot be read is called good, or bad, or none.
TEST(RealtimeHost, WhatCannotBeReadIsUnknown) {
  for (const HostFinding& one : findings_of({})) {
    EXPECT_EQ(one.rating, Rating::unknown) << one.name;
    EXPECT_EQ(one.found, "not told") << one.name;
    EXPECT_THAT(one.why, HasSubstr(" be read.")) << one.name;
    EXPECT_EQ(one.command, "") << one.name;
  }
  EXPECT_EQ(finding({{"proc/sys/kernel/osrelease", "6.1"}}, "kernel").found, "6.1");
}

TEST(RealtimeHost, ListsOfProcessors) {
  EXPECT_THAT(parse_processors("0-2,5\n").value(), ElementsAre(0, 1, 2, 5));
  EXPECT_THAT(parse_processors("").value(), ElementsAre());
  for (const char* const wrong : {"a", "1-", "2-1", "1,,x", "0-99999999999", "-"}) {
    EXPECT_FALSE(parse_processors(wrong)) << wrong;
  }
  EXPECT_EQ(processors_text({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
}

/// Wakes as late as the script says, in nanoseconds, one sleep after the other.
class LateClock final : public runtime::Clock {
 public:
  explicit LateClock(std::vector<std::int64_t> late) : late_(std::move(late)) {}
  [[nodiscard]] std::int64_t now() noexcept override { return now_; }
  void sleep_until(std::int64_t time) noexcept override {
    now_ = std::max(now_, time + (next_ < late_.size() ? late_[next_] : 0));
    ++next_;
  }
  [[nodiscard]] std::int64_t own_cpu() noexcept override { return 0; }
  [[nodiscard]] std::int64_t stolen() noexcept override { return 0; }

 private:
  std::vector<std::int64_t> late_;
  std::size_t next_ = 0;
  std::int64_t now_ = 0;
};

TEST(Jitter, EveryWakeUpIsInTheClassOfItsLateness) {
  LateClock clock({0, 999, 1'000, 4'999, 5'000, 2'300'000, 0});
  const Jitter jitter = measure_jitter({.period = 1'000'000, .cycles = 7, .scheduling = {.lock_memory = false}}, clock);
  std::map<std::int64_t, std::uint64_t> counts;
  for (const JitterClass& one : jitter.classes) {
    if (one.count > 0) {
      counts[one.below] = one.count;
    }
  }
  EXPECT_EQ(counts,
            (std::map<std::int64_t, std::uint64_t>{{1'000, 3}, {2'000, 1}, {5'000, 1}, {10'000, 1}, {5'000'000, 1}}));
  EXPECT_EQ(jitter.classes.back().below, 5'000'000) << "none that is empty at the end";
  EXPECT_EQ(jitter.lateness.worst(), 2'300'000) << "behind its own time, not behind the newest period";
  EXPECT_EQ(jitter.skipped, 2U);
  EXPECT_EQ(jitter.lateness.count(), 7U);
}

TEST(DoctorCommand, SaysWhatToType) {
  const test::Workbench bench;
  for (auto [path, text] : good_machine()) {
    bench.write("good/" + path, text + "\n");
    bench.write("slow/" + path, (path.ends_with("cpu3/cpufreq/scaling_governor") ? "powersave" : text) + "\n");
  }
  const auto good = bench.shell("hysteron doctor --rt --root good");
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_THAT(good.out, AllOf(HasSubstr("good        kernel               6.1.0-18-rt-amd64\n"), Not(HasSubstr("$ "))));
  const auto slow = bench.shell("hysteron doctor --rt --root slow");
  EXPECT_EQ(slow.code, 1) << slow.err;
  EXPECT_THAT(slow.out, HasSubstr("bad         governor             powersave on 3\n"));
  EXPECT_THAT(slow.out, HasSubstr("                                 $ for i in 3; do echo performance > "));
  const auto json = nlohmann::json::parse(bench.shell("hysteron doctor --rt --root slow --json").out);
  EXPECT_EQ(json.at("findings").size(), 10U);
  EXPECT_TRUE(json.at("jitter").is_null());
  // A measurement of this machine, short.
  const auto measured = nlohmann::json::parse(bench.shell("hysteron doctor --rt --seconds 0.05 --json").out);
  EXPECT_EQ(measured.at("jitter").at("cycles"), 50);
  std::uint64_t sum = 0;
  for (const auto& one : measured.at("jitter").at("classes")) {
    sum += one.at("count").get<std::uint64_t>();
  }
  EXPECT_EQ(sum, 50U);
  // What cannot be looked at, or measured, is refused.
  bench.write("empty/note.txt", "");
  for (const auto& [options, cause] : std::map<std::string, std::string>{
           {"--root nowhere", "--root nowhere: there is neither a folder proc nor a folder sys in it."},
           {"--root empty", "--root empty: there is neither a folder proc nor a folder sys in it."},
           {"--root empty/note.txt", "--root empty/note.txt: there is neither a folder proc nor a folder sys in it."},
           {"--root good --processor 9", "--processor 9: the processors of this machine are 0-3."},
           {"--processor 1023", "--processor 1023: the processors of this machine are 0"},
           {"--seconds nan", "hysteron doctor: --seconds: a number from 0 to 86400 is needed, not nan."},
           {"--seconds inf", "hysteron doctor: --seconds: a number from 0 to 86400 is needed, not inf."},
           {"--seconds 0.0001", "--seconds 0.0001 is shorter than one period of 1ms: nothing would be measured."}}) {
    const auto refused = bench.shell("timeout 20 hysteron doctor --rt " + options);
    EXPECT_EQ(refused.code, 2) << options;
    EXPECT_EQ(refused.out, "") << options;
    EXPECT_THAT(refused.err, testing::StartsWith("HY730 error: " + cause)) << options;
  }
  EXPECT_THAT(bench.shell("hysteron doctor").err,
              testing::StartsWith("HY730 error: The doctor was not asked anything."));
  EXPECT_THAT(bench.shell("hysteron doctor --rt --period 1").err,
              testing::StartsWith("HY730 error: --period does not"));
}

}  // namespace
}  // namespace hysteron::tool
