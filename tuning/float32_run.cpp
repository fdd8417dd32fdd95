#include "tuning/float32_run.hpp"

#include "tuning/interpreted_run.hpp"

namespace hysteron {

std::vector<Signal> interpret(const Program& program, const Drive& drive, const std::vector<Wire>& watched,
                              bool float32, const std::function<void(double)>& progress) {
  return float32 ? detail::interpreted_run<float>(program, drive, watched, progress)
                 : interpret(program, drive, watched, progress);
}

}  // namespace hysteron
