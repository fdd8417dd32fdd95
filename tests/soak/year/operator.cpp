#include "tests/soak/year/operator.hpp"

#include <chrono>
#include <cstdio>
#include <utility>

#include "support/errors.hpp"
#include "tests/soak/year/plant.hpp"

namespace hysteron::soak {
namespace {

constexpr int most_tries = 20;

}  // namespace

std::shared_ptr<void> Operator::begin(runtime::OnlineChange& change) {
  return std::make_shared<std::jthread>([this, &change](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (const std::uint64_t version = wished_.load(); version != nothing) {
        work(change, version);
        wished_.store(nothing);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
}

void Operator::change_to(std::uint64_t version) noexcept {
  std::uint64_t none = nothing;
  (void)wished_.compare_exchange_strong(none, version);
}

void Operator::work(runtime::OnlineChange& change, std::uint64_t version) {
  const bool jumps = version == jumping_version;
  // An operator looks at the jump of a sound version and allows it, and asks again where it is too early.
  const runtime::ChangeWish wish = jumps ? runtime::ChangeWish{} : runtime::ChangeWish{.bumps = {{"VALVE", 1.0}}};
  for (int tries = 1;; ++tries) {
    try {
      (void)change.change_to(make_(version), wish);
      ledger_->jumps_taken += jumps ? 1 : 0;
      ledger_->changed += jumps ? 0 : 1;
      ledger_->version = jumps ? ledger_->version : version;
      return;
    } catch (const InputError& refused) {
      const Diagnostic& first = refused.diagnostics().all().front();
      const bool as_it_should = jumps && first.number == error::bump_too_large;
      if (as_it_should || first.number != error::online_change_not_now || tries == most_tries) {
        ledger_->jumps_refused += as_it_should ? 1 : 0;
        ledger_->not_changed += as_it_should ? 0 : 1;
        (void)std::fprintf(stderr, "change to version %d: HY%d %s\n", static_cast<int>(version),
                           static_cast<int>(first.number), first.cause.c_str());
        return;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

}  // namespace hysteron::soak
