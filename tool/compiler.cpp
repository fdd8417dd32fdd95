#include "tool/compiler.hpp"

#include <cstdlib>
#include <sstream>

#include "support/text_file.hpp"
#include "tool/process.hpp"

namespace hysteron::tool {
namespace {

/// More lines than these of what a compiler says do not help.
constexpr std::size_t most_lines = 12;

}  // namespace

std::vector<std::string> words_of(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

std::optional<std::vector<std::string>> find_compiler(const char* variable, std::initializer_list<const char*> names) {
  if (const char* const set = std::getenv(variable); set != nullptr && *set != '\0') {
    auto command = words_of(set);
    if (!command.empty() && find_program(command.front())) {
      return command;
    }
    return std::nullopt;
  }
  for (const char* const name : names) {
    if (find_program(name)) {
      return std::vector<std::string>{name};
    }
  }
  return std::nullopt;
}

std::string first_lines(const std::filesystem::path& path) {
  std::istringstream lines(read_text_file(path.string()));
  std::string text;
  std::string line;
  for (std::size_t i = 0; i < most_lines && std::getline(lines, line); ++i) {
    text += "\n    " + line;
  }
  return text.empty() ? "\n    (it says nothing)" : text;
}

}  // namespace hysteron::tool
