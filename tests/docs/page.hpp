// Pages of the documentation, taken apart: fenced blocks with what stands behind the fence, links, headings.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/scratch_folder.hpp"

namespace hysteron::test {

/// ```sh exit=1 becomes kind "sh", attributes {exit: 1}; a word without = has an empty value.
struct Snippet {
  std::string kind{};
  std::map<std::string, std::string, std::less<>> attributes{};
  std::string text{};
  std::string before{};  ///< the prose between the snippet before it and this one
  std::size_t line = 0;  ///< of the opening fence, from 1

  [[nodiscard]] bool has(std::string_view name) const { return attributes.contains(name); }
};

struct Link {
  std::string target{};
  std::size_t line = 0;
};

struct Page {
  std::filesystem::path path{};
  std::vector<Snippet> snippets{};
  std::vector<Link> links{};
  std::set<std::string> anchors{};  ///< of its headings, as web viewers name them
};

inline std::filesystem::path source_folder() {
  return HYSTERON_SOURCE_DIR;
}

/// `## The static fit` → the-static-fit
inline std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto letter = static_cast<unsigned char>(c);
    if (c == ' ') {
      anchor += '-';
    } else if (letter >= 0x80 || std::isalnum(letter) != 0 || c == '-' || c == '_') {
      anchor += static_cast<char>(letter < 0x80 ? std::tolower(letter) : letter);
    }
  }
  return anchor;
}

/// Between two backticks, as `F[K](X)` is.
inline bool is_code(const std::string& line, std::size_t at) {
  const auto here = line.begin() + static_cast<std::ptrdiff_t>(at);
  return std::count(line.begin(), here, '`') % 2 != 0 && std::find(here, line.end(), '`') != line.end();
}

inline void collect_links(const std::string& line, std::size_t number, Page& page) {
  for (auto at = line.find("]("); at != std::string::npos; at = line.find("](", at + 2)) {
    const auto end = line.find(')', at);
    if (end != std::string::npos && !is_code(line, at)) {
      page.links.push_back({line.substr(at + 2, end - at - 2), number});
    }
  }
}

inline Snippet opened_snippet(const std::string& line, std::size_t number) {
  Snippet snippet{.line = number};
  std::istringstream words(line.substr(3));
  words >> snippet.kind;
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    snippet.attributes[word.substr(0, equals)] = equals == std::string::npos ? "" : word.substr(equals + 1);
  }
  return snippet;
}

/// Throws where a fence is indented or left open: what is in it would be run by nobody.
inline Page read_page(const std::filesystem::path& path) {
  Page page{.path = path};
  std::istringstream lines(contents_of(path));
  std::size_t number = 0;
  std::string prose;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const bool fence = line.starts_with("```");
    if (!inside && !fence && line.find("```") != std::string::npos) {
      throw std::runtime_error(path.string() + ":" + std::to_string(number) + ": a fence inside a line");
    }
    if (fence && !inside) {
      page.snippets.push_back(opened_snippet(line, number));
      page.snippets.back().before = std::exchange(prose, {});
    } else if (inside && !fence) {
      page.snippets.back().text += line + "\n";
    } else if (!fence) {
      prose += line + "\n";
      collect_links(line, number, page);
      if (line.starts_with("#")) {
        page.anchors.insert(anchor_of(line.substr(std::min(line.find_first_not_of('#') + 1, line.size()))));
      }
    }
    inside = inside != fence;
  }
  if (inside) {
    throw std::runtime_error(path.string() + ": the last fence has no end");
  }
  return page;
}

/// All pages, sorted by path: docs and the pages at the top.
inline std::vector<std::filesystem::path> all_pages() {
  std::vector<std::filesystem::path> pages;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder() / "docs")) {
    if (entry.path().extension() == ".md") {
      pages.push_back(entry.path());
    }
  }
  for (const char* name : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md"}) {
    if (std::filesystem::exists(source_folder() / name)) {
      pages.push_back(source_folder() / name);
    }
  }
  std::sort(pages.begin(), pages.end());
  return pages;
}

inline bool is_below(const std::filesystem::path& path, std::string_view folder) {
  return path.lexically_relative(source_folder()).string().starts_with(folder);
}

}  // namespace hysteron::test
