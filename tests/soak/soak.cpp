// The long counts of the runtime, as rows of a Markdown table: `soak [PART] [ROW]...`
#include <array>
#include <bit>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <random>
#include <thread>

#include "runtime/task/task.hpp"
#include "tests/runtime/history/history_kill.hpp"
#include "tests/runtime/host/many_changes.hpp"
#include "tests/runtime/modbus/bad_device.hpp"
#include "tests/runtime/modbus/exact_answers.hpp"
#include "tests/runtime/mqtt/outbox_kill.hpp"
#include "tests/runtime/task/dying_task.hpp"
#include "tests/runtime/task/linked_sets.hpp"
#include "tests/runtime/task/retain_kill.hpp"
#include "tests/runtime/task/scripted_loop.hpp"
#include "tests/soak/ordinary_days.hpp"
#include "tests/soak/rows.hpp"
#include "tests/support/summarised_stderr.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::soak {
namespace {

namespace rt = runtime;

/// A reference, and a hash over the bits of everything that left.
class HashingField final : public rt::FieldIo {
 public:
  rt::Fault read(std::span<double> inputs) noexcept override {
    phase_ += 1e-4;
    phase_ -= phase_ >= 4.0 ? 4.0 : 0.0;
    inputs[0] = 20.0 * (phase_ < 2.0 ? phase_ - 1.0 : 3.0 - phase_);
    return rt::Fault::none;
  }
  void write(std::span<const double> outputs) noexcept override {
    for (const double value : outputs) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3ULL;
    }
  }
  std::uint64_t hash = 0xCBF29CE484222325ULL;

 private:
  double phase_ = 0.0;
};

Counted virtual_steps(std::uint64_t count) {
  Diagnostics warnings;
  const Program diagram = compile_file(std::string(HYSTERON_SOURCE_DIR) + "/bench/feedforward.st", {}, warnings);
  std::vector<std::uint64_t> hashes;
  for (int run = 0; run < 3; ++run) {
    const auto program = tool::step_program(diagram, tool::Engine::compiled, false);
    HashingField field;
    rt::Task task(
        *program,
        {.loop = {.cycles = count}, .inputs = {{.from_device = true}, {}}, .outputs = {{.low = -1e3, .high = 1e3}}},
        {.field = &field});
    rt::VirtualClock clock;
    const std::atomic<bool> stop{false};
    (void)task.run(clock, stop);
    hashes.push_back(task.statistics().run == count ? field.hash : hashes.size());
  }
  const bool same = hashes[0] == hashes[1] && hashes[1] == hashes[2];
  return {count, fmt::format("hash {:016x}, {}", hashes[0], same ? "the same bits" : "other bits"), same};
}

Counted delays(std::uint64_t count) {
  const auto result = rt::test::inject_delays(count);
  const auto& events = result.run.statistics.events;
  const auto by = [&](rt::Cause cause) { return events[static_cast<std::size_t>(cause)]; };
  return {count,
          fmt::format("late wake {}, own CPU {}, pre-empted {}, steal {}; {}", by(rt::Cause::late_wake),
                      by(rt::Cause::own_cpu), by(rt::Cause::preempted), by(rt::Cause::host_steal),
                      result.are_counted() ? "as injected" : "not as injected"),
          result.are_counted()};
}

/// Two cycles of holding, and what the guard waits until it takes over, with the machine's own delays on top.
constexpr double longest_to_safety = 1000.0;

Counted mishap(rt::test::Mishap kind, std::uint64_t count) {
  std::vector<std::int64_t> times;
  std::uint64_t unsafe = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto time = rt::test::time_to_safety(kind);
    unsafe += time < 0 || static_cast<double>(time) * 1e-6 > longest_to_safety ? 1 : 0;
    times.push_back(time);
  }
  std::ranges::sort(times);
  return {count,
          fmt::format("{} not safe within 1 s; median {:.1f} ms, worst {:.1f} ms", unsafe,
                      static_cast<double>(times[times.size() / 2]) * 1e-6, static_cast<double>(times.back()) * 1e-6),
          unsafe == 0};
}

Counted retain_kills(std::uint64_t count) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("hysteron-soak-{}", getpid());
  std::mt19937_64 random(11);
  std::uint64_t lost = 0;
  std::uint64_t last = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto result =
        rt::test::kill_while_retaining(folder, static_cast<std::int64_t>(500'000 + random() % 15'000'000));
    lost += !result.consistent || result.recovered < result.confirmed || result.recovered < last ? 1 : 0;
    last = result.recovered;
  }
  std::filesystem::remove_all(folder);
  return {count, fmt::format("{} with a loss; {} states written", lost, last), lost == 0};
}

Counted history_kills(std::uint64_t count) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("hysteron-soak-history-{}", getpid());
  std::filesystem::create_directories(folder);
  std::mt19937_64 random(12);
  std::uint64_t broken = 0;
  std::int64_t rows = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto result =
        rt::test::kill_history(folder / "history.sqlite", static_cast<int>(k), 1 + static_cast<int>(random() % 8),
                               static_cast<useconds_t>(random() % 5000));
    broken += result.is_whole ? 0 : 1;
    rows += result.rows;
  }
  std::filesystem::remove_all(folder);
  return {count, fmt::format("{} with a loss or a gap; {} rows written", broken, rows), broken == 0};
}

Counted outbox_kills(std::uint64_t count) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("hysteron-soak-mqtt-{}", getpid());
  std::filesystem::create_directories(folder);
  std::mt19937_64 random(13);
  std::uint64_t broken = 0;
  std::uint64_t rows = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto result = rt::test::kill_outbox(folder / "rows.sqlite", 1 + static_cast<int>(random() % 8),
                                              static_cast<useconds_t>(random() % 5000));
    broken += result.is_whole ? 0 : 1;
    rows = result.end;
  }
  std::filesystem::remove_all(folder);
  return {count, fmt::format("{} with a loss or a gap; {} rows written", broken, rows), broken == 0};
}

Counted retain_damage(std::uint64_t /*all*/) {
  rt::RetainedValues values{.sequence = 7, .layout = "9f3c", .parameters = {1.5, -0.0, 1e-300}};
  values.state.assign(2000, std::byte{0x5A});
  const auto result = rt::test::damage(rt::encode_slot(values));
  return {result.tried, fmt::format("{} taken for a whole slot", result.taken), result.taken == 0};
}

Counted linked_sets(std::uint64_t count) {
  const auto result = rt::test::commit_linked_sets(count);
  return {count, fmt::format("{} torn; {} steps, {} with another set", result.torn, result.steps, result.applied),
          result.torn == 0 && result.committed == count};
}

Counted online_changes(std::uint64_t count) {
  const test::SummarisedStderr summary;  // each change has its notice
  const auto result = rt::test::change_many_times(count);
  return {count,
          fmt::format("{} refused, {} sets committed meanwhile, the last {}; longest cycle {:.1f} us",
                      count - result.changed, result.committed, result.last_counts ? "counts" : "LOST",
                      static_cast<double>(result.longest_cycle) * 1e-3),
          result.changed == count && result.version == count + 1 && result.last_counts};
}

Counted exact_answers(std::uint64_t /*all*/) {
  std::uint64_t answers = 0;
  std::uint64_t exceptions = 0;
  std::string wrong;
  for (const auto order : rt::modbus::word_orders) {
    const auto result = test::every_function_and_length(order);
    answers += result.answers;
    exceptions += result.exceptions;
    wrong += result.first_wrong;
  }
  return {answers,
          fmt::format("65024 in each of 4 word orders, {} exceptions; {}", exceptions,
                      wrong.empty() ? "every answer exact" : wrong),
          wrong.empty() && answers == 4 * 65024};
}

Counted every_cut(std::uint64_t /*all*/) {
  const auto result = test::cut_every_way();
  return {result.ways, fmt::format("{} answered otherwise", result.wrong), result.wrong == 0 && result.ways == 2048};
}

/// All faults at once, each with a server and a device of its own: they wait most of the time.
Counted bad_servers(std::uint64_t count) {
  struct Case {
    test::Fault fault;
    std::uint8_t exception;
  };
  std::vector<Case> cases;
  for (const auto& [fault, name] : test::link_faults) {
    cases.push_back({fault, 0});
  }
  for (std::uint8_t code = 1; code <= 11; ++code) {
    cases.push_back({test::Fault::exception, code});
  }
  constexpr std::uint64_t rounds = 20;
  std::vector<test::BadDeviceResult> results(cases.size());
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      threads.emplace_back([&, i] {
        results[i] = test::meet(cases[i].fault, cases[i].exception, rounds, (count + rounds - 1) / rounds,
                                std::chrono::milliseconds(20));
      });
    }
  }
  std::uint64_t fewest = results.front().met;
  std::uint64_t wrong = 0;
  std::uint64_t lost = 0;
  for (const auto& result : results) {
    fewest = std::min(fewest, result.met);
    wrong += result.wrong;
    lost += result.rounds - result.recovered;
  }
  return {fewest,
          fmt::format("of each of {} faults, at the least; {} wrong values, {} times of {} not used again",
                      cases.size(), wrong, lost, rounds * cases.size()),
          fewest >= count && wrong == 0 && lost == 0};
}

/// Tests of another program, which the row only counts.
Counted clients(std::uint64_t /*all*/) {
  const std::string command = HYSTERON_TEST_RUNTIME
      " --gtest_brief=1 --gtest_filter='WordOrders/*:Device.EveryType*' | sed -n 's/.*PASSED.* \\([0-9]*\\) "
      "test.*/\\1/p'";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  std::array<char, 64> line{};
  const bool said = std::fgets(line.data(), line.size(), pipe) != nullptr;
  const std::uint64_t passed = said ? std::stoull(line.data()) : 0;
  const bool well = ::pclose(pipe) == 0 && passed == 10;
  return {passed, well ? "tests, all bit-equal: pymodbus, mbpoll, libmodbus' links, TCP and serial" : "tests passed",
          well};
}

std::vector<Row> rows() {
  std::vector<Row> list{
      {"virtual_steps", "virtual-clock steps of the feedforward, three runs", 100'000'000, virtual_steps},
      {"delays", "injected late wake-ups and other delays, by cause", 10'000, delays}};
  for (std::size_t i = 0; i < rt::test::mishap_names.size(); ++i) {
    const std::string name(rt::test::mishap_names[i]);
    list.push_back({name, name + " → safe outputs", 1000,
                    [i](std::uint64_t count) { return mishap(static_cast<rt::test::Mishap>(i), count); }});
  }
  list.insert(list.end(),
              {{"retain_kills", "SIGKILL while retaining", 1000, retain_kills},
               {"history_kills", "SIGKILL while a history is written", 1000, history_kills},
               {"outbox_kills", "SIGKILL while rows for MQTT wait on the disk", 1000, outbox_kills},
               {"retain_damage", "every truncation and single-bit flip of a slot", 1, retain_damage},
               {"linked_sets", "linked parameter sets against a running loop", 1'000'000, linked_sets},
               {"online_changes", "online changes there and back against a client that commits", 1000, online_changes},
               {"exact_answers", "every function code × every PDU length", 1, exact_answers},
               {"every_cut", "every way to cut a 12-byte request", 1, every_cut},
               {"bad_servers", "client role against a scripted bad server", 1000, bad_servers},
               {"clients", "word orders × types against other people's clients", 1, clients}});
  const std::vector<Row> days = ordinary_days();
  list.insert(list.end(), days.begin(), days.end());
  return list;
}

}  // namespace
}  // namespace hysteron::soak

int main(int argc, char** argv) {
  (void)std::signal(SIGPIPE, SIG_IGN);
  return hysteron::soak::run_rows(hysteron::soak::rows(), std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
}
