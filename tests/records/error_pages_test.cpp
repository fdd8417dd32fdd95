// The pages of the errors of records keep their word: the failing text fails with that number, the mended one loads.
#include <gtest/gtest.h>

#include <string>

#include "records/read.hpp"
#include "support/errors.hpp"
#include "tests/records/refusal.hpp"
#include "tests/support/error_page.hpp"

namespace hysteron::records {
namespace {

/// `\xB5` as the byte it stands for: a page is UTF-8 and cannot hold it.
std::string bytes_of(const test::FencedBlock& block) {
  std::string text = block.text;
  if (block.kind == "csv escapes") {
    for (auto at = text.find("\\x"); at != std::string::npos; at = text.find("\\x", at + 1)) {
      text.replace(at, 4, 1, static_cast<char>(std::stoi(text.substr(at + 2, 2), nullptr, 16)));
    }
  }
  return text;
}

TEST(ErrorPages, OfRecords) {
  int pages = 0;
  for (const auto& [number, title] : error_titles()) {
    if (number < 500 || number >= 530) {
      continue;
    }
    const auto name = "HY" + std::to_string(number);
    SCOPED_TRACE(name);
    const auto page = test::read_error_page(name);
    EXPECT_EQ(page.number, name);
    EXPECT_EQ(page.title, title);
    EXPECT_EQ(refusals_of(bytes_of(page.fails)).all().front().number, number);
    EXPECT_NO_THROW((void)parse_record("log.csv", bytes_of(page.mended)));
    ++pages;
  }
  EXPECT_EQ(pages, 14);
}

}  // namespace
}  // namespace hysteron::records
