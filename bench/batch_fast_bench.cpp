// A batch with the functions of libmvec.
#define HYSTERON_BATCH_FAST
// Structures of another header of the same name, which a linker would take for one.
#define feedforward_batch feedforward_batch_fast
#include "bench/batch_bench.hpp"

namespace hysteron::bench {
namespace {

[[maybe_unused]] const bool added = [] {
  add_batch("batch/fast");
  return true;
}();

}  // namespace
}  // namespace hysteron::bench
