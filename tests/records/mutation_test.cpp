// Thousands of damaged files: each ends in a record or in an error with number, place, cause and mend.
#include "tests/support/mutation.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/csv_property.hpp"

namespace hysteron::records {
namespace {

TEST(CsvReader, DamagedFilesEndInARecordOrAnError) {
  const std::vector<std::string> seeds{
      "t,u [V],y\n0.0000000,1.5,10\n0.0001563,-2.25,20\n0.0003125,3,30\n0.0004688,3,30\n",
      "\xEF\xBB\xBFt;u;y\r\n0,0;1,5;10\r\n0,5;-2,25;20\r\n1,0;3e-3;30\r\n\r\n",
      "# c\n\"t\"\t\"a b [µm]\"\n0\t1\n1\t2\n2\t\"3\"\n",
  };
  const std::vector<std::string> pieces{",",
                                        ";",
                                        "\t",
                                        "\n",
                                        "\r\n",
                                        "\"",
                                        "nan",
                                        "inf",
                                        "1e308",
                                        "-1e308",
                                        "e",
                                        "-",
                                        ".",
                                        "#",
                                        "[s]",
                                        "t",
                                        "0,5",
                                        "µ",
                                        "\xB5",
                                        "5e-324",
                                        std::string(1, '\0'),
                                        "\xEF\xBB\xBF",
                                        "99999999999999999999",
                                        ""};
  std::mt19937 random(6);
  int records = 0;
  int errors = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto text = test::mutated(seeds[random() % seeds.size()], pieces, random);
    const auto outcome = test::read_as_record(text);
    ASSERT_EQ(outcome.flaw, "") << text;
    ++(outcome.accepted ? records : errors);
  }
  EXPECT_GT(records, 1000) << "mutations too harsh to reach the far end";
  EXPECT_GT(errors, 1000) << "mutations too tame";
}

}  // namespace
}  // namespace hysteron::records
