// The sources of the project, for the tests that read them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace hysteron::house {

struct SourceText {
  std::string path;  ///< from the root: blocks/gain.hpp
  std::vector<std::string> lines;

  [[nodiscard]] std::string room() const { return path.substr(0, path.find('/')); }
  [[nodiscard]] bool is_header() const { return path.ends_with(".hpp"); }
};

/// Every file of C++, or of other languages by their extensions, below the folders, sorted by path.
inline std::vector<SourceText> source_files(const std::vector<std::string>& folders,
                                            const std::vector<std::string>& extensions = {".hpp", ".cpp"}) {
  const std::filesystem::path root = HYSTERON_SOURCE_DIR;
  std::vector<SourceText> files;
  for (const auto& folder : folders) {
    if (!std::filesystem::exists(root / folder)) {
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      const bool is_fetched = entry.path().string().find("/node_modules/") != std::string::npos;
      if (!entry.is_regular_file() || is_fetched || std::ranges::find(extensions, extension) == extensions.end()) {
        continue;
      }
      SourceText text{.path = entry.path().lexically_relative(root).generic_string(), .lines = {}};
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        text.lines.push_back(line);
      }
      files.push_back(std::move(text));
    }
  }
  std::ranges::sort(files, {}, &SourceText::path);
  return files;
}

}  // namespace hysteron::house
