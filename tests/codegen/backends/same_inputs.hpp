// The same random inputs here and in a generated program, and a hash of what comes of them: C that is C++ as well, once
// as code and once as text.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#define HYSTERON_CODE_AND_TEXT(name, ...) \
  __VA_ARGS__                             \
  inline constexpr std::string_view name = #__VA_ARGS__;

namespace hysteron::testing::same {

// NOLINTBEGIN: the lowest common part of both languages
// clang-format off
HYSTERON_CODE_AND_TEXT(
    text,

    typedef struct { uint64_t state; } source;

    static inline uint64_t next_number(source* from) {
      from->state ^= from->state << 13;
      from->state ^= from->state >> 7;
      from->state ^= from->state << 17;
      return from->state;
    }

    static inline double extreme_number(uint64_t which) {
      switch (which % 8) {
        case 0: return -0.0;
        case 1: return 4.9406564584124654e-324;
        case 2: return -1.5e-310;
        case 3: return 2.2250738585072014e-308;
        case 4: return 1.0e-40;
        case 5: return 1.0e30;
        case 6: return -2147483648.0;
        default: return 4294967297.5;
      }
    }

    static inline double no_number(uint64_t which) {
      return which % 3 == 0 ? (double)NAN : (which % 3 == 1 ? (double)INFINITY : -(double)INFINITY);
    }

    static inline double real_number(source* from, int extremes) {
      const uint64_t kind = next_number(from) % 32;
      const uint64_t bits = next_number(from);
      if (kind < 4 && extremes > 0) {
        return (double)((int)(bits % 7) - 3);
      }
      if (kind == 4 && extremes > 0) {
        return extreme_number(bits >> 8);
      }
      if (kind == 5 && extremes > 1) {
        return no_number(bits >> 8);
      }
      return (double)(bits >> 11) / 9007199254740992.0 * 6.0 - 3.0;
    }

    static inline int32_t whole_number(source* from, int wide) {
      const uint64_t kind = next_number(from) % 16;
      if (kind == 0) {
        return wide != 0 ? 2147483647 : 16777216;
      }
      if (kind == 1) {
        return -2147483647 - 1;
      }
      return (int32_t)(next_number(from) % 9) - 3;
    }

    static inline void mix(uint64_t* hash, double value) {
      uint64_t bits = 0x7FF8;
      if (value == value) {
        memcpy(&bits, &value, sizeof(bits));
      }
      *hash = (*hash ^ bits) * 1099511628211u;
    })
// clang-format on
// NOLINTEND

}  // namespace hysteron::testing::same
