// A batch with the bits of the step.
#include "bench/batch_bench.hpp"

namespace hysteron::bench {
namespace {

[[maybe_unused]] const bool added = [] {
  add_batch("batch/same_bits");
  return true;
}();

}  // namespace
}  // namespace hysteron::bench
