#include "tool/file_kind.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/names.hpp"
#include "support/text_file.hpp"

namespace hysteron::tool {

FileKind kind_of_file(const std::string& path) {
  const std::string ending = in_capitals(std::filesystem::path(path).extension().string());
  if (ending == ".TOML") {
    return FileKind::Parameters;
  }
  if (ending == ".ST" || ending == ".IECST") {
    return FileKind::Diagram;
  }
  if (ending == ".JSON") {
    const auto json = nlohmann::json::parse(read_text_file(path), nullptr, false);
    if (json.is_object() && json.contains("verdict") && json.contains("effects")) {
      return FileKind::Verdict;
    }
  }
  return FileKind::Record;
}

std::string_view words_of(FileKind kind) {
  switch (kind) {
    case FileKind::Record:
      return "a record";
    case FileKind::Parameters:
      return "a parameter file";
    case FileKind::Diagram:
      return "a diagram";
    case FileKind::Verdict:
      return "a verdict";
  }
  return {};
}

}  // namespace hysteron::tool
