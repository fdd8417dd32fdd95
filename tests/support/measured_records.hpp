// Tests on measured records, which may not be shipped: left out where there is no folder of them. Where there is one, a
// record that is missing is a failure, and for the test to find.
#pragma once

#include <gtest/gtest.h>

#include "records/data_folder.hpp"

namespace hysteron::test {

template <class Base = testing::Test>
class OnMeasuredRecords : public Base {
 protected:
  void SetUp() override {
    if (!records::data_folder(HYSTERON_SOURCE_DIR)) {
      GTEST_SKIP() << "There is no folder of measured records: neither HYSTERON_DATA nor ../shared/data.";
    }
  }
};

}  // namespace hysteron::test
