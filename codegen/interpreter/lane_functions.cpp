// What lanes take one by one, compiled for every processor, and whether this one has wide registers: see lanes.hpp.
#include "blocks/filtered_rate.hpp"
#include "codegen/interpreter/lanes.hpp"
#include "codegen/trace/evaluate.hpp"

namespace hysteron {

bool has_wide_registers() {
#ifdef HYSTERON_WIDE_CODE
  static const bool all = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  return all;
#else
  return false;
#endif
}

namespace detail {
namespace {

template <class Function>
void each_in_place(double* x, const Function& function) {
  for (std::size_t k = 0; k < lane_count; ++k) {
    x[k] = function(x[k]);
  }
}

}  // namespace

void each_sqrt(double* x) {
  each_in_place(x, [](double one) { return hysteron::sqrt(one); });
}
void each_exp(double* x) {
  each_in_place(x, [](double one) { return hysteron::exp(one); });
}
void each_log(double* x) {
  each_in_place(x, [](double one) { return hysteron::log(one); });
}
void each_sin(double* x) {
  each_in_place(x, [](double one) { return hysteron::sin(one); });
}
void each_cos(double* x) {
  each_in_place(x, [](double one) { return hysteron::cos(one); });
}
void each_tan(double* x) {
  each_in_place(x, [](double one) { return hysteron::tan(one); });
}
void each_asin(double* x) {
  each_in_place(x, [](double one) { return hysteron::asin(one); });
}
void each_acos(double* x) {
  each_in_place(x, [](double one) { return hysteron::acos(one); });
}
void each_atan(double* x) {
  each_in_place(x, [](double one) { return hysteron::atan(one); });
}
void each_single(double* x) {
  each_in_place(x, [](double one) { return hysteron::single(one); });
}
void each_decayed_part(double* u) {
  each_in_place(u, [](double one) { return hysteron::decayed_part(one); });
}
void each_power(double* base, const double* exponent) {
  for (std::size_t k = 0; k < lane_count; ++k) {
    base[k] = power(base[k], exponent[k]);
  }
}
void each_to_int(const double* x, std::int32_t* result) {
  for (std::size_t k = 0; k < lane_count; ++k) {
    result[k] = to_int(x[k]);
  }
}
void each_int_operation(Op op, const std::int32_t* a, const std::int32_t* b, std::int32_t* result) {
  for (std::size_t k = 0; k < lane_count; ++k) {
    result[k] = int_operation(op, a[k], b[k]);
  }
}

}  // namespace detail
}  // namespace hysteron
