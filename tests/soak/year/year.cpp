// A year in a night: a plant that is controlled by the host for a year of its own time, through power cuts, lost
// devices, full disks, clocks that are wrong, certificates that end and edits of its diagram.
//
//   year [--span 365d] [--period 1ms] [--seed N] [--density 1] [--engine compiled] [--log FILE] [--no-flush]
//
// Each life of the task is a process: the host of `hysteron serve` on a simulated clock and disk. What it confirmed is
// held against what the next life finds. Prints rows of a Markdown table; the exit code is 1 where one does not hold.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "runtime/config/run_config.hpp"
#include "runtime/history/history_reader.hpp"
#include "runtime/task/trace_file.hpp"
#include "runtime/task/trace_output.hpp"
#include "tests/runtime/modbus/test_certificates.hpp"
#include "tests/soak/year/disk_journal.hpp"
#include "tests/soak/year/disk_watch.hpp"
#include "tests/soak/year/life.hpp"
#include "tests/soak/year/simulated_time.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::soak {
namespace {

struct Options {
  PlanSettings plan{.span = 365 * 86'400 * second, .period = 1'000'000};
  std::string engine{};
  std::string log = "/dev/null";
  bool flushes = true;
};

/// What the lives and the times between them came to, beside the ledger.
struct Sum {
  std::uint64_t cycles = 0;
  std::uint64_t skipped = 0;
  std::map<Happening, std::int64_t> down{};  ///< ns, by what ended the life before
  std::int64_t starting = 0;                 ///< ns, until the first cycle
  std::uint64_t lives = 0;
  std::uint64_t starts_refused = 0;
  std::uint64_t ended_otherwise = 0;
  std::int64_t unaccounted = 0;                 ///< periods
  std::map<std::string, std::uint64_t> cuts{};  ///< power cuts, by the file that was written
  std::uint64_t lost_bytes = 0;
  std::uint64_t lost_names = 0;
  std::uint64_t rows = 0;
  std::uint64_t lost_rows = 0;
  std::uint64_t unreadable_histories = 0;
  std::uint64_t traces = 0;
  std::uint64_t trace_steps = 0;
  std::uint64_t unreadable_traces = 0;
};

/// What the file is for.
std::string kind_of(const std::string& name) {
  return name.starts_with("retained/")     ? "retained state"
         : name.starts_with("run.history") ? "history"
         : name.starts_with("run.trace")   ? "trace"
                                           : name;
}

class Year {
 public:
  explicit Year(const Options& options)
      : options_(options),
        random_(options.plan.seed ^ 0x9E3779B97F4A7C15ULL),
        ledger_(new (::mmap(nullptr, sizeof(Ledger), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
                    Ledger),
        journal_(::memfd_create("journal", 0)) {
    std::filesystem::create_directories(disk_);
    std::filesystem::create_directories(folder_.path() / "certificates");
    stage_.plan = make_plan(options.plan);
    stage_.files = {.disk = disk_, .certificates = folder_.path() / "certificates"};
    stage_.quantum = std::clamp<std::int64_t>(options.plan.span / 50'000, second, 600 * second);
    const tool::Engine engine = tool::engine_of(options.engine);
    stage_.how = engine == tool::Engine::compiled ? "compiled" : "interpreted";
    // Made before there is any life: each has copies of its own, and to make one takes longer than a life.
    const auto make = [engine, period = options.plan.period](std::uint64_t version) {
      return tool::step_program(compile_text(diagram_text(version, period)), engine, false);
    };
    const auto made =
        std::make_shared<std::array<std::vector<std::unique_ptr<runtime::StepProgram>>, jumping_version + 1>>();
    for (std::uint64_t version = 0; version < made->size(); ++version) {
      for (int copy = 0; copy < 3; ++copy) {
        made->at(version).push_back(make(version));
      }
    }
    stage_.program = [make, made](std::uint64_t version) {
      auto& copies = made->at(version);
      auto program = copies.empty() ? make(version) : std::move(copies.back());
      if (!copies.empty()) {
        copies.pop_back();
      }
      return program;
    };
    make_certificates();
  }

  void run() {
    const PlanSettings& settings = options_.plan;
    for (std::int64_t from = 0; from < settings.span;) {
      DiskImage before = image_of(disk_);
      const int status = one_life(from);
      ++sum_.lives;
      const std::int64_t lived = account(from);
      Happening cause = ledger_->end;
      if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL && ledger_->has_begun) {
        if (cause != Happening::Kill) {
          power_off(before);
        }
      } else if (const bool may_tell =
                     settings.span - from - lived < 30 * settings.period || ledger_->was_full;  // of what is wrong then
                 !(WIFEXITED(status) && ledger_->ends_orderly && (WEXITSTATUS(status) == 0 || may_tell))) {
        (ledger_->has_begun ? sum_.ended_otherwise : sum_.starts_refused) += 1;
        fmt::print(stderr, "at {:.1f} s: the task ended by itself, status {}\n",
                   static_cast<double>(from + lived) * 1e-9, status);
        cause = Happening::Kill;
      }
      look_at_history();
      look_at_traces();
      from += lived;
      if (from < settings.span) {
        const std::int64_t down = std::min(settings.span - from, down_time());
        sum_.down[cause] += down;
        from += down;
      }
    }
  }

  [[nodiscard]] bool print(double seconds) const;

 private:
  void make_certificates() {
    // Dates are told from the present of the process.
    SimulatedTime::begin(monotonic_begin, utc_ahead);
    constexpr long many_years = 40L * 365 * 86'400;
    const test::Certificate authority({.name = "authority", .begins = -many_years, .ends = many_years}, nullptr);
    for (const Certificate& one : stage_.plan.certificates) {
      const test::Certificate server({.name = "server",
                                      .begins = static_cast<long>(one.from / second) - 1,
                                      .ends = static_cast<long>(one.until / second),
                                      .for_clients = false},
                                     &authority);
      stage_.certificates.push_back({.certificate = server.certificate_pem(), .key = server.key_pem()});
    }
    std::ofstream(stage_.files.certificates / "clients.pem") << authority.certificate_pem();
  }

  /// Forks: this process has one thread. Its status as waitpid says it.
  int one_life(std::int64_t from) {
    ledger_->now = from;
    ledger_->first_due = 0;
    ledger_->cycles = 0;
    ledger_->skipped = 0;
    ledger_->history_rows = 0;
    ledger_->has_begun = false;
    ledger_->was_full = false;
    (void)::ftruncate(journal_, 0);
    (void)::lseek(journal_, 0, SEEK_SET);
    const pid_t child = ::fork();
    if (child == 0) {
      (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
      const int log = ::open(options_.log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
      (void)::dup2(log, STDERR_FILENO);
      SimulatedTime::begin(monotonic_begin + from, utc_ahead);
      DiskWatch::begin(disk_, journal_);
      if (!options_.flushes) {
        DiskWatch::never_flush();
      }
      ::_exit(live(stage_, *ledger_, from) ? 0 : 1);
    }
    int status = 0;
    (void)::waitpid(child, &status, 0);
    return status;
  }

  /// How long the life was: the start, and whole periods, each of which ran or was skipped.
  std::int64_t account(std::int64_t from) {
    const std::int64_t period = options_.plan.period;
    const auto periods = static_cast<std::int64_t>(ledger_->cycles + ledger_->skipped);
    sum_.cycles += ledger_->cycles;
    sum_.skipped += ledger_->skipped;
    if (ledger_->first_due == 0) {
      return 0;
    }
    const std::int64_t begin = ledger_->first_due - period;
    // The cycle under way may have been cut off before the plant saw it.
    sum_.unaccounted += std::max<std::int64_t>(0, std::abs((ledger_->now - begin) / period - periods) - 1);
    sum_.starting += begin - from;
    return begin - from + periods * period;
  }

  void power_off(const DiskImage& before) {
    std::string bytes(static_cast<std::size_t>(std::max<off_t>(0, ::lseek(journal_, 0, SEEK_END))), '\0');
    (void)!::pread(journal_, bytes.data(), bytes.size(), 0);
    const auto journal = decode_journal(bytes);
    std::map<std::uint64_t, std::string> names;
    std::uint64_t number = 0;
    for (const auto& [name, contents] : before) {
      names[number++] = name;
    }
    std::string written = "nothing";
    for (const DiskEntry& entry : journal) {
      if (entry.deed == DiskDeed::Make) {
        names[entry.file] = entry.name;
      }
    }
    if (!journal.empty() && journal.back().deed == DiskDeed::Write) {
      written = kind_of(names[journal.back().file]);
    }
    ++sum_.cuts[written];
    const PowerCut cut = cut_power(before, journal, random_);
    sum_.lost_bytes += cut.lost_bytes;
    sum_.lost_names += cut.lost_names;
    restore(disk_, cut.image);
  }

  /// Ten seconds to two hours.
  std::int64_t down_time() {
    const double part = static_cast<double>(random_() >> 11) * 0x1p-53;
    const double longest = std::min(7200.0, 1e-9 * static_cast<double>(options_.plan.span) / 100.0);
    const auto time = static_cast<std::int64_t>(1e9 * (10.0 + part * part * longest));
    return (time / options_.plan.period + 1) * options_.plan.period;
  }

  void look_at_history() {
    if (!ledger_->has_begun || ledger_->history_rows == 0) {
      return;
    }
    sum_.rows += ledger_->history_rows;
    try {
      runtime::HistoryReader reader(disk_ / "run.history");
      const auto runs = reader.runs();
      std::uint64_t found = 0;
      for (const auto& stretch : reader.stretches({.run = runs.empty() ? 0 : runs.back().run}).stretches) {
        found += static_cast<std::uint64_t>(stretch.rows);
      }
      sum_.lost_rows += found < ledger_->history_rows ? ledger_->history_rows - found : 0;
    } catch (const std::exception& problem) {
      fmt::print(stderr, "history: {}\n", problem.what());
      ++sum_.unreadable_histories;
    }
  }

  void look_at_traces() {
    for (std::size_t number = 0; number < 4; ++number) {
      const auto file = number == 0 ? disk_ / "run.trace" : runtime::previous_trace(disk_ / "run.trace", number);
      if (!std::filesystem::exists(file) || std::filesystem::file_size(file) == 0) {
        continue;
      }
      const std::string bytes = test::contents_of(file);
      runtime::TraceHead head;
      std::uint64_t steps = 0;
      const std::string problem = runtime::read_trace(bytes, head, [&](const runtime::TraceHead&) {
        return runtime::TraceVisitor{.step = [&](const runtime::TraceStep&) { ++steps; }};
      });
      ++sum_.traces;
      sum_.trace_steps += steps;
      if (problem.empty()) {
        continue;
      }
      // A trace is not flushed: after a power cut it may be anything, and then it is to be told of, and no more.
      const bool was_cut = ledger_->end == Happening::PowerCut || ledger_->end == Happening::CutWithCommit;
      if (was_cut) {
        torn_.insert(std::hash<std::string>{}(bytes));
      } else if (!torn_.contains(std::hash<std::string>{}(bytes))) {
        fmt::print(stderr, "{}: {}\n", file.string(), problem);
        ++sum_.unreadable_traces;
      }
    }
  }

  Options options_;
  test::ScratchFolder folder_{};
  std::filesystem::path disk_ = folder_.path() / "disk";
  std::mt19937_64 random_;
  Ledger* ledger_;
  int journal_;
  Stage stage_{};
  Sum sum_{};
  std::set<std::size_t> torn_{};  ///< traces that a power cut tore, by their contents
};

bool Year::print(double seconds) const {
  const Ledger& l = *ledger_;
  const auto happened = [&](Happening what) { return l.happened[static_cast<std::size_t>(what)]; };
  bool all_hold = true;
  const auto row = [&](std::string_view what, std::uint64_t count, const std::string& result, bool holds) {
    fmt::print("| {} | {} | {} | {} |\n", what, count, result, holds ? "yes" : "NO");
    all_hold = all_hold && holds;
  };
  const std::int64_t period = options_.plan.period;
  const std::int64_t all = options_.plan.span / period;
  std::string downs;
  for (const auto& [cause, time] : sum_.down) {
    downs += fmt::format("{} after {}, ", time / period, name_of(cause));
  }
  std::string cuts;
  for (const auto& [file, count] : sum_.cuts) {
    cuts += fmt::format("{}{} {}", cuts.empty() ? "" : ", ", file, count);
  }
  const std::uint64_t power_cuts = happened(Happening::PowerCut) + happened(Happening::CutWithCommit);
  fmt::print(
      "{:.3g} days of {} ms periods, seed {}, {} diagram, in {:.0f} s: {:.0f} cycles a second.\n\n"
      "| what | count | result | holds |\n| --- | --- | --- | --- |\n",
      static_cast<double>(options_.plan.span) / 86'400e9, static_cast<double>(options_.plan.period) * 1e-6,
      options_.plan.seed, stage_.how, seconds, static_cast<double>(sum_.cycles) / seconds);
  row("periods", static_cast<std::uint64_t>(all),
      fmt::format(
          "{} ran; skipped: {} late wake, {} overload; down: {}{} starting; {} not accounted for; the task counted "
          "otherwise {} times",
          sum_.cycles, l.skipped_late, l.skipped_overload, downs, sum_.starting / period, sum_.unaccounted,
          l.wrong_account),
      sum_.unaccounted == 0 && l.wrong_account == 0);
  row("power cuts", power_cuts,
      fmt::format("while written: {}; {} bytes and {} names that were not flushed are gone", cuts, sum_.lost_bytes,
                  sum_.lost_names),
      true);
  row("starts", sum_.lives,
      fmt::format("{} refused, {} ended otherwise than by the plan", sum_.starts_refused, sum_.ended_otherwise),
      sum_.starts_refused == 0 && sum_.ended_otherwise == 0);
  row("sets of parameters confirmed as committed", l.confirmations,
      fmt::format("{} lost, {} torn, {} confirmed while the disk was full", l.lost_sets, l.torn_sets,
                  l.confirmed_in_vain),
      l.lost_sets == 0 && l.torn_sets == 0 && l.confirmed_in_vain == 0);
  row("retained state at a start", sum_.lives, fmt::format("{} times older than what was confirmed", l.lost_uptime),
      l.lost_uptime == 0);
  row("rows of the history confirmed as written", sum_.rows,
      fmt::format("{} lost, {} times not readable", sum_.lost_rows, sum_.unreadable_histories),
      sum_.lost_rows == 0 && sum_.unreadable_histories == 0);
  row("trace files after a life", sum_.traces,
      fmt::format("{} steps in them; {} torn by a power cut, {} otherwise not readable", sum_.trace_steps, torn_.size(),
                  sum_.unreadable_traces),
      sum_.unreadable_traces == 0);
  row("devices lost, sensors broken", happened(Happening::DeviceLost) + happened(Happening::SensorBroken),
      fmt::format(
          "safe after {:.2f} s at the latest; {} cycles unsafe for longer, {} outputs out of range, {} times not "
          "back",
          static_cast<double>(l.longest_to_safety) * 1e-9, l.unsafe, l.out_of_range, l.not_back),
      l.unsafe == 0 && l.out_of_range == 0 && l.not_back == 0);
  row("disk full for a while", happened(Happening::DiskFull),
      fmt::format("{} starts meanwhile; {} times a write failed and was told of", l.begun_full, l.full_noticed), true);
  row("wall clock wrong for a while", happened(Happening::ClockStep), "judged by the rows above and below", true);
  row("certificates", stage_.plan.certificates.size(),
      fmt::format("{} ended before the next was written; task.tls_fault wrong at {} looks", l.certificate_ends,
                  l.wrong_certificate),
      l.wrong_certificate == 0);
  row("restarts with an edited diagram", happened(Happening::Restart), "judged by the rows above", true);
  row("online changes", l.changed + l.not_changed, fmt::format("{} refused", l.not_changed), l.not_changed == 0);
  row("online changes with a jump", l.jumps_refused + l.jumps_taken, fmt::format("{} taken", l.jumps_taken),
      l.jumps_taken == 0);
  return all_hold;
}

Options parse(int count, char** words) {
  Options options;
  options.plan.seed = std::random_device{}();
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--no-flush") {
      options.flushes = false;
      continue;
    }
    if (i + 1 == count) {
      throw std::invalid_argument(fmt::format("{} needs a value, or is no option", word));
    }
    const std::string value = words[++i];
    const auto time = [&] {
      const auto parsed = runtime::parse_duration(value);
      if (!parsed || *parsed <= 0) {
        throw std::invalid_argument(fmt::format("{} needs a time as 30d or 1ms, and has {}", word, value));
      }
      return *parsed;
    };
    if (word == "--span") {
      options.plan.span = time();
    } else if (word == "--period") {
      options.plan.period = time();
    } else if (word == "--seed") {
      options.plan.seed = std::stoull(value);
    } else if (word == "--density") {
      options.plan.density = std::stod(value);
    } else if (word == "--engine") {
      options.engine = value;
    } else if (word == "--log") {
      options.log = value;
    } else {
      throw std::invalid_argument(fmt::format("no option {}", word));
    }
  }
  return options;
}

}  // namespace
}  // namespace hysteron::soak

int main(int argc, char** argv) {
  using namespace hysteron::soak;
  (void)std::signal(SIGPIPE, SIG_IGN);
  try {
    const Options options = parse(argc, argv);
    fmt::print(stderr, "seed {}\n", options.plan.seed);
    const auto now = [] {
      timespec time{};
      (void)::clock_gettime(CLOCK_TAI, &time);  // one that is not simulated
      return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const double from = now();
    Year year(options);
    year.run();
    return year.print(now() - from) ? 0 : 1;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "year: {}\n", problem.what());
    return 2;
  }
}
