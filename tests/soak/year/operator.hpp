// Who changes the diagram of the running task: a thread beside it, as that which `hysteron online-change` talks to.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "runtime/host/online_change.hpp"
#include "tests/soak/year/ledger.hpp"

namespace hysteron::soak {

class Operator {
 public:
  using MakeProgram = std::function<std::unique_ptr<runtime::StepProgram>(std::uint64_t version)>;
  Operator(Ledger& ledger, MakeProgram make) : ledger_(&ledger), make_(std::move(make)) {}

  /// The thread, for as long as what is given back lives.
  [[nodiscard]] std::shared_ptr<void> begin(runtime::OnlineChange& change);
  /// From the cyclic thread. Where a change is under way, nothing.
  void change_to(std::uint64_t version) noexcept;
  [[nodiscard]] bool is_busy() const noexcept { return wished_.load(std::memory_order_relaxed) != nothing; }

 private:
  static constexpr std::uint64_t nothing = ~std::uint64_t{0};
  void work(runtime::OnlineChange& change, std::uint64_t version);

  Ledger* ledger_;
  MakeProgram make_;
  std::atomic<std::uint64_t> wished_{nothing};
};

}  // namespace hysteron::soak
