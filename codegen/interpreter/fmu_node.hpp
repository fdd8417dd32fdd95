// An FMU among the blocks of a machine: values go to its process and come back; derivatives are differences of further
// instances of the FMU.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "codegen/cosimulation/session.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/interpreter/block_code.hpp"
#include "codegen/interpreter/directions.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron {

template <class S>
class FmuNode {
 public:
  /// `directions` is of the machine, and outlives the node.
  FmuNode(const BlockType& block, std::string path, const Directions& directions)
      : block_(block), path_(std::move(path)), directions_(directions) {
    constexpr std::size_t align = alignof(S) > 8 ? alignof(S) : 8;
    constexpr std::size_t place = (sizeof(S) + align - 1) / align * align;
    for (std::size_t i = 0; i < block.outputs.size(); ++i) {
      code_.out_offsets.push_back(i * place);
    }
    code_.out_size = block.outputs.size() * place;
    code_.alignment = align;
    code_.state_offsets = {0};  // its memory is elsewhere; no state of it can be asked for
    code_.reset = [](const Instruction<S>& at) { of(at).reset(); };
    code_.output = [](const Instruction<S>& at) { of(at).output(at); };
    code_.update = [](const Instruction<S>& at) { of(at).update(at); };
    code_.step = [](const Instruction<S>& at) {
      of(at).output(at);
      of(at).update(at);
    };
  }

  [[nodiscard]] const BlockCode<S>& code() const { return code_; }

 private:
  static constexpr std::size_t further = direction_count<S>();

  static FmuNode& of(const Instruction<S>& at) { return *static_cast<FmuNode*>(at.state); }

  /// Takes effect at the first step: parameters may still be set.
  void reset() { begun_ = false; }

  /// Has the outputs of this step: begun, or done with the step before.
  void arrive(const Instruction<S>& at) {
    if (!begun_) {
      begin(at);
      begun_ = true;
    }
    for (const auto& session : sessions_) {
      session->wait();
    }
  }

  void output(const Instruction<S>& at) {
    arrive(at);
    for (std::size_t i = 0; i < block_.outputs.size(); ++i) {
      void* const target = static_cast<std::byte*>(at.out) + code_.out_offsets[i];
      const double value = lane(0).outputs(0)[i];
      switch (block_.outputs[i].type) {
        case Type::Real:
          require_finite(value, output_name_in_fmu(block_, i), "gives");
          new (target) S(with_derivatives(value, i));
          break;
        case Type::Bool:
          new (target) bool(value != 0.0);
          break;
        default:
          new (target) std::int32_t(to_int(value));
          break;
      }
    }
  }

  /// The FMU works on while other blocks do.
  void update(const Instruction<S>& at) {
    arrive(at);
    write_pins(at, 0, block_.inputs.size());
    for (const auto& session : sessions_) {
      session->step();
    }
    ++steps_;
  }

  void begin(const Instruction<S>& at) {
    lanes_ = 1 + (further == 0 ? 0 : std::min(further, directions_.used));
    step_ = value_of(*at.ts);
    const bool alone = block_.fmu->description().once_per_process;
    const std::size_t processes = alone ? lanes_ : 1;
    while (sessions_.size() < processes) {
      sessions_.push_back(std::make_unique<cosimulation::Session>(*block_.fmu, path_, alone ? 1 : 1 + further, step_));
    }
    sessions_.resize(processes);
    lanes_per_session_ = alone ? 1 : lanes_;
    for (const auto& session : sessions_) {
      session->settle();
    }
    steps_ = 0;
    // In the first step inputs that follow from the outputs are not known yet: the FMU begins with its own.
    for (std::size_t k = 0; k < lanes_; ++k) {
      for (std::size_t pin = 0; pin < block_.inputs.size(); ++pin) {
        lane(k).inputs(k % lanes_per_session_)[pin] = block_.inputs[pin].preset;
      }
    }
    write_pins(at, block_.inputs.size(), block_.pin_count());
    for (const auto& session : sessions_) {
      session->begin(lanes_per_session_);
    }
  }

  /// Pins from `first` to `end` in all lanes; the lane of a direction is moved along it.
  void write_pins(const Instruction<S>& at, std::size_t first, std::size_t end) {
    for (std::size_t pin = first; pin < end; ++pin) {
      const Type type = block_.pin(pin).type;
      if (type == Type::Real) {
        const S& number = *static_cast<const S*>(at.pins[pin]);
        if (pin < block_.inputs.size()) {  // a parameter may be infinite: a limit that there is not
          require_finite(value_of(number), name_in_fmu(block_, pin), "is given");
        }
        for (std::size_t k = 0; k < lanes_; ++k) {
          value(k, pin) = moved(number, k);
        }
        continue;
      }
      const double number = type == Type::Bool ? (*static_cast<const bool*>(at.pins[pin]) ? 1.0 : 0.0)
                                               : static_cast<double>(*static_cast<const std::int32_t*>(at.pins[pin]));
      for (std::size_t k = 0; k < lanes_; ++k) {
        value(k, pin) = number;
      }
    }
  }

  [[nodiscard]] double moved(const S& number, std::size_t k) const {
    if constexpr (further > 0) {
      if (k > 0) {
        return value_of(number) + directions_.step[k - 1] * number.derivative(static_cast<int>(k - 1));
      }
    }
    return static_cast<double>(value_of(number));
  }

  [[nodiscard]] S with_derivatives(double value, std::size_t output) const {
    if constexpr (further > 0) {
      typename S::Gradient gradient{};
      for (std::size_t k = 1; k < lanes_; ++k) {
        const double other = lane(k).outputs(k % lanes_per_session_)[output];
        require_finite(other, output_name_in_fmu(block_, output), "gives");
        gradient[k - 1] = (other - value) / directions_.step[k - 1];
      }
      return S(value, gradient);
    } else {
      return static_cast<S>(value);
    }
  }

  void require_finite(double value, std::string_view name, std::string_view verb) const {
    if (std::isfinite(value)) {
      return;
    }
    throw cosimulation::FmuRefusal(error::fmu_refuses_step, {.file = block_.fmu->path()},
                                   fmt::format("{} of the FMU of {} {} {} at t = {} s.", name, path_, verb, value,
                                               number_text(static_cast<double>(steps_) * step_)),
                                   verb == "gives"
                                       ? "give inputs and parameters with which the model can go on, or a shorter step."
                                       : "limit the signal before it: HY_LIMIT, or a division that cannot be by 0.");
  }

  [[nodiscard]] const cosimulation::ChannelView& lane(std::size_t k) const {
    return sessions_[k / lanes_per_session_]->values();
  }
  [[nodiscard]] double& value(std::size_t k, std::size_t pin) const {
    return lane(k).values(k % lanes_per_session_)[pin];
  }

  const BlockType& block_;
  std::string path_;
  const Directions& directions_;
  BlockCode<S> code_{};
  std::vector<std::unique_ptr<cosimulation::Session>> sessions_{};
  std::size_t lanes_ = 1;
  std::size_t lanes_per_session_ = 1;
  double step_ = 0.0;
  std::uint64_t steps_ = 0;
  bool begun_ = false;
};

}  // namespace hysteron
