// Which units a velocity or a position may have.
#include "diagnosis/effects/motions.hpp"

#include <gtest/gtest.h>

namespace hysteron::diagnosis {
namespace {

TEST(Motions, APositionIsALengthOrAnAngle) {
  for (const char* unit : {"m", "um", "cm", "rad", "deg", "1"}) {
    EXPECT_FALSE(is_no_position(unit)) << unit;
  }
  for (const char* unit : {"m/s", "rad/s", "m^2", "A", "V", "degC", "N", "Hz"}) {
    EXPECT_TRUE(is_no_position(unit)) << unit;
  }
}

TEST(Motions, AVelocityIsALengthOrAnAngleAUnitOfTime) {
  for (const char* unit : {"m/s", "mm/s", "rad/s", "Hz", "1"}) {
    EXPECT_FALSE(is_no_velocity(unit)) << unit;
  }
  for (const char* unit : {"m", "m/s^2", "m^2/s", "A", "V/s", "degC"}) {
    EXPECT_TRUE(is_no_velocity(unit)) << unit;
  }
}

TEST(Motions, OfAUnitThatIsNotKnownNothingIsRuledOut) {
  for (const char* unit : {"", "furlong"}) {
    EXPECT_FALSE(is_no_position(unit)) << unit;
    EXPECT_FALSE(is_no_velocity(unit)) << unit;
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
