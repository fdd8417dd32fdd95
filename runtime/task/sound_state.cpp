#include "runtime/task/sound_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace hysteron::runtime {
namespace {

/// So much is looked at in a step, in the mean: some tenths of a microsecond.
constexpr std::size_t bytes_a_step = 1024;

template <class Real>
Real real_at(std::span<const std::byte> bytes, std::size_t at) noexcept {
  Real value{};
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

}  // namespace

SoundState::SoundState(StepProgram& program)
    : kept_(state_of(program)), now_(kept_.size()), every_(1 + kept_.size() / bytes_a_step) {
  for (const StateField& field : program.shape().state) {
    if (is_real(field.type)) {
      rows_.push_back({.offset = field.offset, .length = field.length, .is_double = field.type == PointType::real64});
    }
  }
  program.reset();
  after_reset_ = state_of(program);
  program.restore(kept_);
}

void SoundState::begin_with(std::span<const std::byte> state) noexcept {
  std::ranges::copy(state, kept_.begin());
}

bool SoundState::follow(StepProgram& program, bool outputs_are_numbers) noexcept {
  const bool is_news = !outputs_are_numbers && !saw_none_;
  if (wait_ > 0 && !is_news) {
    --wait_;
    return false;
  }
  saw_none_ = !outputs_are_numbers;
  if (rows_.empty() || (outputs_are_numbers && kept_.size() > largest_kept)) {
    return false;
  }
  wait_ = every_ - 1;
  program.save(now_);
  bool is_mended = false;
  for (const Numbers& row : rows_) {
    is_mended = (row.is_double ? mend<double>(row) : mend<float>(row)) || is_mended;
  }
  if (!is_mended || outputs_are_numbers) {
    return false;  // what no output shows is the diagram's own affair
  }
  program.restore(now_);
  return true;
}

/// Keeps what is finite, and puts what is kept in the place of what is not.
template <class Real>
bool SoundState::mend(const Numbers& row) noexcept {
  bool is_mended = false;
  for (std::size_t i = 0; i < row.length; ++i) {
    const std::size_t at = row.offset + i * sizeof(Real);
    if (std::isfinite(real_at<Real>(now_, at))) {
      std::memcpy(kept_.data() + at, now_.data() + at, sizeof(Real));
    } else if (std::isfinite(real_at<Real>(after_reset_, at))) {
      const auto& sound = std::isfinite(real_at<Real>(kept_, at)) ? kept_ : after_reset_;
      std::memcpy(now_.data() + at, sound.data() + at, sizeof(Real));
      is_mended = true;
    }
  }
  return is_mended;
}

}  // namespace hysteron::runtime
