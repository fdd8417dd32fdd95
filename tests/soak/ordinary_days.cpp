#include "tests/soak/ordinary_days.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "runtime/host/notices.hpp"
#include "runtime/modbus/host_names.hpp"
#include "runtime/modbus/server.hpp"
#include "tests/runtime/host/dead_guard.hpp"
#include "tests/runtime/host/setpoint_kills.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/format_round_trips.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"
#include "tests/runtime/modbus/late_network.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/rtu_noise.hpp"
#include "tests/runtime/modbus/silent_name_server.hpp"
#include "tests/runtime/task/loaded_task.hpp"
#include "tests/runtime/task/many_captures.hpp"

namespace hysteron::soak {
namespace {

namespace rt = runtime;

std::filesystem::path folder_of(const char* row) {
  return std::filesystem::temp_directory_path() / fmt::format("hysteron-soak-{}-{}", row, ::getpid());
}

Counted formats(std::uint64_t count) {
  const auto result = test::send_numbers_round(count);
  return {result.numbers,
          fmt::format("in {} formats; {} raw numbers changed, {} values further than half a step, {} beyond in silence",
                      result.formats, result.wrong, result.too_far, result.silent),
          result.wrong + result.too_far + result.silent == 0};
}

Counted noisy_line(std::uint64_t count) {
  const auto result = test::talk_on_a_noisy_line(count);
  return {result.frames,
          fmt::format("{} answered; {} sound ones without their answer, {} answers and {} writes unasked",
                      result.answered, result.unanswered, result.unasked, result.writes),
          result.unanswered + result.unasked + result.writes == 0 && result.answered > 0};
}

Counted late_networks(std::uint64_t count) {
  std::uint64_t served = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto met = test::meet_a_late_network();
    if (met == test::LateNetwork::none) {
      return {0, "this machine gives no network of its own", false};
    }
    served += met == test::LateNetwork::served ? 1 : 0;
  }
  return {count, fmt::format("{} served once it was there", served), served == count};
}

/// It never answers: a look-up that waited for it would not end.
Counted silent_names(std::uint64_t count) {
  const std::vector<std::string> hosts{"silent.test", "known.test"};
  std::uint64_t found = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto addresses = rt::modbus::addresses_within(hosts, std::chrono::milliseconds(200));
    found += addresses[0].empty() && addresses[1] == std::vector<std::string>{"127.0.0.8"} ? 1 : 0;
  }
  return {count, fmt::format("{} went on without it, with the names that answered", found), found == count};
}

Counted dead_guards(std::uint64_t count) {
  std::uint64_t started = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    started += rt::test::starts_after_a_dead_guard() ? 1 : 0;
  }
  return {count, fmt::format("{} started after their wait", started), started == count};
}

Counted setpoint_kills(std::uint64_t count) {
  const auto folder = folder_of("setpoints");
  std::mt19937_64 random(13);
  std::uint64_t lost = 0;
  double last = 0.0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto result =
        rt::test::kill_while_setpoints_come(folder, static_cast<std::int64_t>(500'000 + random() % 30'000'000));
    lost += result.holds() && result.begun_with >= last ? 0 : 1;
    last = result.begun_with;
  }
  std::filesystem::remove_all(folder);
  return {count,
          fmt::format("{} began with an older one than was on the disk, or with none that was written; {:.0f} written",
                      lost, last),
          lost == 0 && last > 0.0};
}

Counted captures(std::uint64_t count) {
  const auto folder = folder_of("captures");
  const auto result = rt::test::capture_many_times(folder, count);
  return {result.files,
          fmt::format("of {} runs; {} missing or too many, {} that do not replay", result.runs, result.missing,
                      result.different),
          result.missing + result.different == 0};
}

/// Each cycle computes for 1.7 periods: all of them are late, for one reason, and it is the whole of the time.
Counted overloads(std::uint64_t count) {
  rt::test::Loaded bench([](std::uint64_t) { return 17 * rt::test::loaded_period / 10; }, {.loop = {.cycles = count}});
  bench.run();
  const rt::LoopStatistics& counts = bench.task->statistics();
  const std::uint64_t own = counts.events[static_cast<std::size_t>(rt::Cause::own_cpu)];
  rt::LoadNotices notices(0.8);
  const bool is_told = !notices.line(bench.task->load()).empty();
  const double load = bench.task->load().load;
  return {count,
          fmt::format("{} late by what they compute, {} by anything else; {} periods skipped; load {:.0f} %, {}", own,
                      counts.late_events() - own + counts.carried, counts.skipped, 100.0 * load,
                      is_told ? "told of" : "NOT told of"),
          own == count && counts.late_events() == count && load > 0.99 && is_told &&
              counts.run + counts.skipped == counts.elapsed};
}

/// A client loses its eight connections again and again, and comes back.
Counted leaked_connections(std::uint64_t count) {
  test::MemoryDoor door(test::registers_to_serve());
  const rt::modbus::Server server(rt::modbus::make_register_map(door.points(), {.title = "T"}), door,
                                  {.port = 0, .connections_per_address = 8, .evict = std::chrono::milliseconds(100)});
  std::uint64_t served = 0;
  double longest = 0.0;
  std::vector<std::unique_ptr<test::ClientSocket>> leaked;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    bool is_served = false;
    while (!is_served && std::chrono::steady_clock::now() - begin < std::chrono::seconds(10)) {
      auto socket = std::make_unique<test::ClientSocket>(server.port());
      is_served = test::ask(*socket, test::read_one).size() == 11;
      if (is_served) {
        leaked.push_back(std::move(socket));  // and forgotten
      }
    }
    served += is_served ? 1 : 0;
    longest = std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return {count, fmt::format("{} served, after {:.2f} s at the latest", served, longest), served == count};
}

}  // namespace

std::vector<Row> ordinary_days() {
  return {{"formats", "raw numbers of random formats, there and back", 10'000'000, formats},
          {"noisy_line", "requests on a serial line, half of them damaged, with noise between", 1'000'000, noisy_line},
          {"late_networks", "servers started before their network", 100, late_networks},
          {"silent_names", "starts beside a name server that never answers", 100, silent_names},
          {"dead_guards", "starts after a guard that reaches its device no more", 100, dead_guards},
          {"overloads", "cycles that compute for 1.7 periods each", 1'000'000, overloads},
          {"leaked_connections", "connections of a client that forgets each", 500, leaked_connections},
          {"setpoint_kills", "SIGKILL while a client writes a retained setpoint", 1000, setpoint_kills},
          {"captures", "captures of a trigger that is armed again", 300, captures}};
}

}  // namespace hysteron::soak
