// Thousands of damaged files: each ends in a record or in an error with number, place, cause and mend.
#include "tests/support/mutation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "records/csv.hpp"
#include "support/diagnostic.hpp"
#include "support/render.hpp"

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
    try {
      const Record record = parse_csv("log.csv", text);
      ASSERT_GE(record.size(), 2U) << text;
      ASSERT_GT(record.sample_time(), 0.0) << text;
      ASSERT_TRUE(std::isfinite(record.sample_time())) << text;
      for (const Column& column : record.columns()) {
        ASSERT_EQ(column.values.size(), record.size()) << text;
      }
      // What was read can be written and read again.
      ASSERT_EQ(parse_csv("again.csv", csv_text(record)).names(), record.names()) << text;
      ++records;
    } catch (const InputError& refused) {
      for (const Diagnostic& diagnostic : refused.diagnostics().all()) {
        ASSERT_TRUE(diagnostic.number > 500 && diagnostic.number < 600) << text;
        ASSERT_EQ(diagnostic.place.file, "log.csv") << diagnostic.cause << text;
        ASSERT_FALSE(diagnostic.cause.empty());
        ASSERT_FALSE(diagnostic.mend.empty());
      }
      Sources sources;
      sources.put("log.csv", text);
      ASSERT_FALSE(as_text(refused.diagnostics(), sources).empty());
      ++errors;
    }
  }
  EXPECT_GT(records, 1000) << "mutations too harsh to reach the far end";
  EXPECT_GT(errors, 1000) << "mutations too tame";
}

}  // namespace
}  // namespace hysteron::records
