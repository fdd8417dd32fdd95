// The long counts of the runtime, as rows of a Markdown table. An argument, a fraction such as 0.01, shortens all.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "runtime/task/task.hpp"
#include "tests/runtime/task/dying_task.hpp"
#include "tests/runtime/task/linked_sets.hpp"
#include "tests/runtime/task/retain_kill.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::runtime {
namespace {

bool all_well = true;

void row(const std::string& what, std::uint64_t count, const std::string& result, bool well,
         std::chrono::steady_clock::time_point begin) {
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  fmt::print("| {} | {} | {} | {} | {:.1f} |\n", what, count, result, well ? "yes" : "NO", time.count());
  (void)std::fflush(stdout);
  all_well = all_well && well;
}

/// A reference, and a hash over the bits of everything that left.
class HashingField final : public FieldIo {
 public:
  Fault read(std::span<double> inputs) noexcept override {
    phase_ += 1e-4;
    phase_ -= phase_ >= 4.0 ? 4.0 : 0.0;
    inputs[0] = 20.0 * (phase_ < 2.0 ? phase_ - 1.0 : 3.0 - phase_);
    return Fault::none;
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

void virtual_steps(std::uint64_t count) {
  const auto begin = std::chrono::steady_clock::now();
  Diagnostics warnings;
  const Program diagram = compile_file(std::string(HYSTERON_SOURCE_DIR) + "/bench/feedforward.st", {}, warnings);
  std::vector<std::uint64_t> hashes;
  for (int run = 0; run < 3; ++run) {
    const auto program = tool::step_program(diagram, tool::Engine::compiled, false);
    HashingField field;
    Task task(
        *program,
        {.loop = {.cycles = count}, .inputs = {{.from_device = true}, {}}, .outputs = {{.low = -1e3, .high = 1e3}}},
        {.field = &field});
    VirtualClock clock;
    const std::atomic<bool> stop{false};
    (void)task.run(clock, stop);
    hashes.push_back(task.statistics().run == count ? field.hash : hashes.size());
  }
  const bool same = hashes[0] == hashes[1] && hashes[1] == hashes[2];
  row("virtual-clock steps of the feedforward, three runs", count,
      fmt::format("hash {:016x}, {}", hashes[0], same ? "the same bits" : "other bits"), same, begin);
}

void mishaps(std::uint64_t count) {
  for (std::size_t i = 0; i < test::mishap_names.size(); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::int64_t> times;
    std::uint64_t unsafe = 0;
    for (std::uint64_t k = 0; k < count; ++k) {
      const auto time = test::time_to_safety(static_cast<test::Mishap>(i));
      unsafe += time < 0 ? 1 : 0;
      times.push_back(time);
    }
    std::ranges::sort(times);
    row(fmt::format("{} → safe outputs", test::mishap_names[i]), count,
        fmt::format("{} not safe; median {:.1f} ms, worst {:.1f} ms", unsafe,
                    static_cast<double>(times[times.size() / 2]) * 1e-6, static_cast<double>(times.back()) * 1e-6),
        unsafe == 0, begin);
  }
}

void retain_kills(std::uint64_t count) {
  const auto begin = std::chrono::steady_clock::now();
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("hysteron-soak-{}", getpid());
  std::mt19937_64 random(11);
  std::uint64_t lost = 0;
  std::uint64_t last = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto result = test::kill_while_retaining(folder, static_cast<std::int64_t>(500'000 + random() % 15'000'000));
    lost += !result.consistent || result.recovered < result.confirmed || result.recovered < last ? 1 : 0;
    last = result.recovered;
  }
  std::filesystem::remove_all(folder);
  row("SIGKILL while retaining", count, fmt::format("{} with a loss; {} states written", lost, last), lost == 0, begin);
}

void linked_sets(std::uint64_t count) {
  const auto begin = std::chrono::steady_clock::now();
  const auto result = test::commit_linked_sets(count);
  row("linked parameter sets against a running loop", count,
      fmt::format("{} torn; {} steps, {} with another set", result.torn, result.steps, result.applied),
      result.torn == 0 && result.committed == count, begin);
}

}  // namespace
}  // namespace hysteron::runtime

int main(int argc, char** argv) {
  const double fraction = argc > 1 ? std::atof(argv[1]) : 1.0;
  const auto part = [&](double count) {
    return static_cast<std::uint64_t>(std::max(1.0, std::round(count * fraction)));
  };
  fmt::print("| what | count | result | holds | s |\n| --- | --- | --- | --- | --- |\n");
  hysteron::runtime::virtual_steps(part(1e8));
  hysteron::runtime::mishaps(part(200));
  hysteron::runtime::retain_kills(part(1000));
  hysteron::runtime::linked_sets(part(1e6));
  return hysteron::runtime::all_well ? 0 : 1;
}
