// A tank whose level is controlled by a valve: the diagram in its versions, how it is run, and the plant, which judges
// every cycle.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "runtime/config/run_config.hpp"
#include "runtime/task/field_io.hpp"
#include "tests/soak/year/ledger.hpp"

namespace hysteron::soak {

/// The versions that may follow each other; the one behind them makes the valve jump.
constexpr std::uint64_t sound_versions = 3;
constexpr std::uint64_t jumping_version = 3;
[[nodiscard]] std::string diagram_text(std::uint64_t version, std::int64_t period);

struct PlantFiles {
  std::filesystem::path disk{};          ///< that the power is cut from
  std::filesystem::path certificates{};  ///< server.pem, server.key, clients.pem
};
[[nodiscard]] runtime::RunConfig run_config(const PlantFiles& files, const runtime::ProgramShape& shape);

/// What is wrong with the plant now.
struct PlantState {
  bool is_lost = false;    ///< the device
  bool is_broken = false;  ///< the sensor gives no number
};

class TankField final : public runtime::FieldIo {
 public:
  TankField(Ledger& ledger, std::int64_t period, const runtime::OutputSafety& valve);
  runtime::Fault read(std::span<double> inputs) noexcept override;
  void write(std::span<const double> outputs) noexcept override;

  PlantState state{};
  std::int64_t overload = 0;  ///< the next cycle computes for so long

 private:
  void judge(double valve) noexcept;

  Ledger* ledger_;
  double sample_time_;
  runtime::OutputSafety valve_;
  std::uint64_t longest_;   ///< cycles from the first of a fault on, in which the valve may be open
  std::uint64_t bad_ = 0;   ///< cycles with a fault, one after the other
  std::uint64_t good_ = 0;  ///< and without
  bool was_safe_ = true;
  double level_ = 1.0;
  double flow_ = 0.0;
};

}  // namespace hysteron::soak
