// Reads a page docs/errors/HYnnn.md: its title, a text that fails and the text that mends it.
#pragma once

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hysteron::test {

struct FencedBlock {
  std::string kind{};  ///< the info string: st, csv, toml, sh
  std::string text{};
};

struct ErrorPage {
  std::string number{};  ///< HY501
  std::string title{};
  FencedBlock fails{};
  FencedBlock mended{};
};

inline FencedBlock fenced_block_below(std::string_view page, std::string_view heading) {
  const auto at = page.find("\n" + std::string(heading) + "\n");
  const auto open = at == std::string_view::npos ? at : page.find("\n```", at);
  if (open == std::string_view::npos) {
    throw std::runtime_error("no fenced block below " + std::string(heading));
  }
  const auto begin = page.find('\n', open + 1) + 1;
  const auto end = page.find("\n```", begin - 1);
  return {std::string(page.substr(open + 4, begin - 1 - (open + 4))), std::string(page.substr(begin, end + 1 - begin))};
}

inline ErrorPage read_error_page(const std::string& number) {
  std::ifstream file(std::string(HYSTERON_SOURCE_DIR) + "/docs/errors/" + number + ".md");
  const std::string page{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const auto line_end = page.find('\n');
  if (!page.starts_with("# HY") || line_end == std::string::npos) {
    throw std::runtime_error("no page, or no heading, for " + number);
  }
  const auto space = page.find(' ', 2);
  return {page.substr(2, space - 2), page.substr(space + 1, line_end - space - 1), fenced_block_below(page, "## Fails"),
          fenced_block_below(page, "## Mended")};
}

}  // namespace hysteron::test
