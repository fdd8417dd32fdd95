#include "codegen/interpreter/registers.hpp"

namespace hysteron {

#ifdef HYSTERON_WIDE_CODE
bool has_registers_of_four() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

bool has_registers_of_eight() {
  static const bool has = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  return has;
}
#else
bool has_registers_of_four() {
  return false;
}

bool has_registers_of_eight() {
  return false;
}
#endif

}  // namespace hysteron
