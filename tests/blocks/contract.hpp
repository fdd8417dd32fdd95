// How the tests of the contract go through the catalogue.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "blocks/catalogue.hpp"

namespace hysteron::testing {

inline constexpr int steps = 400;
inline constexpr std::array<double, 3> sample_times{50e-6, 1e-3, 1.0};

template <class B>
using DoubleParams = typename B::template Params<double>;
template <class B>
using DoubleIn = typename B::template In<double>;

/// Runs visit.operator()<B>() for every block, with the block's name in every failure.
template <class Visit>
void for_each_block(Visit visit) {
  Catalogue::for_each([&]<class B> {
    SCOPED_TRACE(std::string(B::about.name));
    visit.template operator()<B>();
  });
}

/// Runs visit.operator()<B>(seed, ts) for every block with several sample times and seeds.
template <class Visit>
void for_each_run(Visit visit) {
  for_each_block([&]<class B> {
    for (const double ts : sample_times) {
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", TS " + std::to_string(ts));
        visit.template operator()<B>(seed, ts);
      }
    }
  });
}

}  // namespace hysteron::testing
