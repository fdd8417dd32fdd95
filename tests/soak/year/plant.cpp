#include "tests/soak/year/plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "tests/soak/year/simulated_time.hpp"

namespace hysteron::soak {
namespace {

/// {period}, {extra}: declarations, {level}: what is controlled, {behind}: added to the valve.
constexpr std::string_view diagram = R"(FUNCTION_BLOCK TANK (* @ts {period}ns *)
  VAR_INPUT
    LEVEL  : LREAL;        (* @unit m *)
    WANTED : LREAL := 1.0; (* @unit m *)
  END_VAR
  VAR_OUTPUT
    VALVE  : LREAL; (* @unit 1 *)
    UPTIME : LREAL; (* @unit s *)
  END_VAR
  VAR
    PI      : HY_PID := (KP := 1.0, TR := 20.0, MN := 0.0, MX := 1.0);
    RUNNING : HY_INTEGRAL;
{extra}  END_VAR
  {body}
  PI(SP := WANTED, PV := {level});
  VALVE := PI.XOUT{behind};
  RUNNING(XIN := 1.0);
  UPTIME := RUNNING.XOUT;
END_FUNCTION_BLOCK
)";

struct Edit {
  const char* extra;
  const char* body;
  const char* level;
  const char* behind;
};

constexpr std::array<Edit, sound_versions + 1> edits{{
    {"", "", "LEVEL", ""},
    {"    SMOOTH : HY_LAG := (T1 := 2.0);\n", "SMOOTH(XIN := LEVEL);", "SMOOTH.XOUT", ""},
    {"    FIRST : HY_LAG := (T1 := 1.0);\n    BEFORE : HY_DELAY;\n",
     "FIRST(XIN := LEVEL);\n  BEFORE(XIN := FIRST.XOUT);", "0.5 * (FIRST.XOUT + BEFORE.XOUT)", ""},
    {"", "", "LEVEL", " * 0.0 + SEL(PI.XOUT > 0.5, 1.0, 0.0)"},
}};

constexpr double outflow = 0.004;  // m/s
constexpr double inflow = 0.01;    // m/s, the valve open

}  // namespace

std::string diagram_text(std::uint64_t version, std::int64_t period) {
  const Edit& edit = edits.at(version);
  return fmt::format(fmt::runtime(diagram), fmt::arg("period", period), fmt::arg("extra", edit.extra),
                     fmt::arg("body", edit.body), fmt::arg("level", edit.level), fmt::arg("behind", edit.behind));
}

runtime::RunConfig run_config(const PlantFiles& files, const runtime::ProgramShape& shape) {
  const auto text = fmt::format(
      "[task]\nscheduling = \"other\"\nlock_memory = false\n"
      "[outputs.VALVE]\nsafe = 0.0\non_fault = \"ramp\"\nhold_cycles = 20\nramp = 0.5\nlow = 0.0\nhigh = 1.0\n"
      "bump = 0.2\n"
      "[outputs.UPTIME]\nsafe = 0.0\non_fault = \"hold\"\n"
      "[retain]\nfolder = \"{0}/retained\"\nevery = \"10min\"\n"
      "[trace]\nfile = \"{0}/run.trace\"\ntrigger = \"fault\"\nbefore = 200\nafter = 200\nmegabytes = 4\nfiles = 4\n"
      "[history]\nfile = \"{0}/run.history\"\nevery = \"1min\"\nkeep = \"10000d\"\nmegabytes = 4\n"
      "[online_change]\nsocket = \"{1}/change.socket\"\n"
      "[modbus]\nport = 0\nlock_file = \"{0}/addresses.lock\"\n"
      "[tls]\ncertificate = \"{1}/server.pem\"\nkey = \"{1}/server.key\"\nclients = \"{1}/clients.pem\"\nwithout_role "
      "= [\"read\"]\n",
      files.disk.string(), files.certificates.string());
  runtime::RunConfig config = runtime::parse_run_config("RUN.toml", text, shape);
  config.task.inputs[0].from_device = true;
  return config;
}

TankField::TankField(Ledger& ledger, std::int64_t period, const runtime::OutputSafety& valve)
    : ledger_(&ledger),
      sample_time_(static_cast<double>(period) * 1e-9),
      valve_(valve),
      longest_(static_cast<std::uint64_t>(std::ceil(runtime::longest_way(valve, sample_time_) / sample_time_)) + 1) {}

runtime::Fault TankField::read(std::span<double> inputs) noexcept {
  ++ledger_->cycles;
  if (std::int64_t const takes = std::exchange(overload, 0); takes > 0) {
    SimulatedTime::compute(takes);
  }
  level_ += sample_time_ * (inflow * flow_ - outflow * std::sqrt(std::max(0.0, level_)));
  if (state.is_lost) {
    return runtime::Fault::lost_link;  // and what it gave last stays
  }
  inputs[0] = state.is_broken ? std::numeric_limits<double>::quiet_NaN() : level_;
  return runtime::Fault::none;
}

void TankField::write(std::span<const double> outputs) noexcept {
  flow_ = outputs[0];
  const bool is_bad = state.is_lost || state.is_broken;
  bad_ = is_bad ? bad_ + 1 : 0;
  good_ = is_bad ? 0 : good_ + 1;
  judge(outputs[0]);
}

void TankField::judge(double valve) noexcept {
  const bool is_safe = valve == valve_.value;
  if (!(valve >= valve_.low && valve <= valve_.high)) {
    ++ledger_->out_of_range;
  }
  if (bad_ > longest_ && !is_safe) {
    ++ledger_->unsafe;
  }
  if (bad_ > 0 && is_safe && !was_safe_) {
    ledger_->longest_to_safety =
        std::max(ledger_->longest_to_safety, static_cast<std::int64_t>(static_cast<double>(bad_) * sample_time_ * 1e9));
  }
  // Below the wanted level a control that is back opens the valve, whatever it did before.
  if (good_ > 10'000 && level_ < 0.9 && valve == 0.0) {
    ++ledger_->not_back;
    good_ = 0;
  }
  was_safe_ = is_safe;
}

}  // namespace hysteron::soak
