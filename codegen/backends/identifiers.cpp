#include "codegen/backends/identifiers.hpp"

#include <cctype>

namespace hysteron {

std::string lower_identifier(std::string_view name) {
  std::string result;
  for (const char letter : name) {
    const auto code = static_cast<unsigned char>(letter);
    const char next = std::isalnum(code) != 0 ? static_cast<char>(std::tolower(code)) : '_';
    if (next != '_' || result.empty() || result.back() != '_') {  // two underscores in a row are the compiler's
      result += next;
    }
  }
  if (result.empty() || std::isdigit(static_cast<unsigned char>(result.front())) != 0) {
    result.insert(0, "_");
  }
  return result;
}

std::string Identifiers::make(std::string_view name) {
  std::string base = lower_identifier(name);
  if (taken_.insert(base).second) {
    return base;
  }
  int& number = next_number_.try_emplace(base, 2).first->second;
  for (;;) {
    std::string candidate = base + "_" + std::to_string(number++);
    if (taken_.insert(candidate).second) {
      return candidate;
    }
  }
}

}  // namespace hysteron
