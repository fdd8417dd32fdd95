// What lanes take one by one, compiled for every processor: see lanes.hpp.
#include "blocks/filtered_rate.hpp"
#include "codegen/interpreter/lanes.hpp"
#include "codegen/trace/evaluate.hpp"

namespace hysteron::detail {

template <Op op>
void each_function(double* x) {
  for (std::size_t k = 0; k < lane_count; ++k) {
    x[k] = real_operation(op, x[k], x[k]);
  }
}
template void each_function<Op::Sqrt>(double* x);
template void each_function<Op::Exp>(double* x);
template void each_function<Op::Log>(double* x);
template void each_function<Op::Sin>(double* x);
template void each_function<Op::Cos>(double* x);
template void each_function<Op::Tan>(double* x);
template void each_function<Op::Asin>(double* x);
template void each_function<Op::Acos>(double* x);
template void each_function<Op::Atan>(double* x);
template void each_function<Op::ToSingle>(double* x);

void each_decayed_part(double* u) {
  for (std::size_t k = 0; k < lane_count; ++k) {
    u[k] = hysteron::decayed_part(u[k]);
  }
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

}  // namespace hysteron::detail
